// Simulating a mechanism: its motion under forces and drives from a closed state on, with its accuracy.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "dynamics/archive.hpp"
#include "dynamics/crossings.hpp"
#include "dynamics/equations_of_motion.hpp"
#include "dynamics/integrator.hpp"
#include "dynamics/motion_equation.hpp"
#include "dynamics/simulation_options.hpp"
#include "dynamics/switch_watch.hpp"
#include "mechanism/state.hpp"

namespace koppel {

/// How a simulation went so far.
struct SimulationSummary {
  std::uint64_t steps = 0, rejected = 0, evaluations = 0;
  std::uint64_t events = 0;    ///< kinks and jumps of forces at which steps were made to end
  std::uint32_t switches = 0;  ///< how often other coordinates were chosen as independent
  double energy = 0.0;         ///< [J] kinetic and potential, at the end of the last step
  double energy_error = 0.0;   ///< [J] greatest change of energy that no work explains
  double energy_size = 0.0;  ///< [J] greatest kinetic energy plus the range of the potential one: what to compare with
  double position_drift = 0.0;  ///< greatest scaled closure residual at the end of a step
  double velocity_drift = 0.0;  ///< greatest scaled rate at which a closure equation opened [1/s]
  bool stiff = false;           ///< many steps were shortened by stability, not by accuracy
  double start_change = 0.0;    ///< greatest change of a start rate that was asked for, to what the loops allow
};

class Simulation {
 public:
  /// Errors: those of inertias().
  static Result<std::unique_ptr<Simulation>> of(std::shared_ptr<const Mechanism> mechanism,
                                                const SimulationOptions& options);

  /// From a closed state. Its rates are taken as they are, if they belong to it; else those that the scene asks for,
  /// as nearly as the loops allow, fixed ones before others, and of what nobody asks for the least. Errors:
  /// simulation_stuck, massless, plugin_misbehaved; inputs_inconsistent: a fixed rate cannot be met.
  Result<void> start(const State& state);

  /// On to a time not before the last one. state: there, with all rates and accelerations. On an error it is as before,
  /// and the simulation goes no further.
  Result<void> advance(double time, State& state);
  /// The same, but no further than to the first crossing of a value that the scene watches. Nothing: there is none.
  Result<std::optional<Crossing>> advance_watching(double time, State& state);

  /// All that it goes on from: the same simulation goes on bit for bit as what is loaded from it. An integrator of a
  /// library (SUNDIALS) starts again at the time that was shown last, here and there.
  Result<std::vector<unsigned char>> save();
  /// What was saved, of the same scene; advance() to shown() gives the state. Errors: those of of(), invalid_argument:
  /// not saved, by another version, damaged, or of another scene.
  static Result<std::unique_ptr<Simulation>> load(std::shared_ptr<const Mechanism> mechanism,
                                                  std::span<const unsigned char> bytes);

  /// The time that was shown last.
  double shown() const { return shown_; }
  const SimulationSummary& summary() const { return summary_; }
  const SimulationOptions& options() const { return options_; }
  /// Rates that are independent now.
  const std::vector<std::uint32_t>& independent() const { return motion_.independent(); }

 private:
  Simulation(std::shared_ptr<const Mechanism> mechanism, Inertias inertias, const SimulationOptions& options);
  Result<void> stuck(double time) const;
  std::string remedy() const;
  double energy_scale(double kinetic) const;
  double pull() const;
  Result<void> take_rates(const State& state);
  Result<void> step(double limit);
  Result<void> go_on(double time);
  Result<std::optional<Crossing>> go_watching(double time);
  bool judge();
  bool exchange(Archive& archive);
  Result<void> show(double time, State& state);

  std::shared_ptr<const Mechanism> mechanism_;
  SimulationOptions options_;
  EquationsOfMotion motion_;
  std::unique_ptr<MotionEquation> equation_;
  SwitchWatch watch_;
  Crossings crossings_;
  std::unique_ptr<Integrator> method_;
  Eigen::VectorXd y_, a_;
  SimulationSummary summary_;
  std::optional<Error> failed_;  ///< why it goes no further
  double shown_ = 0.0;
  double balance_ = 0.0;  ///< energy less work, at the start
  bool worn_ = false;     ///< other coordinates come before the next step
  double lowest_ = 0.0, highest_ = 0.0, liveliest_ = 0.0;
};

}  // namespace koppel
