#include "run.hpp"

#include <algorithm>

#include "koppel_builtin_plugins.h"
#include "scene/scene.hpp"

namespace koppel::bench {
namespace {

std::shared_ptr<Registry> make_registry() {
  RegistryOptions options;
  for (std::size_t i = 0; i < koppel_builtin_plugin_count; ++i) {
    options.builtins.push_back({koppel_builtin_plugins[i].type, koppel_builtin_plugins[i].entry});
  }
  options.log = silent_logger();
  return std::make_shared<Registry>(std::move(options));
}

}  // namespace

Result<Run> load(const std::string& name) {
  Run run;
  run.registry = make_registry();
  Diagnostics findings;
  KOPPEL_TRY(const Scene scene, read_scene_file(*run.registry, KOPPEL_SCENES "/" + name + ".toml", findings));
  KOPPEL_TRY(run.mechanism, compile(scene, findings));
  const Mechanism& mechanism = *run.mechanism;
  Work work(run.mechanism);
  State state(mechanism);
  for (std::uint32_t step = 0; step <= mechanism.run_steps; ++step) {
    run.times.push_back(mechanism.duration * step / mechanism.run_steps);
    Report report;
    if (move(work, state, run.times.back(), report) < 0) {
      return tl::make_unexpected(make_error(Code::not_closed, "scene " + name, "the run of the scene does not close"));
    }
    run.states.push_back(state);
  }
  return run;
}

void Figures::take(const Report& report) {
  residual_ = std::max(residual_, report.residual);
  coordinate_error_ = std::max(coordinate_error_, report.coordinate_error);
  iterations_ += report.iterations;
  ++closures_;
}

void Figures::show(benchmark::State& state) const {
  state.counters["residual"] = residual_;
  state.counters["coordinate_error"] = coordinate_error_;
  state.counters["iterations"] =
      closures_ == 0 ? 0.0 : static_cast<double>(iterations_) / static_cast<double>(closures_);
  state.counters["equations"] = mechanism_.rows;
  state.counters["unknowns"] = mechanism_.unknowns;
}

}  // namespace koppel::bench
