// Backward differentiation formulas by CVODE of SUNDIALS: implicit, so that stiff forces do not shorten the steps.
#pragma once

#include "dynamics/sundials_integrator.hpp"

namespace koppel {

/// Orders 1 to 5 and steps by the tolerance; Newton's method with a dense Jacobian by difference quotients (Hindmarsh
/// et al., SUNDIALS: Suite of Nonlinear and Differential/Algebraic Equation Solvers, 2005). It remembers past steps:
/// where it starts again it does so with order 1.
class Cvode final : public SundialsOde {
 public:
  /// Throws std::bad_alloc.
  Cvode(DifferentialEquation& problem, double tolerance, double first_step)
      : SundialsOde(problem, tolerance, first_step) {}
  ~Cvode() override;

  bool start(double t, const Eigen::VectorXd& y) override;

 private:
  void create();
  int advance(double limit, double least, double& t) override;
  long failures() const override;
  int last_order() const override;
  bool derivative(int k, N_Vector into) override;

  void* memory_ = nullptr;
};

}  // namespace koppel
