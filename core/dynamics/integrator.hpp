// Integrators of differential equations: what they have in common, and how one is chosen by its name.
#pragma once

#include <cstdint>
#include <memory>

#include <Eigen/Core>

#include "dynamics/archive.hpp"
#include "dynamics/differential_equation.hpp"
#include "scene/integrators.hpp"

namespace koppel {

enum class StepStatus {
  done,
  too_small,  ///< no step is small enough: the problem cannot be evaluated further on, or is too stiff
};

/// One step after another. After start(), restart() and step() the problem was evaluated last at (time(), y()).
class Integrator {
 public:
  struct Statistics {
    std::uint64_t steps = 0, rejected = 0, evaluations = 0;
    bool stiff = false;  ///< many steps were as short as stability wants them, not accuracy (explicit pairs only)
  };

  Integrator(DifferentialEquation& problem, double tolerance, double step)
      : problem_(&problem), tolerance_(tolerance), step_(step) {}
  Integrator(const Integrator&) = default;
  Integrator& operator=(const Integrator&) = default;
  virtual ~Integrator() = default;

  /// From (t, y) on; forgets all steps. False: the problem has no rate there.
  virtual bool start(double t, const Eigen::VectorXd& y) = 0;
  /// One step, not beyond the limit.
  virtual StepStatus step(double limit) = 0;
  /// Lets the last step end at t, between its ends, to the same accuracy. False: it cannot be evaluated there.
  virtual bool shorten(double t) = 0;
  /// y within the last step, at its ends and between them. May evaluate the problem there.
  virtual void interpolate(double t, Eigen::VectorXd& y) = 0;
  /// Goes on from (t, y), perhaps in other coordinates, with steps as long as before where it can. False: as start().
  virtual bool restart(double t, const Eigen::VectorXd& y) = 0;
  /// Before exchange(): keeps of the past only what it can tell, from t on, which lies within the last step. False: as
  /// start().
  virtual bool pause(double) { return true; }
  /// Tells all that it goes on from, bit for bit after pause(). False: what is read is not of this method and problem.
  virtual bool exchange(Archive& archive);
  /// Changes y at the end of the step: components of infinite scale, others by no more than the error of the step.
  virtual void settle(const Eigen::VectorXd& y) { y_ = y; }

  double time() const { return time_; }
  double time_before() const { return before_; }
  const Eigen::VectorXd& y() const { return y_; }
  const Statistics& statistics() const { return statistics_; }

 protected:
  bool evaluate(double t, const Eigen::VectorXd& y, Eigen::VectorXd& rate) {
    ++statistics_.evaluations;
    return problem_->rate(t, y, rate) && rate.allFinite();
  }

  DifferentialEquation* problem_;
  double tolerance_, step_;  ///< [s] the next step's length
  double time_ = 0.0, before_ = 0.0;
  Eigen::VectorXd y_;
  Statistics statistics_;
};

/// tolerance: of a step's error in the problem's scales, for those that adapt their steps. step: of fixed steps, else 0
/// or the first; it is used up to the limit of the first step. Null: the integrator is for mechanisms with loops as
/// constraints (Formulation), and the problem is none. Throws std::bad_alloc.
std::unique_ptr<Integrator> make_integrator(IntegratorKind kind, DifferentialEquation& problem, double tolerance,
                                            double step);

}  // namespace koppel
