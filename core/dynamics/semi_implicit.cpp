#include "dynamics/semi_implicit.hpp"

#include <cmath>
#include <limits>

namespace koppel {

bool SemiImplicitEuler::start(double t, const Eigen::VectorXd& y) {
  time_ = before_ = t;
  y_ = y_before_ = y;
  slope_.setZero(y.size());
  slope_before_.setZero(y.size());
  return evaluate(t, y_, slope_);
}

bool SemiImplicitEuler::exchange(Archive& archive) {
  const bool fit = Integrator::exchange(archive);
  archive(y_before_, slope_, slope_before_);
  return fit && archive.good() && y_before_.size() == y_.size() && slope_.size() == y_.size() &&
         slope_before_.size() == y_.size();
}

/// A step from y_before_, where the slope is slope_before_.
bool SemiImplicitEuler::move(double h) {
  const Eigen::Index positions = problem_->positions(), others = y_.size() - positions;
  y_.head(positions) = y_before_.head(positions);
  y_.tail(others) = y_before_.tail(others) + h * slope_before_.tail(others);
  slope_ = slope_before_;
  if (positions > 0 && !problem_->position_rates(before_, y_, slope_)) return false;
  y_.head(positions) += h * slope_.head(positions);
  return y_.allFinite() && evaluate(before_ + h, y_, slope_);
}

StepStatus SemiImplicitEuler::step(double limit) {
  y_before_ = y_;
  slope_before_ = slope_;
  before_ = time_;
  const double rest = limit - time_;
  const bool last = rest <= step_ * (1.0 + 1e-9);
  const double end = last ? limit : time_ + step_;
  if (!move(end - time_)) {  // steps add up to the time that has passed
    y_ = y_before_;
    slope_ = slope_before_;
    return StepStatus::too_small;
  }
  time_ = end;
  ++statistics_.steps;
  return StepStatus::done;
}

bool SemiImplicitEuler::shorten(double t) {
  time_ = t;
  return move(t - before_);
}

void SemiImplicitEuler::interpolate(double t, Eigen::VectorXd& y) {
  if (t == time_) {
    y = y_;
    return;
  }
  y = y_before_ + (t - before_) / (time_ - before_) * (y_ - y_before_);
}

}  // namespace koppel
