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
  /// component where that is larger. Infinite for components that follow from others.
  virtual const Eigen::VectorXd& scales() const = 0;
  /// y' at t. False: there is none here; nearer to the last position there may be.
  virtual bool rate(double t, const Eigen::VectorXd& y, Eigen::VectorXd& y_rate) = 0;
};

}  // namespace koppel
