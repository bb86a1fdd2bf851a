// Euler's semi-implicit method: bounded energy errors of mechanisms for very long times, at little cost and accuracy.
#pragma once

#include "dynamics/integrator.hpp"

namespace koppel {

/// Fixed steps of order 1: velocities by the forces where the step begins, then positions by the velocities where it
/// ends; symplectic where masses do not depend on positions (Hairer, Lubich, Wanner: Geometric Numerical Integration,
/// I.1.2). Without positions it is Euler's explicit method. Straight lines lie between the ends.
class SemiImplicitEuler final : public Integrator {
 public:
  SemiImplicitEuler(DifferentialEquation& problem, double, double step) : Integrator(problem, 0.0, step) {}

  bool start(double t, const Eigen::VectorXd& y) override;
  StepStatus step(double limit) override;
  bool shorten(double t) override;
  void interpolate(double t, Eigen::VectorXd& y) override;
  bool restart(double t, const Eigen::VectorXd& y) override { return start(t, y); }
  bool exchange(Archive& archive) override;

 private:
  bool move(double h);

  Eigen::VectorXd y_before_, slope_, slope_before_;
};

}  // namespace koppel
