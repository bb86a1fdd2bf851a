// Explicit Runge-Kutta methods: Dormand and Prince's pair of orders 5 and 4 with error control, and the classical one
// of order 4 with fixed steps (Hairer, Norsett, Wanner: Solving Ordinary Differential Equations I, II.1, II.5 and
// II.6).
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "dynamics/differential_equation.hpp"

namespace koppel {

enum class StepStatus {
  done,
  too_small,  ///< no step is small enough: the problem cannot be evaluated further on, or is too stiff
};

/// One step after another. All numbers of a run are here: a copy goes on bit for bit. Nothing is allocated while
/// stepping.
class RungeKutta {
 public:
  /// tolerance: of a step's error in the problem's scales; 0: fixed steps. step: of fixed steps, else 0 or the first.
  RungeKutta(DifferentialEquation& problem, double tolerance, double step);

  /// From (t, y) on; forgets all steps. False: the problem has no rate there.
  bool start(double t, const Eigen::VectorXd& y);
  /// One step, not beyond the limit.
  StepStatus step(double limit);

  double time() const { return time_; }
  double time_before() const { return before_; }
  const Eigen::VectorXd& y() const { return y_; }
  /// y within the last step, at its ends and between them: to order 4 with error control, else to order 3.
  void interpolate(double t, Eigen::VectorXd& y) const;
  /// Goes on from y in other coordinates, with steps as long as before. False: as start().
  bool restart(const Eigen::VectorXd& y);
  /// Changes components of y at the end of the step that the slope does not depend on.
  void settle(const Eigen::VectorXd& y) { y_ = y; }

  struct Statistics {
    std::uint64_t steps = 0, rejected = 0, evaluations = 0;
  };
  const Statistics& statistics() const { return statistics_; }

 private:
  void resize(Eigen::Index n);
  bool evaluate(double t, const Eigen::VectorXd& y, Eigen::VectorXd& rate);
  bool stages(double h);
  bool classical(double h);
  double error(double h) const;
  double first_step(double limit);

  DifferentialEquation* problem_;
  double tolerance_, step_, time_ = 0.0, before_ = 0.0, last_error_ = 1e-4;
  bool fresh_ = true;  ///< the step to try was not found by an error yet
  Eigen::VectorXd y_, trial_, y_before_, sum_;
  std::array<Eigen::VectorXd, 7> k_;           ///< slopes of the stages; the first is that at y_
  std::array<Eigen::VectorXd, 4> continuous_;  ///< coefficients of the last step's polynomial
  Statistics statistics_;
};

}  // namespace koppel
