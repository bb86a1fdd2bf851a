// A plugin that is ready for use: its shared object, if it comes from one, is mapped, its entry checked and started.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "base/error.hpp"
#include "base/log.hpp"
#include "koppel/plugin.h"

namespace koppel {

/// Stops the plugin and unmaps its shared object when the last owner lets go.
class Library {
 public:
  /// Maps a shared object and starts its plugin. file: absolute, so that the system's loader does not search.
  /// Errors: plugin_unloadable, plugin_without_entry, plugin_version, plugin_malformed, plugin_refused.
  static Result<std::shared_ptr<const Library>> open(const std::filesystem::path& file, const Logger& log);

  /// Starts a plugin that is linked into the program. Errors: plugin_version, plugin_malformed, plugin_refused.
  static Result<std::shared_ptr<const Library>> link(const koppel_plugin_entry& entry, std::string origin,
                                                     const Logger& log);

  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  ~Library();

  const koppel_plugin_entry& entry() const { return entry_; }
  /// The file; "built in" or the like for a plugin without one.
  const std::string& origin() const { return origin_; }

 private:
  Library(void* handle, std::string origin) : handle_(handle), origin_(std::move(origin)) {}
  Result<void> start(const koppel_plugin_entry& entry, const Logger& log);

  void* handle_;
  std::string origin_;
  koppel_plugin_entry entry_{};
  bool started_ = false;
};

/// A finding about a plugin: "origin: message".
Error plugin_error(Code code, const std::string& origin, const std::string& message, std::string advice = {});

}  // namespace koppel
