// A diagonally implicit Runge-Kutta pair by ARKODE of SUNDIALS: for stiff forces, and where steps are often made to
// end.
#pragma once

#include "dynamics/sundials_integrator.hpp"

namespace koppel {

/// Order 5, stiffly accurate (Kvaerno, Singly diagonally implicit Runge-Kutta methods with an explicit first stage,
/// 2004), steps by the tolerance; Newton's method with a dense Jacobian by difference quotients (Reynolds et al.,
/// ARKODE: a flexible IVP solver infrastructure for one-step methods, 2023). It remembers no steps: where it starts
/// again it keeps its order, and after restart() its step.
class Arkode final : public SundialsOde {
 public:
  /// Throws std::bad_alloc.
  Arkode(DifferentialEquation& problem, double tolerance, double first_step)
      : SundialsOde(problem, tolerance, first_step) {}
  ~Arkode() override;

  bool start(double t, const Eigen::VectorXd& y) override { return begin(t, y, 0.0); }
  bool restart(double t, const Eigen::VectorXd& y) override;
  void settle(const Eigen::VectorXd& y) override;

 private:
  void create();
  bool begin(double t, const Eigen::VectorXd& y, double first_step);
  int advance(double limit, double least, double& t) override;
  long failures() const override;
  int last_order() const override { return 5; }
  bool derivative(int k, N_Vector into) override;

  void* memory_ = nullptr;
};

}  // namespace koppel
