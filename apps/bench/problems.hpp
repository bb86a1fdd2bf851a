// The motions that are measured, and what is known of them. A new scene is one line in problems.cpp.
#pragma once

#include <string>
#include <vector>

namespace koppel::app::bench {

/// A value that is known: of a coordinate, a rate or a recorded column [rad, m, 1, and those per second].
struct Digit {
  std::string name;
  double value;
};

/// A scene of apps/scenes/dynamics, moved from its start to `end`.
struct Problem {
  std::string name;  ///< of the scene file
  double end;        ///< [s]
  /// What is known at the end. None: all coordinates, as koppel itself finds them at two higher accuracies.
  std::vector<Digit> digits = {};
  std::string source = {};   ///< of the digits
  double uncertainty = 0.0;  ///< of them, beyond rounding
  /// Measured too by the methods that keep loops as constraints.
  bool with_multipliers = false;
};

const std::vector<Problem>& problems();

/// Scenes in a folder; those that a drive moves are what closures are timed on.
std::vector<std::string> closure_scenes(const std::string& folder);

/// Chains that are timed at several lengths.
std::vector<std::string> scaling_names();

}  // namespace koppel::app::bench
