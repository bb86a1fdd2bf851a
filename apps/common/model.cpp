#include "common/model.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

namespace koppel::app {
namespace {

constexpr std::string_view file_unreadable = "E0101";

void print_log(void* /*context*/, std::int32_t level, const char* message) {
  constexpr std::array words = {"debug", "info", "warning", "error"};
  const auto index = static_cast<std::size_t>(std::clamp<std::int32_t>(level, 0, 3));
  std::fprintf(stderr, "%s: %s\n", words.at(index), message);
}

const char* word(std::int32_t severity) {
  if (severity == KOPPEL_SEVERITY_NOTE) return "note";
  return severity == KOPPEL_SEVERITY_WARNING ? "warning" : "error";
}

/// A scene file that is not there is no fault in a scene.
Exit exit_of_loading(const koppel_error& error, koppel_status status) {
  return error.code == file_unreadable && error.line == 0 ? Exit::system : exit_of(status);
}

}  // namespace

Exit exit_of(koppel_status status) {
  switch (status) {
    case KOPPEL_INVALID_SCENE:
    case KOPPEL_PLUGIN: return Exit::scene;
    case KOPPEL_RETRY:
    case KOPPEL_NOT_CLOSED:
    case KOPPEL_SINGULAR: return Exit::not_closed;
    case KOPPEL_INVALID_ARGUMENT: return Exit::usage;
    default: return status < 0 ? Exit::system : Exit::fine;
  }
}

void print_error(const koppel_error& error) {
  if (!error.message[0]) {
    std::fprintf(stderr, "error: koppel gave no reason; the system may be short of memory\n");
    return;
  }
  const std::string code = error.code[0] ? '[' + std::string(error.code) + ']' : "";  // the system's have none
  std::fprintf(stderr, "%s%s: %s%s%s\n", word(error.severity), code.c_str(), error.element,
               error.element[0] ? ": " : "", error.message);
  if (error.advice[0]) std::fprintf(stderr, "  help: %s\n", error.advice);
}

std::vector<koppel_error> Model::findings() const {
  if (!diagnostics) return {};
  std::vector<koppel_error> all(koppel_diagnostics_count(diagnostics.get()), sized<koppel_error>());
  for (std::size_t i = 0; i < all.size(); ++i) koppel_diagnostics_get(diagnostics.get(), i, &all[i]);
  return all;
}

void Model::print_findings() const {
  if (!diagnostics || koppel_diagnostics_count(diagnostics.get()) == 0) {
    if (outcome != Exit::fine) print_error(error);
    return;
  }
  const std::string text = text_of([this](char* buffer, std::size_t size, std::size_t* needed) {
    return koppel_diagnostics_render(diagnostics.get(), buffer, size, needed);
  });
  std::fputs(text.c_str(), stderr);
}

std::string Model::name(std::int32_t kind, std::size_t index) const {
  return text_of([&](char* buffer, std::size_t size, std::size_t* needed) {
    return koppel_mechanism_name(mechanism.get(), kind, index, buffer, size, needed);
  });
}

std::string Model::unit(std::int32_t kind, std::size_t index) const {
  return text_of([&](char* buffer, std::size_t size, std::size_t* needed) {
    return koppel_mechanism_unit(mechanism.get(), kind, index, buffer, size, needed);
  });
}

std::vector<std::string> Model::names(std::int32_t kind, std::size_t count) const {
  std::vector<std::string> all;
  all.reserve(count);
  for (std::size_t i = 0; i < count; ++i) all.push_back(name(kind, i));
  return all;
}

koppel_sizes Model::sizes() const {
  auto sizes = sized<koppel_sizes>();
  koppel_mechanism_sizes(mechanism.get(), &sizes);
  return sizes;
}

koppel_settings Model::settings() const {
  auto settings = sized<koppel_settings>();
  koppel_mechanism_settings(mechanism.get(), &settings);
  return settings;
}

namespace {

/// read(engine, diagnostics, scene, error) reads the scene.
template <typename Read>
Model load_by(const koppel_engine_options& options, Read&& read) {
  Model model;
  const auto failed = [&model](koppel_status status) {
    if (status < 0) model.outcome = exit_of_loading(model.error, status);
    return status < 0;
  };

  koppel_engine* engine = nullptr;
  if (failed(koppel_engine_create(KOPPEL_ABI_MAJOR, KOPPEL_ABI_MINOR, &options, &engine, &model.error))) return model;
  model.engine.reset(engine);

  koppel_diagnostics* diagnostics = nullptr;
  if (failed(koppel_diagnostics_create(&diagnostics))) return model;
  model.diagnostics.reset(diagnostics);

  koppel_scene* scene = nullptr;
  if (failed(read(engine, diagnostics, &scene, &model.error))) return model;
  model.scene.reset(scene);

  koppel_mechanism* mechanism = nullptr;
  if (failed(koppel_mechanism_compile(scene, diagnostics, &mechanism, &model.error))) return model;
  model.mechanism.reset(mechanism);
  return model;
}

}  // namespace

Model load(const std::string& file, bool verbose) {
  auto options = sized<koppel_engine_options>();
  if (verbose) {
    options.log = print_log;
    options.log_level = KOPPEL_LOG_DEBUG;
  }
  return load_by(options, [&file](auto* engine, auto* diagnostics, auto** scene, auto* error) {
    return koppel_scene_from_file(engine, file.c_str(), diagnostics, scene, error);
  });
}

Model load_text(const std::string& text) {
  return load_by(sized<koppel_engine_options>(), [&text](auto* engine, auto* diagnostics, auto** scene, auto* error) {
    return koppel_scene_from_text(engine, text.c_str(), text.size(), nullptr, diagnostics, scene, error);
  });
}

Motion start(const Model& model) {
  koppel_state* state = nullptr;
  koppel_work* work = nullptr;
  koppel_state_create(model.mechanism.get(), &state);
  koppel_work_create(model.mechanism.get(), &work);
  return {State(state), Work(work)};
}

}  // namespace koppel::app
