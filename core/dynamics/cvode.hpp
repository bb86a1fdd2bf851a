// Backward differentiation formulas by CVODE of SUNDIALS: implicit, so that stiff forces do not shorten the steps.
#pragma once

#include <memory>

#include "dynamics/integrator.hpp"

namespace koppel {

/// Orders 1 to 5 and steps by the tolerance; Newton's method with a dense Jacobian by difference quotients (Hindmarsh
/// et al., SUNDIALS: Suite of Nonlinear and Differential/Algebraic Equation Solvers, 2005). It remembers past steps:
/// where a step is shortened, coordinates change or it pauses, it starts again with order 1.
class Cvode final : public Integrator {
 public:
  /// Throws std::bad_alloc.
  Cvode(DifferentialEquation& problem, double tolerance, double first_step);
  Cvode(const Cvode&) = delete;
  Cvode& operator=(const Cvode&) = delete;
  ~Cvode() override;

  bool start(double t, const Eigen::VectorXd& y) override;
  StepStatus step(double limit) override;
  bool shorten(double t) override;
  void interpolate(double t, Eigen::VectorXd& y) override;
  bool restart(double t, const Eigen::VectorXd& y) override { return start(t, y); }
  /// It starts again there: what it remembers of past steps is its own.
  bool pause(double t) override { return t < time_ ? shorten(t) : start(time_, Eigen::VectorXd(y_)); }
  bool exchange(Archive& archive) override;

 private:
  struct Memory;  ///< what SUNDIALS holds
  friend struct Memory;

  std::unique_ptr<Memory> memory_;
  Eigen::VectorXd argument_, rate_, moved_;
};

}  // namespace koppel
