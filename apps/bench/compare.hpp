// What changed between two documents.
#pragma once

#include "bench/rounds.hpp"

namespace koppel::app::bench {

/// Compares all that is in both: times, errors, outcomes. README.md tells what counts as a change, and the members.
Json compare(const Json& old, const Json& now);

}  // namespace koppel::app::bench
