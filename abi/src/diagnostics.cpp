#include "boundary.hpp"

koppel_status koppel_diagnostics_create(koppel_diagnostics** diagnostics) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    if (diagnostics == nullptr) return KOPPEL_INVALID_ARGUMENT;
    *diagnostics = new koppel_diagnostics{};
    return KOPPEL_OK;
  });
}

void koppel_diagnostics_destroy(koppel_diagnostics* diagnostics) { delete diagnostics; }

size_t koppel_diagnostics_count(const koppel_diagnostics* diagnostics) {
  return diagnostics == nullptr ? 0 : diagnostics->list.findings().size();
}

koppel_status koppel_diagnostics_get(const koppel_diagnostics* diagnostics, size_t index, koppel_error* finding) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    if (diagnostics == nullptr || finding == nullptr || index >= diagnostics->list.findings().size()) {
      return KOPPEL_INVALID_ARGUMENT;
    }
    koppel::fail(diagnostics->list.findings()[index], finding);
    return KOPPEL_OK;
  });
}

koppel_status koppel_diagnostics_render(const koppel_diagnostics* diagnostics, char* text, size_t size,
                                        size_t* needed) {
  return koppel::guarded(nullptr, [&]() -> koppel_status {
    if (diagnostics == nullptr) return KOPPEL_INVALID_ARGUMENT;
    return koppel::write_text(diagnostics->list.render(), text, size, needed);
  });
}
