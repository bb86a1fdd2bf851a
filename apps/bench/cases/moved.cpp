#include "bench/cases/moved.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <numbers>
#include <sstream>
#include <utility>
#include <vector>

namespace koppel::app::bench {

Moved::Moved(Model model) : model_(std::move(model)) {
  if (model_.outcome == Exit::fine) {
    motion_ = start(model_);
  } else {
    error_ = model_.error;
  }
}

bool Moved::took(koppel_status status) {
  if (status < 0) return false;
  residual_ = std::max(residual_, report_.residual);
  change_points_ += static_cast<int>(report_.change_points);
  return true;
}

bool Moved::to(double time, int branch) {
  if (!motion_.state) return false;
  auto options = sized<koppel_motion_options>();
  options.branch = branch;
  return took(koppel_move_on(motion_.state.get(), motion_.work.get(), time, &options, &report_, &error_));
}

bool Moved::along(double duration) {
  if (!motion_.state) return false;
  return took(koppel_follow(motion_.state.get(), motion_.work.get(), duration, nullptr, &report_, &error_));
}

bool Moved::close() {
  if (!motion_.state) return false;
  return took(koppel_close(motion_.state.get(), motion_.work.get(), nullptr, &report_, &error_));
}

double Moved::q(const std::string& coordinate) const {
  std::size_t index = 0;
  if (!motion_.state ||
      koppel_mechanism_find(model_.mechanism.get(), KOPPEL_KIND_COORDINATE, coordinate.c_str(), &index, nullptr) < 0) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  std::vector<double> q(model_.sizes().coordinates);
  koppel_state_get(motion_.state.get(), KOPPEL_Q, q.data(), q.size());
  return q[index];
}

double FourBar::rocker_angle(double crank_angle, int side) const {
  const double px = crank * std::cos(crank_angle) - ground, py = crank * std::sin(crank_angle);
  const double d = std::hypot(px, py);
  const double turned = std::acos((d * d + rocker * rocker - coupler * coupler) / (2.0 * d * rocker));
  return std::atan2(py, px) - side * turned;
}

std::string FourBar::scene(double start, double slope, int side) const {
  const double angle = rocker_angle(start, side);
  const double bx = ground + rocker * std::cos(angle) - crank * std::cos(start);
  const double by = rocker * std::sin(angle) - crank * std::sin(start);
  std::ostringstream text;
  text << std::setprecision(17) << "schema = 1\n[scene]\nname = 'fourbar'\nduration = 1\nsteps = 100\n"
       << "[[body]]\nname = 'crank'\n[[body]]\nname = 'coupler'\n[[body]]\nname = 'rocker'\n"
       << "[[joint]]\nname = 'crank'\ntype = 'revolute'\ninlet = { on = 'ground', at = [" << x << ", " << y << ", "
       << height << "] }\noutlet = 'crank'\n"
       << "[[joint]]\nname = 'pin'\ntype = 'revolute'\ninlet = { on = 'crank', at = [" << scale * crank
       << ", 0, 0] }\noutlet = 'coupler'\nstart = { angle = " << std::atan2(by, bx) - start << " }\n"
       << "[[joint]]\nname = 'rocker'\ntype = 'revolute'\ninlet = { on = 'ground', at = [" << x + scale * ground << ", "
       << y << ", " << height << "] }\noutlet = 'rocker'\nstart = { angle = " << angle << " }\n"
       << "[[joint]]\nname = 'end'\ntype = 'revolute'\ninlet = { on = 'rocker', at = [" << scale * rocker
       << ", 0, 0] }\noutlet = { on = 'coupler', at = [" << scale * coupler
       << ", 0, 0] }\nstart = { angle = " << std::atan2(by, bx) - angle << " }\n"
       << "[[drive]]\nof = 'crank.angle'\ntype = 'ramp'\nstart = " << start << "\nslope = " << slope << "\n";
  return text.str();
}

double apart(double angle, double other) {
  const double off = std::abs(std::remainder(angle - other, 2.0 * std::numbers::pi));
  return std::isnan(off) ? std::numeric_limits<double>::infinity() : off;
}

}  // namespace koppel::app::bench
