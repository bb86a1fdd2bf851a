// The types that an engine knows. Standard types come from a table of linked-in plugins or, if the host asks, from
// shared objects; others from the files that scenes name. A library is loaded when one of its types is first asked for.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"
#include "base/log.hpp"
#include "koppel/plugin.h"
#include "plugin/type.hpp"

namespace koppel {

/// A linked-in plugin: the name of its one type, and its entry. The build generates the table of all standard ones.
struct BuiltinPlugin {
  std::string_view type;
  const koppel_plugin_entry* entry;
};

struct RegistryOptions {
  std::vector<std::filesystem::path> plugin_path;  ///< folders searched for `plugin = "file"` and for "vendor.so"
  std::filesystem::path standard_plugins;          ///< use "<type>.so" from here instead of the linked-in ones
  std::vector<BuiltinPlugin> builtins;
  Logger log;
};

/// Where a scene says that a type comes from.
struct PluginReference {
  std::string file;                    ///< the value of `plugin`; empty: not given
  std::filesystem::path scene_folder;  ///< empty: the scene is a text without a place
};

class Registry {
 public:
  explicit Registry(RegistryOptions options);
  ~Registry();
  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;

  /// The type of that name. Errors: unknown_type (advice: the nearest name), plugin_* for what went wrong with a
  /// library. Pointers stay valid as long as the registry.
  Result<const JointType*> joint(std::string_view name, const PluginReference& from);
  Result<const BodyType*> body(std::string_view name, const PluginReference& from);
  Result<const ConstraintType*> constraint(std::string_view name, const PluginReference& from);
  Result<const FunctionType*> function(std::string_view name, const PluginReference& from);
  Result<const ForceType*> force(std::string_view name, const PluginReference& from);

  /// Takes in all types of an entry that the host has linked in.
  Result<void> add(const koppel_plugin_entry& entry);
  /// Loads a shared object and takes in all its types.
  Result<void> load(const std::filesystem::path& file);

  /// Names of the standard types of a kind, for lists and proposals.
  std::vector<std::string> names(PluginKind kind) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace koppel
