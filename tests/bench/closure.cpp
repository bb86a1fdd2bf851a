#include "benchmarks.hpp"
#include "closure/close.hpp"

namespace koppel::bench {
namespace {

/// States that stand at one step of the run and have the inputs of the next.
std::vector<State> about_to_step(const Run& run) {
  std::vector<State> states(run.states.begin(), run.states.end() - 1);
  for (std::size_t i = 0; i < states.size(); ++i) set_time(*run.mechanism, run.times[i + 1], states[i]);
  return states;
}

}  // namespace

void newton_warm(benchmark::State& timer, const Run& run) {
  Work work(run.mechanism);
  Figures figures(*run.mechanism);
  const std::vector<State> starts = about_to_step(run);
  std::vector<State> states = starts;
  CloseOptions options;
  options.method = Method::newton;
  const auto batch = static_cast<benchmark::IterationCount>(states.size());
  while (timer.KeepRunningBatch(batch)) {
    timer.PauseTiming();
    states = starts;
    timer.ResumeTiming();
    for (State& state : states) {
      Report report;
      if (close(work, state, options, report) < 0) return timer.SkipWithError("a step of the run does not close");
      figures.take(report);
    }
  }
  figures.show(timer);
}

void ceres_cold(benchmark::State& timer, const Run& run) {
  Work work(run.mechanism);
  Figures figures(*run.mechanism);
  State start(*run.mechanism);
  set_time(*run.mechanism, 0.0, start);
  State state = start;
  CloseOptions options;
  options.method = Method::ceres;
  while (timer.KeepRunning()) {
    state = start;
    Report report;
    if (close(work, state, options, report) < 0) return timer.SkipWithError("the start of the scene does not close");
    figures.take(report);
  }
  figures.show(timer);
}

void rates(benchmark::State& timer, const Run& run) {
  constexpr benchmark::IterationCount batch = 64;
  Work work(run.mechanism);
  Figures figures(*run.mechanism);
  std::size_t step = 0;
  while (timer.KeepRunningBatch(batch)) {
    timer.PauseTiming();
    State state = run.states[step++ % run.states.size()];
    Report report;
    bool fine = close(work, state, {}, report) >= 0;  // leaves the factorisation there, as a step of a run does
    figures.take(report);
    timer.ResumeTiming();
    for (benchmark::IterationCount i = 0; i < batch; ++i) {
      fine &= velocities(work, state) >= 0 && accelerations(work, state) >= 0;
    }
    if (!fine) return timer.SkipWithError("a position of the run has no rates");
  }
  figures.show(timer);
}

void move_step(benchmark::State& timer, const Run& run) {
  Work work(run.mechanism);
  Figures figures(*run.mechanism);
  const auto batch = static_cast<benchmark::IterationCount>(run.times.size() - 1);
  while (timer.KeepRunningBatch(batch)) {
    timer.PauseTiming();
    State state = run.states.front();
    timer.ResumeTiming();
    for (std::size_t i = 1; i < run.times.size(); ++i) {
      Report report;
      if (move(work, state, run.times[i], report) < 0) return timer.SkipWithError("a step of the run fails");
      figures.take(report);
    }
  }
  figures.show(timer);
}

}  // namespace koppel::bench
