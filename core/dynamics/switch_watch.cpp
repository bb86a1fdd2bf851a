#include "dynamics/switch_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace koppel {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr int most_in_a_row = 20;  // events after which a step may pass one: forces that chatter do not stop the time
constexpr int most_refinements = 8;

/// The least difference that counts at a time within a step.
double grain(double t, double step) { return 4.0 * eps * std::max(std::abs(t), step); }

}  // namespace

SwitchWatch::SwitchWatch(EquationsOfMotion& motion, MotionEquation& equation)
    : motion_(motion),
      equation_(equation),
      count_(static_cast<Eigen::Index>(motion.forces().switch_count())),
      sides_(Eigen::VectorXd::Zero(count_)) {
  for (Eigen::VectorXd* x : {&begin_, &end_, &from_, &to_, &middle_}) *x = sides_;
}

bool SwitchWatch::read(const Eigen::VectorXd& y, Eigen::VectorXd& values) {
  return motion_.switches(equation_.states(y), values.data());
}

bool SwitchWatch::values_at(double t, Integrator& method, Eigen::VectorXd& values) {
  method.interpolate(t, y_);
  return equation_.place(t, y_) && read(y_, values);
}

void SwitchWatch::take_sides(const Eigen::VectorXd& values) {
  for (Eigen::Index i = 0; i < count_; ++i) {
    if (values[i] != 0.0) sides_[i] = values[i] > 0.0 ? 1.0 : -1.0;
  }
}

Eigen::Index SwitchWatch::first_change(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
  Eigen::Index first = -1;
  double earliest = 2.0;
  for (Eigen::Index i = 0; i < count_; ++i) {
    if (!(to[i] * sides_[i] < 0.0)) continue;
    const double part = from[i] * sides_[i] > 0.0 ? from[i] / (from[i] - to[i]) : 0.0;
    if (part >= earliest) continue;
    earliest = part;
    first = i;
  }
  return first;
}

bool SwitchWatch::start(const Eigen::VectorXd& y) {
  sides_.setZero();
  met_ = -1;
  events_ = 0;
  in_a_row_ = 0;
  if (count_ == 0) return true;
  if (!read(y, end_)) return false;
  take_sides(end_);
  return true;
}

bool SwitchWatch::go_back(const Integrator& method) {
  if (met_ >= 0) --events_;
  met_ = -1;
  return count_ == 0 || read(method.y(), end_);
}

bool SwitchWatch::exchange(Archive& archive) {
  std::int64_t met = met_;
  archive(sides_, end_, met, behind_, events_, in_a_row_);
  met_ = met;
  return archive.good() && sides_.size() == count_ && end_.size() == count_ && met_ >= -1 && met_ < count_;
}

bool SwitchWatch::look(Integrator& method) {
  if (count_ == 0) return true;
  begin_ = end_;
  if (!read(method.y(), end_)) return false;
  if (first_change(begin_, end_) >= 0 && in_a_row_ < most_in_a_row) {
    if (!locate(method)) return false;
    if (met_ >= 0) {
      ++events_;
      ++in_a_row_;
      return read(method.y(), end_);
    }
  }
  in_a_row_ = 0;
  take_sides(end_);
  return true;
}

/// Halves the step on its polynomial until the first change is between neighbouring times: nothing but positions and
/// rates is computed there. Then the method itself is made to end at this time.
bool SwitchWatch::locate(Integrator& method) {
  const double before = method.time_before(), end = method.time(), least = grain(end, end - before);
  double low = before, high = end;
  from_ = begin_;
  to_ = end_;
  met_ = first_change(from_, to_);
  bool halve = false;
  while (high - low > least) {
    const double part = from_[met_] * sides_[met_] > 0.0 ? from_[met_] / (from_[met_] - to_[met_]) : 0.0;
    // A straight line to the root and a little to the side of the longer piece, in turns with halving.
    const double shift = (part < 0.5 ? 0.5 : -0.5) * least / (high - low);
    const double t = halve ? 0.5 * (low + high) : low + std::clamp(part + shift, 0.0, 1.0) * (high - low);
    halve = !halve;
    if (!(t > low) || !(t < high)) continue;
    if (!values_at(t, method, middle_)) return false;
    const Eigen::Index changed = first_change(from_, middle_);
    if (changed >= 0) {
      high = t;
      to_ = middle_;
      met_ = changed;
    } else {
      low = t;
      from_ = middle_;
    }
  }
  if (low - before <= 4.0 * least) {  // at the begin: that is where it was met, and is left now
    met_ = -1;
    return equation_.place(end, method.y());
  }
  // The slope on a longer piece, where rounding does not count.
  const double piece = std::min(1e-3 * (end - before), low - before);
  if (!values_at(low - piece, method, middle_)) return false;
  const double slope = (from_[met_] - middle_[met_]) / piece;
  if (!method.shorten(low) || !refine(method, end, slope)) return false;
  behind_ = std::min(method.time() + 4.0 * least, end);
  return true;
}

/// The polynomial knows the time to its own order; Newton's method on what the method itself gives knows it better.
bool SwitchWatch::refine(Integrator& method, double end, double slope) {
  const double least = grain(end, end - method.time_before());
  for (int i = 0; i < most_refinements; ++i) {
    if (!read(method.y(), middle_)) return false;
    const double late = slope != 0.0 ? middle_[met_] / slope : 0.0;  // [s] behind the root
    if (!std::isfinite(late) || (late <= 0.0 && late >= -2.0 * least)) return true;
    const double t = method.time() - late - least;
    if (!(t > method.time_before() + least) || !(t < end)) return true;
    if (!method.shorten(t)) return false;
  }
  return true;
}

bool SwitchWatch::cross(Integrator& method, double limit) {
  if (met_ < 0) return true;
  const Eigen::Index met = met_;
  const double other_side = -sides_[met];
  met_ = -1;
  y_ = method.y();
  const double t = std::min(behind_, limit);
  if (!equation_.rate(method.time(), y_, rate_)) return false;
  y_ += (t - method.time()) * rate_;
  if (!method.restart(t, y_) || !read(y_, end_)) return false;
  take_sides(end_);
  // As near as rounding tells it has changed.
  sides_[met] = other_side;
  return true;
}

}  // namespace koppel
