#include "dynamics/multiplier_equation.hpp"

namespace koppel {

MultiplierEquation::MultiplierEquation(EquationsOfMotion& motion, AfterSteps after)
    : MotionEquation(motion), after_(after), v_(Eigen::VectorXd::Zero(rates_)) {}

bool MultiplierEquation::place(double time, const Eigen::VectorXd& y) {
  delta_ = y.head(rates_);
  for (std::size_t i = 0; i < integrated().size(); ++i) v_[integrated()[i]] = rates_of(y)[static_cast<Eigen::Index>(i)];
  return motion_.stand(chart_, time, delta_, v_);
}

/// The independent coordinates and rates stay, the others follow from them.
bool MultiplierEquation::project(double time, Eigen::VectorXd& y) {
  if (!place(time, y)) return false;
  const std::vector<std::uint32_t>& independent = motion_.independent();
  independent_.resize(static_cast<Eigen::Index>(independent.size()));
  for (std::size_t i = 0; i < independent.size(); ++i) independent_[static_cast<Eigen::Index>(i)] = v_[independent[i]];
  if (!motion_.close(chart_, time, delta_) || !motion_.velocities(independent_)) return false;
  y.head(rates_) = delta_;
  write(motion_.v(), y);
  return true;
}

bool MultiplierEquation::realise(double time, const Eigen::VectorXd& y) {
  shown_ = y;
  return project(time, shown_) && rate(time, shown_, shown_rate_);
}

bool MultiplierEquation::settle(double time, Eigen::VectorXd& y) {
  return after_ == AfterSteps::leave || project(time, y);
}

}  // namespace koppel
