// Explicit Runge-Kutta methods, each a table: stages, results and what lies between the ends of a step (Hairer,
// Norsett, Wanner: Solving Ordinary Differential Equations I, II.1 to II.6 and II.10).
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dynamics/integrator.hpp"

namespace koppel {

/// What makes a method. Stages have a node and weights of all slopes before them. The last stage stands at the end of
/// the step, and its weights are the result's: it is the first of the next step.
struct RungeKuttaTable {
  static constexpr std::size_t most = 16;
  using Weights = std::array<double, most>;
  struct Stage {
    double node;
    Weights weights;
  };
  std::span<const Stage> stages;
  /// Further ones that only what lies between the ends takes.
  std::span<const Stage> between;
  /// Weights of the error's estimate; of two, the first is of the higher order, and they are combined as in dop853.
  /// None: steps are fixed.
  std::span<const Weights> errors;
  /// Weights of the terms of the polynomial between the ends that come after Hermite's.
  std::span<const Weights> polynomial;
  double order;          ///< of the error's estimate, plus one: it grows with this power of the step
  double power, memory;  ///< of the controller, which may also look at the step before (II.4; IV.2)
  double cut, growth;    ///< what one step may be of the one before, at least and at most
  double stability;      ///< length of the stability domain along the negative axis
};

/// All numbers of a run are here: a copy goes on bit for bit. Nothing is allocated while stepping.
class RungeKutta : public Integrator {
 public:
  RungeKutta(const RungeKuttaTable& table, DifferentialEquation& problem, double tolerance, double step);

  bool start(double t, const Eigen::VectorXd& y) override;
  StepStatus step(double limit) override;
  bool shorten(double t) override;
  void interpolate(double t, Eigen::VectorXd& y) override;
  bool restart(double t, const Eigen::VectorXd& y) override;
  bool exchange(Archive& archive) override;

 private:
  const Eigen::VectorXd& last_slope() const { return k_[table_->stages.size() - 1]; }
  bool is_fixed() const { return table_->errors.empty(); }
  void resize(Eigen::Index n);
  bool evaluate_stages(std::span<const RungeKuttaTable::Stage> stages, std::size_t first, double h);
  double blur(double h) const;
  double norm(const RungeKuttaTable::Weights& weights, double h);
  double error(double h);
  double first_step(double limit);
  void control(double error, double tried, double wanted, bool may_not_grow);
  void look_for_stiffness(double h);
  void finish(double end);
  bool take_between();

  const RungeKuttaTable* table_;
  double last_error_ = 1e-4;
  bool fresh_ = true;     ///< the step to try was not found by an error yet
  bool stepped_ = false;  ///< y is the end of a step, with the slope of its last stage
  bool joined_ = true;    ///< the polynomial is complete
  int stiff_steps_ = 0, other_steps_ = 0;
  double rounding_ = 0.0;         ///< greatest of the problem at the stages
  double rounding_at_end_ = 0.0;  ///< at y
  Eigen::VectorXd y_before_, trial_, late_, sum_;
  std::vector<Eigen::VectorXd> k_;           ///< slopes of the stages; the first is that at the step's begin
  std::vector<Eigen::VectorXd> polynomial_;  ///< coefficients of what lies between the ends
};

class DormandPrince final : public RungeKutta {
 public:
  DormandPrince(DifferentialEquation& problem, double tolerance, double first_step);
};

/// Between the ends to order 3.
class ClassicalRungeKutta final : public RungeKutta {
 public:
  ClassicalRungeKutta(DifferentialEquation& problem, double, double step);
};

/// Three more evaluations, where something is asked for between the ends of a step, give order 7 there.
class Dop853 final : public RungeKutta {
 public:
  Dop853(DifferentialEquation& problem, double tolerance, double first_step);
};

}  // namespace koppel
