// What koppel and other engines are compared by: one table, and programs that answer.
#pragma once

#include <string>
#include <vector>

namespace koppel::bench {

/// What a command prints; nothing if it fails.
std::string output_of(const std::string& command);

/// The programs of other engines (apps/bench/peers) that were built: they are beside this one.
struct PeerProgram {
  std::string engine;   ///< with its version
  std::string command;  ///< ready for a shell
};
/// Says which are missing.
std::vector<PeerProgram> peer_programs();

/// One line of the table in the making: an engine on a tree, by rounds.
struct Row {
  std::vector<double> seconds, ratios;  ///< ratios: over the first engine in the same round
  double error = 0.0;
  bool is_measure = false;  ///< the others' errors are their differences from it

  /// A line of the table; without a time if the error is above what is allowed.
  void show(const std::string& problem, const std::string& what, const std::string& engine, double allowed) const;
};

/// Accelerations of mechanisms with loops where they start, by all engines in turn.
void compare_loops(const std::vector<PeerProgram>& peers, int rounds);

}  // namespace koppel::bench
