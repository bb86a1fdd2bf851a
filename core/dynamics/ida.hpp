// Backward differentiation formulas by IDA of SUNDIALS, the heir of DASSL: mechanisms with loops as constraints of
// index 2.
#pragma once

#include "dynamics/constrained_equation.hpp"
#include "dynamics/sundials_integrator.hpp"

namespace koppel {

/// Orders 1 to 5 and steps by the tolerance of positions, rates and states; multipliers are solved for and not
/// controlled (Brenan, Campbell, Petzold, Numerical solution of initial-value problems in differential-algebraic
/// equations, 1996). Newton's method with a dense Jacobian by difference quotients. It remembers past steps: where it
/// starts again it does so with order 1.
class Ida final : public SundialsIntegrator {
 public:
  /// Throws std::bad_alloc.
  Ida(ConstrainedEquation& problem, double tolerance, double first_step);
  ~Ida() override;

  bool start(double t, const Eigen::VectorXd& y) override;

 private:
  void create();
  bool find_missing(double t, const Eigen::VectorXd& unknowns, const Eigen::VectorXd& unknowns_rate);
  int advance(double limit, double least, double& t) override;
  long failures() const override;
  int last_order() const override;
  bool derivative(int k, N_Vector into) override;
  bool unfold(double t, const Eigen::VectorXd& unknowns, Eigen::VectorXd& y) override;

  /// For SUNDIALS; `of` is this.
  static int residual(realtype t, N_Vector y, N_Vector y_rate, N_Vector missing, void* of);
  static int weights(N_Vector y, N_Vector weights, void* of);
  static int jacobian(realtype t, realtype c, N_Vector y, N_Vector y_rate, N_Vector missing, SUNMatrix matrix, void* of,
                      N_Vector, N_Vector, N_Vector);

  ConstrainedEquation& loops_;
  ConstrainedEquation::Sizes sizes_;
  void* memory_ = nullptr;
  Eigen::VectorXd scales_;                    ///< of u
  Eigen::VectorXd unknowns_, unknowns_rate_;  ///< u, lambda, mu
  Eigen::VectorXd u_, u_rate_, lambda_, mu_, missing_, missing_before_;
};

}  // namespace koppel
