// A shipped scene with the run that it proposes, as the benchmarks need it: compiled, moved once, every position kept.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "closure/close.hpp"
#include "mechanism/mechanism.hpp"
#include "mechanism/state.hpp"
#include "plugin/registry.hpp"

namespace koppel::bench {

struct Run {
  std::shared_ptr<Registry> registry;  ///< owns the types that the mechanism uses
  std::shared_ptr<const Mechanism> mechanism;
  std::vector<double> times;  ///< steps + 1
  std::vector<State> states;  ///< closed, with velocities and accelerations, one for each time
};

/// apps/scenes/<name>.toml. Error: it does not read, compile, or move through its run.
Result<Run> load(const std::string& name);

/// `count` four-bars in a row, each driven by the one before: all of them move at every step.
Result<Run> load_chain(int count);

/// What the closures of a batch were like: shown beside the time, because no time counts without its error.
class Figures {
 public:
  explicit Figures(const Mechanism& mechanism) : mechanism_(mechanism) {}
  void take(const Report& report);
  /// Sets the counters of a benchmark.
  void show(benchmark::State& state) const;

 private:
  const Mechanism& mechanism_;
  double residual_ = 0.0, coordinate_error_ = 0.0;
  std::uint64_t iterations_ = 0, closures_ = 0;
};

}  // namespace koppel::bench
