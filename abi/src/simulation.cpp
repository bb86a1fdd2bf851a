#include "dynamics/simulation.hpp"

#include <cmath>

#include "boundary.hpp"
#include "closure/close.hpp"

namespace {

constexpr double default_tolerance = 1e-8;

koppel::SimulationOptions options_of(const koppel_simulation_options& given, const koppel_state& state) {
  const koppel::Mechanism& mechanism = *state.mechanism;
  const koppel::SimulationDescription& scene = mechanism.simulation;
  koppel::SimulationOptions options;
  options.tolerance = given.tolerance > 0.0 ? given.tolerance : scene.tolerance.value_or(default_tolerance);
  options.step = given.step > 0.0 ? given.step : given.tolerance > 0.0 ? 0.0 : scene.step.value_or(0.0);
  options.end = given.end > 0.0 ? given.end : state.state.time + mechanism.duration;
  return options;
}

}  // namespace

koppel_status koppel_simulation_create(const koppel_state* state, const koppel_simulation_options* options,
                                       koppel_simulation** simulation, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (state == nullptr || simulation == nullptr) {
      return koppel::invalid_argument("state or simulation is NULL", error);
    }
    const koppel_simulation_options given = koppel::read_struct(options);
    for (const double x : {given.tolerance, given.step, given.end}) {
      if (!(x >= 0.0) || !std::isfinite(x)) return koppel::invalid_argument("an option is negative or infinite", error);
    }
    if (!koppel::is_closed(*state->mechanism, state->state)) {
      return koppel::invalid_argument("the state is not closed: koppel_close comes first", error);
    }
    auto made = koppel::Simulation::of(state->mechanism, options_of(given, *state));
    if (!made) return koppel::fail(made.error(), error);
    if (const auto started = (*made)->start(state->state); !started) return koppel::fail(started.error(), error);
    *simulation = new koppel_simulation{state->registry, state->mechanism, std::move(*made)};
    return KOPPEL_OK;
  });
}

void koppel_simulation_destroy(koppel_simulation* simulation) { delete simulation; }

koppel_status koppel_simulation_advance(koppel_simulation* simulation, double time, koppel_state* state,
                                        koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (simulation == nullptr || state == nullptr || state->mechanism != simulation->mechanism) {
      return koppel::invalid_argument("simulation or state is NULL, or they belong to different mechanisms", error);
    }
    if (!(time >= simulation->simulation->shown())) {
      return koppel::invalid_argument("the time lies before the last one, or is not a number", error);
    }
    const auto advanced = simulation->simulation->advance(time, state->state);
    return advanced ? KOPPEL_OK : koppel::fail(advanced.error(), error);
  });
}

koppel_status koppel_simulation_summarise(const koppel_simulation* simulation, koppel_simulation_summary* summary) {
  if (simulation == nullptr || summary == nullptr) return KOPPEL_INVALID_ARGUMENT;
  const koppel::SimulationSummary& from = simulation->simulation->summary();
  koppel_simulation_summary out{};
  out.freedoms = static_cast<std::uint32_t>(simulation->simulation->independent().size());
  out.switches = from.switches;
  out.steps = from.steps;
  out.rejected = from.rejected;
  out.evaluations = from.evaluations;
  out.energy = from.energy;
  out.energy_error = from.energy_error;
  out.energy_size = from.energy_size;
  out.position_drift = from.position_drift;
  out.velocity_drift = from.velocity_drift;
  out.start_change = from.start_change;
  koppel::write_struct(out, summary);
  return KOPPEL_OK;
}
