// Closing by the solution flow: where all solutions are known, so is whether there is one.
#pragma once

#include "closure/report.hpp"
#include "closure/work.hpp"
#include "mechanism/state.hpp"

namespace koppel {

enum class FlowOutcome {
  closed,       ///< work.q is closed; the equations stand there
  unreachable,  ///< there is no closed position for these inputs, and that is certain
  unknown,      ///< none was found, or the mechanism has no flow
  plugin_failed
};

/// Goes through the mechanism's flow for the state's inputs, of each step's solutions the one nearest to the state's
/// position first, and back where it comes to a dead end. Linear in the number of loops as long as there are none.
FlowOutcome close_by_flow(Work& work, const State& state, Report& report);

}  // namespace koppel
