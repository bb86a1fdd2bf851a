#include "dynamics/equilibrium.hpp"

#include "boundary.hpp"
#include "closure/close.hpp"
#include "copy_matrix.hpp"

koppel_status koppel_equilibrium_find(const koppel_state* state, const koppel_equilibrium_options* options,
                                      koppel_equilibrium** equilibrium, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (state == nullptr || equilibrium == nullptr) {
      return koppel::invalid_argument("state or equilibrium is NULL", error);
    }
    const koppel_equilibrium_options given = koppel::read_struct(options);
    if (given.drives < KOPPEL_DRIVES_HELD || given.drives > KOPPEL_DRIVES_MOVING ||
        given.search < KOPPEL_SEARCH_SETTLE || given.search > KOPPEL_SEARCH_NEAREST) {
      return koppel::invalid_argument("an option has no such value", error);
    }
    if (!koppel::is_closed(*state->mechanism, state->state)) {
      return koppel::invalid_argument("the state is not closed: koppel_close comes first", error);
    }
    koppel::EquilibriumOptions how;
    how.moving = given.drives == KOPPEL_DRIVES_MOVING;
    how.nearest = given.search == KOPPEL_SEARCH_NEAREST;
    how.max_iterations = given.max_iterations;
    auto found = koppel::find_equilibrium(state->mechanism, state->state, how);
    if (!found) return koppel::fail(found.error(), error);
    *equilibrium = new koppel_equilibrium{state->registry, state->mechanism, std::move(*found)};
    return KOPPEL_OK;
  });
}

void koppel_equilibrium_destroy(koppel_equilibrium* equilibrium) { delete equilibrium; }

koppel_status koppel_equilibrium_summarise(const koppel_equilibrium* equilibrium, koppel_equilibrium_summary* summary) {
  if (equilibrium == nullptr || summary == nullptr) return KOPPEL_INVALID_ARGUMENT;
  const koppel::Equilibrium& from = equilibrium->equilibrium;
  koppel_equilibrium_summary out{};
  out.found = from.found ? 1 : 0;
  out.freedoms = static_cast<std::uint32_t>(from.independent.size());
  out.iterations = from.iterations;
  out.stable = from.stiffness.count(koppel::Holding::stable);
  out.unstable = from.stiffness.count(koppel::Holding::unstable);
  out.indifferent = from.stiffness.count(koppel::Holding::indifferent);
  out.circulatory = from.stiffness.circulatory ? 1 : 0;
  out.states_held = from.stiffness.states_held ? 1 : 0;
  out.worst = from.worst;
  out.moved_most = from.moved_most;
  out.residual = from.residual;
  out.force = from.worst_force;
  out.force_scale = from.force_scale;
  out.coordinate_error = from.coordinate_error;
  out.energy = from.energy;
  out.moved = from.moved;
  out.unrest = from.unrest;
  out.stiffness_error = from.stiffness.error;
  koppel::write_struct(out, summary);
  return KOPPEL_OK;
}

koppel_status koppel_equilibrium_why(const koppel_equilibrium* equilibrium, char* text, size_t size, size_t* needed) {
  if (equilibrium == nullptr) return KOPPEL_INVALID_ARGUMENT;
  const koppel::Equilibrium& from = equilibrium->equilibrium;
  return koppel::write_text(from.found ? std::string_view() : from.why, text, size, needed);
}

koppel_status koppel_equilibrium_take(const koppel_equilibrium* equilibrium, koppel_state* state) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    if (equilibrium == nullptr || state == nullptr || state->mechanism != equilibrium->mechanism) {
      return KOPPEL_INVALID_ARGUMENT;
    }
    const bool taken = koppel::take_place(*state->mechanism, equilibrium->equilibrium, state->state) == nullptr;
    return taken ? KOPPEL_OK : KOPPEL_PLUGIN;
  });
}

koppel_status koppel_equilibrium_independent(const koppel_equilibrium* equilibrium, uint32_t* rates, size_t count) {
  if (equilibrium == nullptr || rates == nullptr || count != equilibrium->equilibrium.independent.size()) {
    return KOPPEL_INVALID_ARGUMENT;
  }
  std::copy_n(equilibrium->equilibrium.independent.begin(), count, rates);
  return KOPPEL_OK;
}

koppel_status koppel_equilibrium_stiffness(const koppel_equilibrium* equilibrium, double* stiffness, double* errors,
                                           size_t count) {
  if (equilibrium == nullptr || !equilibrium->equilibrium.found) return KOPPEL_INVALID_ARGUMENT;
  return koppel::copy_matrix(equilibrium->equilibrium.stiffness.matrix, stiffness, errors, count);
}

koppel_status koppel_equilibrium_direction(const koppel_equilibrium* equilibrium, size_t index, double* stiffness,
                                           double* direction, size_t count) {
  if (equilibrium == nullptr || stiffness == nullptr) return KOPPEL_INVALID_ARGUMENT;
  const koppel::Stiffness& from = equilibrium->equilibrium.stiffness;
  if (index >= from.holding.size() || count != equilibrium->mechanism->nv) return KOPPEL_INVALID_ARGUMENT;
  const auto i = static_cast<Eigen::Index>(index);
  *stiffness = from.eigenvalues[i];
  if (direction != nullptr) std::copy_n(from.directions.col(i).data(), count, direction);
  return KOPPEL_OK;
}
