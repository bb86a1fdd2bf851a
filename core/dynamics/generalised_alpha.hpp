// The generalised-alpha method: fixed steps of mechanisms with loops as constraints of index 3, for stiff forces too.
#pragma once

#include <Eigen/LU>

#include "dynamics/constrained_equation.hpp"
#include "dynamics/integrator.hpp"

namespace koppel {

/// Order 2, unconditionally stable for linear forces; what is too quick for the step fades by the factor 0.9 a step
/// (Chung, Hulbert, A time integration algorithm for structural dynamics with improved numerical dissipation, 1993).
/// Turns are taken as turns (Bruels, Cardona, On the use of Lie group time integrators in multibody dynamics, 2010).
/// Positions close the loops to rounding; rates do by the error of a step. Newton's method with a Jacobian by
/// difference quotients that serves until it converges too slowly.
class GeneralisedAlpha final : public Integrator {
 public:
  GeneralisedAlpha(ConstrainedEquation& problem, double, double step)
      : Integrator(problem, 0.0, step), loops_(problem) {}

  bool start(double t, const Eigen::VectorXd& y) override;
  StepStatus step(double limit) override;
  bool shorten(double t) override;
  /// A parabola by the ends and the slope where the step begins.
  void interpolate(double t, Eigen::VectorXd& y) override;
  bool restart(double t, const Eigen::VectorXd& y) override { return start(t, y); }
  bool exchange(Archive& archive) override;

 private:
  /// Where a step begins or ends: unknowns, their slopes, what the method carries on in their place, and multipliers.
  struct Point {
    Eigen::VectorXd u, slope, carried, lambda;  ///< 2 n + s + 1; n + s, twice; m
    double power = 0.0;
  };

  bool move(double h);
  void predict(double h);
  void go(double h);
  bool reach(double h);
  bool differentiate(double h);
  double correct(double h);
  bool polish(double h);

  ConstrainedEquation& loops_;
  ConstrainedEquation::Sizes sizes_;
  Point from_, to_;
  Eigen::VectorXd change_;  ///< n + s: of the slopes' trend, over the time
  Eigen::VectorXd increment_, bending_, unknowns_rate_, no_mu_, missing_, shifted_, scales_, x_, y_before_, y_slope_;
  Eigen::MatrixXd jacobian_;
  Eigen::PartialPivLU<Eigen::MatrixXd> factors_;
  double jacobian_step_ = 0.0;  ///< [s] for which it holds; 0: there is none
  double length_ = 0.0;         ///< [s] of the last step
  bool slope_known_ = false;    ///< y_slope_ is where the last step began
};

}  // namespace koppel
