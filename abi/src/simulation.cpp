#include "dynamics/simulation.hpp"

#include <cmath>
#include <cstring>

#include "boundary.hpp"
#include "closure/close.hpp"

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
    auto chosen = koppel::simulation_options(given.formulation == nullptr ? "" : given.formulation,
                                             given.integrator == nullptr ? "" : given.integrator, given.tolerance,
                                             given.step, state->mechanism->simulation);
    if (!chosen) return koppel::fail(KOPPEL_INVALID_ARGUMENT, chosen.error(), error);
    chosen->end = given.end > 0.0 ? given.end : state->state.time + state->mechanism->duration;
    auto made = koppel::Simulation::of(state->mechanism, *chosen);
    if (!made) return koppel::fail(made.error(), error);
    if (const auto started = (*made)->start(state->state); !started) return koppel::fail(started.error(), error);
    *simulation = new koppel_simulation{state->registry, state->mechanism, std::move(*made)};
    return KOPPEL_OK;
  });
}

void koppel_simulation_destroy(koppel_simulation* simulation) { delete simulation; }

namespace {

/// Ok if these may advance together.
koppel_status check_advance(const koppel_simulation* simulation, double time, const koppel_state* state,
                            koppel_error* error) {
  if (simulation == nullptr || state == nullptr || state->mechanism != simulation->mechanism) {
    return koppel::invalid_argument("simulation or state is NULL, or they belong to different mechanisms", error);
  }
  if (!(time >= simulation->simulation->shown())) {
    return koppel::invalid_argument("the time lies before the last one, or is not a number", error);
  }
  return KOPPEL_OK;
}

}  // namespace

koppel_status koppel_simulation_advance(koppel_simulation* simulation, double time, koppel_state* state,
                                        koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (const koppel_status checked = check_advance(simulation, time, state, error); checked < 0) return checked;
    const auto advanced = simulation->simulation->advance(time, state->state);
    return advanced ? KOPPEL_OK : koppel::fail(advanced.error(), error);
  });
}

koppel_status koppel_simulation_watch(koppel_simulation* simulation, double time, koppel_state* state,
                                      koppel_crossing* crossing, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (crossing == nullptr) return koppel::invalid_argument("crossing is NULL", error);
    if (const koppel_status checked = check_advance(simulation, time, state, error); checked < 0) return checked;
    const auto found = simulation->simulation->advance_watching(time, state->state);
    if (!found) return koppel::fail(found.error(), error);
    koppel_crossing out{};
    out.watch = KOPPEL_NO_WATCH;
    if (*found) {
      out.watch = (*found)->watch;
      out.time = (*found)->time;
      out.rising = (*found)->rising ? 1 : 0;
      out.stop = simulation->mechanism->watches[out.watch].stop ? 1 : 0;
    }
    koppel::write_struct(out, crossing);
    return KOPPEL_OK;
  });
}

double koppel_simulation_time(const koppel_simulation* simulation) {
  return simulation == nullptr ? 0.0 : simulation->simulation->shown();
}

koppel_status koppel_simulation_save(koppel_simulation* simulation, void* bytes, size_t size, size_t* needed,
                                     koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (simulation == nullptr || needed == nullptr) {
      return koppel::invalid_argument("simulation or needed is NULL", error);
    }
    const auto saved = simulation->simulation->save();
    if (!saved) return koppel::fail(saved.error(), error);
    *needed = saved->size();
    if (bytes == nullptr) return KOPPEL_OK;
    if (size < saved->size()) {
      return koppel::invalid_argument(
          "there is room for " + std::to_string(size) + " bytes, and there are " + std::to_string(saved->size()),
          error);
    }
    std::memcpy(bytes, saved->data(), saved->size());
    return KOPPEL_OK;
  });
}

koppel_status koppel_simulation_load(const koppel_mechanism* mechanism, const void* bytes, size_t size,
                                     koppel_simulation** simulation, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (mechanism == nullptr || simulation == nullptr || (bytes == nullptr && size > 0)) {
      return koppel::invalid_argument("mechanism, bytes or simulation is NULL", error);
    }
    auto loaded = koppel::Simulation::load(mechanism->mechanism, {static_cast<const unsigned char*>(bytes), size});
    if (!loaded) return koppel::fail(loaded.error(), error);
    *simulation = new koppel_simulation{mechanism->registry, mechanism->mechanism, std::move(*loaded)};
    return KOPPEL_OK;
  });
}

koppel_status koppel_simulation_integrator(const koppel_simulation* simulation, char* text, size_t size,
                                           size_t* needed) {
  if (simulation == nullptr) return KOPPEL_INVALID_ARGUMENT;
  const auto kind = static_cast<std::size_t>(simulation->simulation->options().integrator);
  return koppel::write_text(koppel::integrators()[kind].name, text, size, needed);
}

koppel_status koppel_simulation_formulation(const koppel_simulation* simulation, char* text, size_t size,
                                            size_t* needed) {
  if (simulation == nullptr) return KOPPEL_INVALID_ARGUMENT;
  const auto kind = static_cast<std::size_t>(simulation->simulation->options().formulation);
  return koppel::write_text(koppel::formulations()[kind].name, text, size, needed);
}

koppel_status koppel_formulations(char* text, size_t size, size_t* needed) {
  return koppel::guarded(nullptr, [&] {
    std::string list;
    for (const koppel::FormulationName& each : koppel::formulations()) {
      list += std::string(each.name) + ": " + std::string(each.description) + '\n';
    }
    return koppel::write_text(list, text, size, needed);
  });
}

koppel_status koppel_integrators(char* text, size_t size, size_t* needed) {
  return koppel::guarded(nullptr, [&] {
    std::string list;
    for (const koppel::IntegratorName& each : koppel::integrators()) {
      list += std::string(each.name) + ": " + std::string(each.description) + '\n';
    }
    return koppel::write_text(list, text, size, needed);
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
  out.tolerance = simulation->simulation->options().tolerance;
  out.step = simulation->simulation->options().step;
  out.events = static_cast<std::uint32_t>(from.events);
  out.stiff = from.stiff ? 1 : 0;
  koppel::write_struct(out, summary);
  return KOPPEL_OK;
}
