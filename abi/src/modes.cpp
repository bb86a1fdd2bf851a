#include "closure/modes.hpp"

#include <limits>

#include "boundary.hpp"

namespace {

std::size_t count_or(std::uint64_t given, std::size_t otherwise) {
  if (given == 0) return otherwise;
  return static_cast<std::size_t>(std::min<std::uint64_t>(given, std::numeric_limits<std::size_t>::max()));
}

koppel::ModeOptions options_of(const koppel_modes_options& given) {
  koppel::ModeOptions options;
  options.most = count_or(given.most, options.most);
  options.restarts = count_or(given.restarts, options.restarts);
  options.all_twins = given.all_twins != 0;
  if (given.progress != nullptr) {
    options.progress = [given](std::size_t found, double part) { return given.progress(found, part, given.user) == 0; };
  }
  return options;
}

/// The mode with this number; null: there is none.
const koppel::Mode* mode_of(const koppel_modes* modes, std::size_t index) {
  if (modes == nullptr || index >= modes->modes.modes.size()) return nullptr;
  return &modes->modes.modes[index];
}

}  // namespace

koppel_status koppel_modes_find(const koppel_state* state, koppel_work* work, const koppel_modes_options* options,
                                koppel_modes** modes, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (!koppel::fit(state, work)) {
      return koppel::invalid_argument("state or work is NULL, or they belong to different mechanisms", error);
    }
    if (modes == nullptr) return koppel::invalid_argument("modes is NULL", error);
    koppel::Modes found;
    if (!koppel::find_modes(work->work, state->state, options_of(koppel::read_struct(options)), found)) {
      return koppel::fail(
          koppel::make_error(koppel::Code::plugin_misbehaved, work->work.equations.culprit(),
                             "a function of the plugin failed or gave a value that is not finite",
                             "check the parameters of the element; if they are right, report it to the author of the "
                             "plugin"),
          error);
    }
    *modes = new koppel_modes{state->registry, state->mechanism, std::move(found)};
    return KOPPEL_OK;
  });
}

void koppel_modes_destroy(koppel_modes* modes) { delete modes; }

koppel_status koppel_modes_summarise(const koppel_modes* modes, koppel_modes_summary* summary) {
  if (modes == nullptr || summary == nullptr) return KOPPEL_INVALID_ARGUMENT;
  const koppel::Modes& found = modes->modes;
  koppel_modes_summary out{};
  out.complete = found.complete ? 1 : 0;
  out.count = found.modes.size();
  out.twins = found.twins;
  if (found.modes.empty() && !found.missed_by.empty()) {
    out.missed_by = *std::min_element(found.missed_by.begin(), found.missed_by.end());
  }
  koppel::write_struct(out, summary);
  return KOPPEL_OK;
}

koppel_status koppel_modes_why(const koppel_modes* modes, char* text, size_t size, size_t* needed) {
  if (modes == nullptr) return KOPPEL_INVALID_ARGUMENT;
  return koppel::write_text(modes->modes.why, text, size, needed);
}

koppel_status koppel_modes_get(const koppel_modes* modes, size_t index, koppel_mode* mode) {
  const koppel::Mode* found = mode_of(modes, index);
  if (found == nullptr || mode == nullptr) return KOPPEL_INVALID_ARGUMENT;
  koppel_mode out{};
  out.limit = found->limit ? 1 : 0;
  out.residual = found->residual;
  koppel::write_struct(out, mode);
  return KOPPEL_OK;
}

koppel_status koppel_modes_id(const koppel_modes* modes, size_t index, char* text, size_t size, size_t* needed) {
  const koppel::Mode* found = mode_of(modes, index);
  return found == nullptr ? KOPPEL_INVALID_ARGUMENT : koppel::write_text(found->id, text, size, needed);
}

koppel_status koppel_modes_take(const koppel_modes* modes, size_t index, koppel_state* state) {
  const koppel::Mode* found = mode_of(modes, index);
  if (found == nullptr || state == nullptr || state->mechanism != modes->mechanism) return KOPPEL_INVALID_ARGUMENT;
  state->state.q = found->q;  // of the same size: nothing is allocated
  state->state.stage = koppel::Stage::assigned;
  return KOPPEL_OK;
}
