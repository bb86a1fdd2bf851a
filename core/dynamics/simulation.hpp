// Simulating a mechanism: its motion under forces and drives from a closed state on, with its accuracy.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "base/error.hpp"
#include "dynamics/equations_of_motion.hpp"
#include "dynamics/minimal_equation.hpp"
#include "dynamics/runge_kutta.hpp"
#include "mechanism/state.hpp"

namespace koppel {

struct SimulationOptions {
  double tolerance = 1e-8;  ///< of one step: radians, lengths over the scene's, their rates per second
  double step = 0.0;        ///< [s] fixed steps, of the classical method; 0: Dormand and Prince's, by the tolerance
  double end = 0.0;         ///< [s] where the last step shall end
};

/// How a simulation went so far.
struct SimulationSummary {
  std::uint64_t steps = 0, rejected = 0, evaluations = 0;
  std::uint32_t switches = 0;  ///< how often other coordinates were chosen as independent
  double energy = 0.0;         ///< [J] kinetic and potential, at the end of the last step
  double energy_error = 0.0;   ///< [J] greatest change of energy that no work explains
  double energy_size = 0.0;  ///< [J] greatest kinetic energy plus the range of the potential one: what to compare with
  double position_drift = 0.0;  ///< greatest scaled closure residual at the end of a step
  double velocity_drift = 0.0;  ///< greatest scaled rate at which a closure equation opened [1/s]
  double start_change = 0.0;    ///< greatest change of a start rate that was asked for, to what the loops allow
};

class Simulation {
 public:
  /// Errors: those of inertias().
  static Result<std::unique_ptr<Simulation>> of(std::shared_ptr<const Mechanism> mechanism,
                                                const SimulationOptions& options);

  /// From a closed state. Its rates are taken as they are, if they belong to it; else those that the scene asks for,
  /// as nearly as the loops allow, and of what nobody asks for the least. Errors: simulation_stuck, massless,
  /// plugin_misbehaved.
  Result<void> start(const State& state);

  /// On to a time not before the last one. state: there, with all rates and accelerations. On an error it is as before.
  Result<void> advance(double time, State& state);

  /// The time that was shown last.
  double shown() const { return shown_; }
  const SimulationSummary& summary() const { return summary_; }
  /// Rates that are independent now.
  const std::vector<std::uint32_t>& independent() const { return motion_.independent(); }

 private:
  Simulation(std::shared_ptr<const Mechanism> mechanism, Inertias inertias, const SimulationOptions& options);
  Result<void> stuck(double time) const;
  double energy_scale(double kinetic) const;
  bool take_rates(const State& state);
  Result<void> step(double limit);
  bool judge();
  Result<void> show(double time, State& state);

  std::shared_ptr<const Mechanism> mechanism_;
  SimulationOptions options_;
  EquationsOfMotion motion_;
  MinimalEquation equation_;
  std::unique_ptr<RungeKutta> method_;
  Eigen::VectorXd y_, a_;
  SimulationSummary summary_;
  double shown_ = 0.0;
  double balance_ = 0.0;  ///< energy less work, at the start
  double lowest_ = 0.0, highest_ = 0.0, liveliest_ = 0.0;
};

}  // namespace koppel
