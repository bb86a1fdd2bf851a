// Backward differentiation formulas by IDA of SUNDIALS, the heir of DASSL: mechanisms with loops as constraints of
// index 2.
#pragma once

#include <memory>

#include "dynamics/constrained_equation.hpp"
#include "dynamics/integrator.hpp"

namespace koppel {

/// Orders 1 to 5 and steps by the tolerance of positions, rates and states; multipliers are solved for and not
/// controlled (Brenan, Campbell, Petzold, Numerical solution of initial-value problems in differential-algebraic
/// equations, 1996). Newton's method with a dense Jacobian by difference quotients. It remembers past steps: where a
/// step is shortened, coordinates change or it pauses, it starts again with order 1.
class Ida final : public Integrator {
 public:
  Ida(ConstrainedEquation& problem, double tolerance, double first_step);
  Ida(const Ida&) = delete;
  Ida& operator=(const Ida&) = delete;
  ~Ida() override;

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

  bool residual(double t, const Eigen::VectorXd& unknowns, const Eigen::VectorXd& unknowns_rate);
  bool take(double t);

  ConstrainedEquation& loops_;
  ConstrainedEquation::Sizes sizes_;
  std::unique_ptr<Memory> memory_;
  Eigen::VectorXd scales_;                    ///< of u
  Eigen::VectorXd unknowns_, unknowns_rate_;  ///< u, lambda, mu
  Eigen::VectorXd u_, u_rate_, lambda_, mu_, missing_, missing_before_, moved_;
};

}  // namespace koppel
