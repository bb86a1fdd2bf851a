#include "closure/modes.hpp"

#include <algorithm>

#include "benchmarks.hpp"

namespace koppel::bench {

void all_modes(benchmark::State& timer, const Run& run) {
  Work work(run.mechanism);
  State start(*run.mechanism);
  set_time(*run.mechanism, 0.0, start);
  Modes modes;
  while (timer.KeepRunning()) {
    if (!find_modes(work, start, {}, modes)) return timer.SkipWithError("a plugin failed");
  }
  double residual = 0.0;
  for (const Mode& mode : modes.modes) residual = std::max(residual, mode.residual);
  timer.counters["modes"] = static_cast<double>(modes.modes.size());
  timer.counters["complete"] = modes.complete ? 1.0 : 0.0;
  timer.counters["residual"] = residual;
}

}  // namespace koppel::bench
