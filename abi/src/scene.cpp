#include "boundary.hpp"

namespace {

/// Turns the outcome of reading into a handle or an error; findings go to the caller's list.
koppel_status deliver(koppel_engine& engine, koppel::Result<koppel::Scene> read, const koppel::Diagnostics& findings,
                      koppel_diagnostics* diagnostics, koppel_scene** scene, koppel_error* error) {
  if (diagnostics != nullptr) {
    for (const koppel::Error& finding : findings.findings()) diagnostics->list.add(finding);
  }
  if (!read) return koppel::fail(read.error(), error);
  *scene = new koppel_scene{engine.registry, engine.log, std::make_shared<const koppel::Scene>(std::move(*read))};
  return KOPPEL_OK;
}

}  // namespace

koppel_status koppel_scene_from_file(koppel_engine* engine, const char* path, koppel_diagnostics* diagnostics,
                                     koppel_scene** scene, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (engine == nullptr || path == nullptr || scene == nullptr) {
      return koppel::invalid_argument("engine, path or scene is NULL", error);
    }
    koppel::Diagnostics findings;
    auto read = koppel::read_scene_file(*engine->registry, path, findings);
    return deliver(*engine, std::move(read), findings, diagnostics, scene, error);
  });
}

koppel_status koppel_scene_from_text(koppel_engine* engine, const char* text, size_t length, const char* directory,
                                     koppel_diagnostics* diagnostics, koppel_scene** scene, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (engine == nullptr || text == nullptr || scene == nullptr) {
      return koppel::invalid_argument("engine, text or scene is NULL", error);
    }
    koppel::Diagnostics findings;
    auto read =
        koppel::read_scene_text(*engine->registry, {text, length}, directory == nullptr ? "" : directory, findings);
    return deliver(*engine, std::move(read), findings, diagnostics, scene, error);
  });
}

void koppel_scene_destroy(koppel_scene* scene) { delete scene; }
