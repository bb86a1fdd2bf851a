#include "closure/input_way.hpp"

#include <algorithm>
#include <cmath>

namespace koppel {

InputWay InputWay::of_drives(const Mechanism& mechanism, double from, double to) {
  InputWay way(mechanism);
  if (!way.evaluate(to)) return way;
  const Eigen::VectorXd end = way.value();
  const Eigen::VectorXd fast = way.rate();
  if (!way.evaluate(from)) return way;
  const double during = to - from;
  // A drive may rest at one end, and turn back between the two.
  const Eigen::VectorXd change =
      (end - way.value()).cwiseAbs().cwiseMax(std::abs(during) * fast.cwiseAbs().cwiseMax(way.rate().cwiseAbs()));
  way.set_scale(change, during);
  return way;
}

InputWay InputWay::straight(const Mechanism& mechanism, const State& state) {
  InputWay way(mechanism);
  way.by_drives_ = false;
  way.from_.resize(state.input.size());
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    way.from_[static_cast<Eigen::Index>(i)] = state.q[mechanism.inputs[i].q];
  }
  way.at_.input_rate = state.input - way.from_;
  way.at_.input_acceleration.setZero();
  way.time_from_ = state.history.time;
  way.time_rate_ = state.time - state.history.time;
  way.set_scale(way.at_.input_rate.cwiseAbs(), 1.0);
  return way;
}

void InputWay::set_scale(const Eigen::VectorXd& change, double during) {
  double greatest = 0.0;
  for (std::size_t i = 0; i < mechanism_->inputs.size(); ++i) {
    const double moved = change[static_cast<Eigen::Index>(i)] / mechanism_->rate_scale[mechanism_->inputs[i].v];
    greatest = std::max(greatest, moved);
  }
  scale_ = std::abs(during);
  if (greatest > 0.0) scale_ /= greatest;
  if (!(scale_ > 0.0) || !std::isfinite(scale_)) scale_ = 1.0;
}

bool InputWay::evaluate(double parameter) {
  if (by_drives_) {
    culprit_ = set_time(*mechanism_, parameter, at_);
    return culprit_ == nullptr;
  }
  at_.input = from_ + parameter * at_.input_rate;
  at_.time = time_from_ + parameter * time_rate_;
  return true;
}

bool drives_lead(const Mechanism& mechanism, const State& state) {
  if (state.time == state.history.time) return false;
  State drives(mechanism);
  if (set_time(mechanism, state.history.time, drives) != nullptr) return false;
  for (std::size_t i = 0; i < mechanism.inputs.size(); ++i) {
    if (drives.input[static_cast<Eigen::Index>(i)] != state.q[mechanism.inputs[i].q]) return false;
  }
  return set_time(mechanism, state.time, drives) == nullptr && drives.input == state.input;
}

}  // namespace koppel
