#include "mechanism/kinematics.hpp"

#include "benchmarks.hpp"
#include "closure/work.hpp"

namespace koppel::bench {
namespace {

/// The positions of the run are closed: how well, and that a closure finds nothing left to do.
void show_positions(benchmark::State& timer, const Run& run) {
  Work work(run.mechanism);
  Figures figures(*run.mechanism);
  for (State state : run.states) {
    Report report;
    if (close(work, state, {}, report) < 0) return timer.SkipWithError("a position of the run is not closed");
    figures.take(report);
  }
  figures.show(timer);
}

}  // namespace

void position(benchmark::State& timer, const Run& run) {
  Kinematics kinematics(*run.mechanism);
  const auto batch = static_cast<benchmark::IterationCount>(run.states.size());
  bool fine = true;
  while (timer.KeepRunningBatch(batch)) {
    for (const State& state : run.states) {
      fine &= forward_position(*run.mechanism, state.q.data(), kinematics);
      benchmark::DoNotOptimize(kinematics.poses.data());
    }
  }
  if (!fine) return timer.SkipWithError("a joint failed");
  show_positions(timer, run);
}

void position_and_motion(benchmark::State& timer, const Run& run) {
  Kinematics kinematics(*run.mechanism);
  const auto batch = static_cast<benchmark::IterationCount>(run.states.size());
  bool fine = true;
  while (timer.KeepRunningBatch(batch)) {
    for (const State& state : run.states) {
      fine &= forward_position(*run.mechanism, state.q.data(), kinematics) &&
              forward_motion(*run.mechanism, state.q.data(), state.v.data(), state.a.data(), kinematics);
      benchmark::DoNotOptimize(kinematics.motions.data());
    }
  }
  if (!fine) return timer.SkipWithError("a joint failed");
  show_positions(timer, run);
}

}  // namespace koppel::bench
