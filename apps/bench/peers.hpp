// Other engines on the same motions, each in a program of its own (peers/peer.hpp) that may not have been built.
#pragma once

#include "bench/bench.hpp"
#include "bench/trial.hpp"

namespace koppel::app::bench {

/// Asks the programs in the plan's folder what they can do; who is there, and how to get who is not, stands in "peers".
void ask_peers(Bench& bench);

/// Adds a series to those at `place` for each method of each engine that can move the problem. An engine that comes
/// nowhere near the reference does not move the same mechanism: it is left out, and "peers" says so.
void add_peers(Bench& bench, const Problem& problem, const Trial& trial, const Reference& reference,
               const Json::json_pointer& place);

}  // namespace koppel::app::bench
