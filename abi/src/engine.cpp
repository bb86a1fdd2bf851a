#include <cstdlib>
#include <filesystem>
#include <sstream>

#include <spdlog/logger.h>
#include <spdlog/sinks/base_sink.h>

#include "boundary.hpp"
#include "koppel_builtin_plugins.h"

namespace koppel {
namespace {

/// Hands log lines to the host's function.
class HostSink final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  HostSink(void (*write)(void*, std::int32_t, const char*), void* context) : write_(write), context_(context) {}

 private:
  void sink_it_(const spdlog::details::log_msg& message) override {
    const std::string text(message.payload.data(), message.payload.size());
    write_(context_, level_of(message.level), text.c_str());
  }
  void flush_() override {}

  static std::int32_t level_of(spdlog::level::level_enum level) {
    if (level <= spdlog::level::debug) return KOPPEL_LOG_DEBUG;
    if (level == spdlog::level::info) return KOPPEL_LOG_INFO;
    return level == spdlog::level::warn ? KOPPEL_LOG_WARNING : KOPPEL_LOG_ERROR;
  }

  void (*write_)(void*, std::int32_t, const char*);
  void* context_;
};

spdlog::level::level_enum spdlog_level(std::int32_t level) {
  if (level <= KOPPEL_LOG_DEBUG) return spdlog::level::debug;
  if (level == KOPPEL_LOG_INFO) return spdlog::level::info;
  return level == KOPPEL_LOG_WARNING ? spdlog::level::warn : spdlog::level::err;
}

Logger make_logger(const koppel_engine_options& options) {
  if (options.log == nullptr) return silent_logger();
  auto logger =
      std::make_shared<spdlog::logger>("koppel", std::make_shared<HostSink>(options.log, options.log_context));
  logger->set_level(spdlog_level(options.log_level));
  return logger;
}

/// The option if it is given, else the environment variable, else "".
std::string option_or_environment(const char* option, const char* variable) {
  if (option != nullptr) return option;
  const char* value = std::getenv(variable);
  return value == nullptr ? "" : value;
}

RegistryOptions registry_options(const koppel_engine_options& options, Logger log) {
  RegistryOptions result;
  std::istringstream folders(option_or_environment(options.plugin_path, "KOPPEL_PLUGIN_PATH"));
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (!folder.empty()) result.plugin_path.emplace_back(folder);
  }
  result.standard_plugins = option_or_environment(options.standard_plugins, "KOPPEL_STANDARD_PLUGINS");
  for (std::size_t i = 0; i < koppel_builtin_plugin_count; ++i) {
    result.builtins.push_back({koppel_builtin_plugins[i].type, koppel_builtin_plugins[i].entry});
  }
  result.log = std::move(log);
  return result;
}

}  // namespace
}  // namespace koppel

koppel_version koppel_library_version(void) { return {KOPPEL_ABI_MAJOR, KOPPEL_ABI_MINOR, KOPPEL_ABI_PATCH}; }

koppel_status koppel_engine_create(uint32_t wanted_major, uint32_t wanted_minor, const koppel_engine_options* options,
                                   koppel_engine** engine, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (engine == nullptr) return koppel::invalid_argument("engine is NULL", error);
    if (wanted_major != KOPPEL_ABI_MAJOR || wanted_minor > KOPPEL_ABI_MINOR) {
      const std::string have = std::to_string(KOPPEL_ABI_MAJOR) + "." + std::to_string(KOPPEL_ABI_MINOR);
      const std::string want = std::to_string(wanted_major) + "." + std::to_string(wanted_minor);
      return koppel::fail(
          koppel::make_error(koppel::Code::library_version, "engine",
                             "the program was compiled for version " + want + ", this library is " + have,
                             "compile the program with the headers of this library, or install the library it needs"),
          error);
    }
    const koppel_engine_options given = koppel::read_struct(options);
    koppel::Logger log = koppel::make_logger(given);
    koppel::RegistryOptions registry_options = koppel::registry_options(given, log);
    const std::filesystem::path& standard = registry_options.standard_plugins;
    if (std::error_code ignored; !standard.empty() && !std::filesystem::is_directory(standard, ignored)) {
      return koppel::fail(koppel::make_error(koppel::Code::plugin_not_found, "engine",
                                             "there is no folder `" + standard.string() + "` with standard plugins",
                                             "correct the option or KOPPEL_STANDARD_PLUGINS, or leave both unset"),
                          error);
    }
    auto registry = std::make_shared<koppel::Registry>(std::move(registry_options));
    *engine = new koppel_engine{std::move(log), std::move(registry)};
    return KOPPEL_OK;
  });
}

void koppel_engine_destroy(koppel_engine* engine) { delete engine; }

koppel_status koppel_engine_add_plugin(koppel_engine* engine, const koppel_plugin_entry* entry, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (engine == nullptr || entry == nullptr) return koppel::invalid_argument("engine or entry is NULL", error);
    const auto added = engine->registry->add(*entry);
    return added ? KOPPEL_OK : koppel::fail(added.error(), error);
  });
}

koppel_status koppel_engine_load_plugin(koppel_engine* engine, const char* path, koppel_error* error) {
  return koppel::guarded(error, [&]() -> koppel_status {
    if (engine == nullptr || path == nullptr) return koppel::invalid_argument("engine or path is NULL", error);
    const auto loaded = engine->registry->load(path);
    return loaded ? KOPPEL_OK : koppel::fail(loaded.error(), error);
  });
}
