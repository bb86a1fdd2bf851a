#include "mechanism/state.hpp"

#include <cmath>

#include "boundary.hpp"
#include "mechanism/coordinates.hpp"

namespace {

/// The vector of a state that `what` names; null: no such thing.
template <typename State>
auto vector_of(State& state, std::int32_t what) -> decltype(&state.q) {
  switch (what) {
    case KOPPEL_Q: return &state.q;
    case KOPPEL_V: return &state.v;
    case KOPPEL_A: return &state.a;
    default: return nullptr;
  }
}

bool all_finite(const double* values, std::size_t count) {
  return std::all_of(values, values + count, [](double x) { return std::isfinite(x); });
}

}  // namespace

koppel_status koppel_state_create(const koppel_mechanism* mechanism, koppel_state** state) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    if (mechanism == nullptr || state == nullptr) return KOPPEL_INVALID_ARGUMENT;
    koppel::State made(*mechanism->mechanism);
    if (koppel::set_time(*mechanism->mechanism, 0.0, made) != nullptr) return KOPPEL_PLUGIN;
    *state = new koppel_state{mechanism->registry, mechanism->mechanism, std::move(made)};
    return KOPPEL_OK;
  });
}

void koppel_state_destroy(koppel_state* state) { delete state; }

koppel_status koppel_state_copy(const koppel_state* from, koppel_state* to) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    if (from == nullptr || to == nullptr || from->mechanism != to->mechanism) return KOPPEL_INVALID_ARGUMENT;
    to->state = from->state;
    return KOPPEL_OK;
  });
}

koppel_status koppel_state_get(const koppel_state* state, int32_t what, double* values, size_t count) {
  if (state == nullptr || values == nullptr) return KOPPEL_INVALID_ARGUMENT;
  const Eigen::VectorXd* from = vector_of(state->state, what);
  if (from == nullptr || count != static_cast<std::size_t>(from->size())) return KOPPEL_INVALID_ARGUMENT;
  std::copy(from->data(), from->data() + from->size(), values);
  return KOPPEL_OK;
}

koppel_status koppel_state_set(koppel_state* state, int32_t what, const double* values, size_t count) {
  if (state == nullptr || values == nullptr) return KOPPEL_INVALID_ARGUMENT;
  Eigen::VectorXd* to = vector_of(state->state, what);
  if (to == nullptr || count != static_cast<std::size_t>(to->size()) || !all_finite(values, count)) {
    return KOPPEL_INVALID_ARGUMENT;
  }
  std::copy(values, values + count, to->data());
  if (what != KOPPEL_Q) {
    state->state.stage = std::min(state->state.stage, koppel::Stage::closed);
    return KOPPEL_OK;
  }
  for (const koppel::StateBlock& block : state->mechanism->blocks) {
    koppel::normalise_block(block.kind, to->data() + block.q);
  }
  state->state.stage = koppel::Stage::assigned;
  return KOPPEL_OK;
}

koppel_status koppel_limits_exceeded(const koppel_state* state, char* text, size_t size, size_t* needed) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    if (state == nullptr) return KOPPEL_INVALID_ARGUMENT;
    std::string names;
    for (const std::string& name : koppel::limits_exceeded(*state->mechanism, state->state)) {
      names += (names.empty() ? "" : "\n") + name;
    }
    return koppel::write_text(names, text, size, needed);
  });
}

koppel_status koppel_state_set_time(koppel_state* state, double time, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (state == nullptr || !std::isfinite(time)) return koppel::invalid_argument("no state, or no finite time", error);
    const koppel::Input* failed = koppel::set_time(*state->mechanism, time, state->state);
    if (failed == nullptr) return KOPPEL_OK;
    return koppel::fail(
        koppel::make_error(koppel::Code::plugin_misbehaved, "drive " + failed->name,
                           "evaluate() of " + failed->type->name + " (" + failed->type->origin +
                               ") failed or gave a value that is not finite at time " + std::to_string(time),
                           "check the parameters of the drive over the time of the run"),
        error);
  });
}

double koppel_state_time(const koppel_state* state) { return state == nullptr ? 0.0 : state->state.time; }

koppel_status koppel_state_set_input(koppel_state* state, size_t input, double value, double rate,
                                     double acceleration) {
  if (state == nullptr || input >= state->mechanism->inputs.size()) return KOPPEL_INVALID_ARGUMENT;
  if (!std::isfinite(value) || !std::isfinite(rate) || !std::isfinite(acceleration)) return KOPPEL_INVALID_ARGUMENT;
  const auto i = static_cast<Eigen::Index>(input);
  state->state.input[i] = value;
  state->state.input_rate[i] = rate;
  state->state.input_acceleration[i] = acceleration;
  return KOPPEL_OK;
}
