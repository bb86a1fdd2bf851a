#include "plugin/library.hpp"

#include <utility>

#include <dlfcn.h>
#include <spdlog/logger.h>

#include "plugin/copy.hpp"
#include "plugin/host.hpp"

namespace koppel {
namespace {

std::string version_text(const koppel_version& version) {
  return std::to_string(version.major) + '.' + std::to_string(version.minor);
}

std::string loader_message() {
  const char* text = dlerror();
  return text != nullptr ? text : "no reason given";
}

/// Size and version stand first in every version of the entry; the rest may be read only if the version fits.
Result<void> check_version(const koppel_plugin_entry& entry, const std::string& origin) {
  if (entry.struct_size < size_through(&koppel_plugin_entry::abi)) {
    return tl::make_unexpected(plugin_error(Code::plugin_malformed, origin,
                                            "koppel_plugin: struct_size is " + std::to_string(entry.struct_size),
                                            "set it to sizeof(koppel_plugin_entry)"));
  }
  if (entry.abi.major == served_abi.major && entry.abi.minor <= served_abi.minor) return {};
  return tl::make_unexpected(plugin_error(
      Code::plugin_version, origin,
      "koppel_plugin: abi is " + version_text(entry.abi) + ", this engine serves " + version_text(served_abi),
      entry.abi.major == served_abi.major ? "update koppel, or build the plugin with the headers of this koppel"
                                          : "build the plugin with the headers of this koppel"));
}

}  // namespace

Error plugin_error(Code code, const std::string& origin, const std::string& message, std::string advice) {
  Error error;
  error.code = code;
  error.message = origin + ": " + message;
  error.advice = std::move(advice);
  return error;
}

Result<std::shared_ptr<const Library>> Library::open(const std::filesystem::path& file, const Logger& log) {
  const std::string origin = file.string();
  void* handle = dlopen(origin.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) {
    return tl::make_unexpected(plugin_error(Code::plugin_unloadable, origin, "cannot be loaded: " + loader_message()));
  }
  const std::shared_ptr<Library> library(new Library(handle, origin));
  const void* entry = dlsym(handle, KOPPEL_PLUGIN_SYMBOL_NAME);
  if (entry == nullptr) {
    return tl::make_unexpected(plugin_error(Code::plugin_without_entry, origin,
                                            "does not export `" KOPPEL_PLUGIN_SYMBOL_NAME "`",
                                            "define `const koppel_plugin_entry KOPPEL_PLUGIN_SYMBOL` in it"));
  }
  KOPPEL_CHECK(library->start(*static_cast<const koppel_plugin_entry*>(entry), log));
  return library;
}

Result<std::shared_ptr<const Library>> Library::link(const koppel_plugin_entry& entry, std::string origin,
                                                     const Logger& log) {
  const std::shared_ptr<Library> library(new Library(nullptr, std::move(origin)));
  KOPPEL_CHECK(library->start(entry, log));
  return library;
}

Library::~Library() {
  if (started_ && entry_.deinit != nullptr) {
    guarded([this] {
      entry_.deinit();
      return KOPPEL_OK;
    });
  }
  if (handle_ != nullptr) dlclose(handle_);
}

Result<void> Library::start(const koppel_plugin_entry& entry, const Logger& log) {
  KOPPEL_CHECK(check_version(entry, origin_));
  const auto malformed = [this](const std::string& what) {
    return tl::make_unexpected(plugin_error(Code::plugin_malformed, origin_, "koppel_plugin: " + what));
  };
  if (entry.struct_size < size_through(&koppel_plugin_entry::type_table)) {
    return malformed("struct_size is " + std::to_string(entry.struct_size) + ", version " + version_text(entry.abi) +
                     " needs " + std::to_string(size_through(&koppel_plugin_entry::type_table)));
  }
  entry_ = copy_struct(&entry);
  if (entry_.name == nullptr || *entry_.name == '\0') return malformed("name is missing");
  if (entry_.type_table == nullptr) return malformed("type_table is NULL");
  if (entry_.init != nullptr) {
    const Host host(log, entry_.name);
    const auto status = guarded([&] { return entry_.init(host.table()); });
    if (status == KOPPEL_VERSION) {
      return tl::make_unexpected(plugin_error(Code::plugin_version, origin_,
                                              "init() refuses an engine of version " + version_text(served_abi),
                                              "use a version of the plugin that is made for this koppel"));
    }
    if (!status || *status < 0) {
      const auto& reason = host.rejection();
      return tl::make_unexpected(plugin_error(
          Code::plugin_refused, origin_, "init() " + describe_failure(status) + (reason ? ": " + reason->message : ""),
          reason ? reason->advice : ""));
    }
  }
  started_ = true;
  log->debug("plugin {} from {}", entry_.name, origin_);
  return {};
}

}  // namespace koppel
