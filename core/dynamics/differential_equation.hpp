// What integrators ask of a problem.
#pragma once

#include <Eigen/Core>

namespace koppel {

/// y' = f(t, y).
class DifferentialEquation {
 public:
  virtual ~DifferentialEquation() = default;
  virtual Eigen::Index size() const = 0;
  /// The size of each component that counts as one: errors are measured against the tolerance times this, or times the
  /// component where that is larger. Infinite for components that follow from others: no rate depends on them.
  virtual const Eigen::VectorXd& scales() const = 0;
  /// y' at t. False: there is none here; nearer to the last position there may be.
  virtual bool rate(double t, const Eigen::VectorXd& y, Eigen::VectorXd& y_rate) = 0;
  /// How far rounding may put the rate off that was computed last, in the scales per second: steps that are shorter do
  /// not mend that.
  virtual double rounding() const { return 0.0; }

  /// How many of the first components are positions: their rates follow from the other components without forces.
  virtual Eigen::Index positions() const { return 0; }
  /// The rates of these only, into the first components of y_rate. False: as rate().
  virtual bool position_rates(double t, const Eigen::VectorXd& y, Eigen::VectorXd& y_rate) {
    return rate(t, y, y_rate);
  }
};

}  // namespace koppel
