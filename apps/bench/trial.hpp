// A scene that is simulated again and again from one start, and how far its end is from what is known of it.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "bench/problems.hpp"
#include "common/model.hpp"

namespace koppel::app::bench {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// A method of integration, as koppel_integrators and koppel_formulations name its parts.
struct Method {
  const char* name;
  const char* integrator;
  const char* formulation;
  bool steps;  ///< its setting is a step [s]; else the tolerance of one
};

inline constexpr Method dormand_prince = {"dormand-prince", "dormand_prince", "minimal", false};
inline constexpr Method dop853 = {"dop853", "dop853", "minimal", false};
inline constexpr Method classical = {"classical", "classical", "minimal", true};
inline constexpr Method semi_implicit = {"semi-implicit", "semi_implicit", "minimal", true};
/// Loops as constraints, with multipliers.
inline constexpr Method ggl = {"ggl", "ida", "ggl", false};
inline constexpr Method index3 = {"index3", "generalised_alpha", "index3", true};

/// A method and its one setting.
struct Setting {
  const Method& method;
  double value;
};

/// A closed start of a mechanism, kept with all that is needed to go on from it.
class Trial {
 public:
  /// Closes the scene at t = 0. problem() tells what went wrong, if anything.
  Trial(Model model, double end);

  const std::string& problem() const { return problem_; }
  const Model& model() const { return model_; }

  /// A simulation at the start; null if it cannot be made, and problem() then tells why.
  Simulation ready(const Setting& setting);
  /// Simulates to the end once. The time [s] without that of closing the start; NaN if it did not get there, and
  /// problem() then tells why.
  double run(const Setting& setting);
  /// Of the last run.
  const koppel_simulation_summary& summary() const { return summary_; }
  /// Values at the end of the last run [rad, lengths over the scene's, 1, and per second], by name: coordinates, rates
  /// or recorded columns. NaN for a name that there is not.
  std::vector<double> values(const std::vector<std::string>& names);
  /// What to divide a value by so that it is in those units.
  double scale(const std::string& name) const;

 private:
  bool good(koppel_status status);

  Model model_;
  Motion start_, moved_;
  double end_;
  std::string problem_;
  koppel_error error_ = sized<koppel_error>();
  koppel_simulation_summary summary_ = sized<koppel_simulation_summary>();
};

/// What the end of a motion is compared with.
struct Reference {
  std::vector<std::string> names;
  std::vector<double> values;  ///< as Trial::values
  double uncertainty = 0.0;    ///< of the worst of them
  std::string source;
};

/// The digits of the problem; without any, those that koppel finds at two higher accuracies.
Reference reference_of(const Problem& problem, Trial& trial);

/// Greatest difference of the last run's end from the reference.
double error_of(Trial& trial, const Reference& reference);

}  // namespace koppel::app::bench
