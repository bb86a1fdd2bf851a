#include "closure/flow_closing.hpp"

#include "closure/flow.hpp"
#include "closure/modes.hpp"

namespace koppel {

FlowOutcome close_by_flow(Work& work, const State& state, Report& report) {
  ModeOptions options;
  options.most = 1;
  options.nearest_first = true;
  options.restarts = 200;
  // Large blocks could go on for minutes; a number of paths, not a time, so that equal starts give equal answers.
  constexpr std::size_t most_paths = 3000;
  options.progress = [calls = std::size_t{0}](std::size_t, double) mutable { return ++calls < most_paths; };
  Modes modes;
  if (!find_modes(work, state, options, modes)) return FlowOutcome::plugin_failed;
  if (modes.modes.empty()) {
    return modes.complete && modes.held == 0 ? FlowOutcome::unreachable : FlowOutcome::unknown;
  }
  work.q = modes.modes.front().q;
  if (!work.equations.evaluate(work.q, state.time)) return FlowOutcome::plugin_failed;
  report.solver = SolverUsed::flow;
  return FlowOutcome::closed;
}

}  // namespace koppel
