// What the times were taken on.
#pragma once

#include <functional>
#include <memory>

#include "bench/rounds.hpp"

namespace koppel::app::bench {

/// Processor, cores, system, compiler and flags.
Json machine();
/// Runs that wait for a processor, mean of the last minute; null where the system does not tell.
Json load();

/// A fixed piece of arithmetic, by whose time machines can be compared [s].
double yardstick();

/// Memory [bytes] that what is made holds as long as it is there, the heap's own overhead included; null where the heap
/// does not tell (under sanitizers), or if nothing was made.
Json memory_of(const std::function<std::shared_ptr<void>()>& make);

}  // namespace koppel::app::bench
