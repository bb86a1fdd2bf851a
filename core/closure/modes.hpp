// All assembly modes of a mechanism: every closed position that it has for the inputs as they are.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "closure/flow.hpp"
#include "closure/work.hpp"
#include "mechanism/state.hpp"

namespace koppel {

struct Mode {
  /// Which solution each step of the flow with several took, as "1.2.1". Of steps in closed form it stays the same
  /// along a motion up to a limit position.
  std::string id;
  Eigen::VectorXd q;      ///< closed, angles nearest to those of the state
  double residual = 0.0;  ///< greatest scaled equation
  bool limit = false;     ///< two modes meet here, or nearly
};

struct Modes {
  std::vector<Mode> modes;
  bool complete = false;  ///< there are no others
  std::string why;        ///< how that is known, or why it is not
  std::size_t twins = 1;  ///< how many positions of links with a ball and a Cardan joint each mode stands for
  /// Coordinates that no input determines and that were taken from the state: of others nothing is said.
  std::size_t held = 0;
  std::vector<double> missed_by;  ///< of dead ends in one unknown: by which part of its range (Roots::missed_by)
};

struct ModeOptions {
  std::size_t most = 4096;            ///< modes; the search ends there
  std::size_t most_steps = 1u << 20;  ///< of the flow, over all ways through it; the search ends there
  bool nearest_first = false;         ///< of each step's solutions the one nearest to the state is tried first
  bool all_twins = false;       ///< list all positions of links that can turn over unnoticed, not only if there is one
  std::size_t restarts = 2000;  ///< random starts where there is no other way
  /// Called as the search goes on, with the modes found and the part done (0 to 1). False stops it.
  std::function<bool(std::size_t found, double part)> progress;
};

/// Finds the modes with the inputs held at the state's values and everything that no input determines as it is in the
/// state. The state need not be closed. A mechanism without a flow is tried from random starts. Every mode is checked
/// by the equations of closure, which the flow does not use, and taken to rounding by Newton's method. False: a plugin
/// failed.
bool find_modes(Work& work, const State& state, const ModeOptions& options, Modes& modes);

}  // namespace koppel
