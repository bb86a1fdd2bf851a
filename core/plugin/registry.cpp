#include "plugin/registry.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "plugin/library.hpp"
#include "plugin/table.hpp"

namespace koppel {
namespace {

namespace fs = std::filesystem;

template <typename T>
constexpr PluginKind kind_of = PluginKind::joint;
template <>
constexpr PluginKind kind_of<BodyType> = PluginKind::body;
template <>
constexpr PluginKind kind_of<ConstraintType> = PluginKind::constraint;
template <>
constexpr PluginKind kind_of<FunctionType> = PluginKind::function;
template <>
constexpr PluginKind kind_of<ForceType> = PluginKind::force;

std::string ticked(std::string_view name) { return '`' + std::string(name) + '`'; }

tl::unexpected<Error> failure(Code code, std::string message, std::string advice = {}) {
  Error error;
  error.code = code;
  error.message = std::move(message);
  error.advice = std::move(advice);
  return tl::make_unexpected(std::move(error));
}

/// "did you mean `x`?", or all there are.
std::string proposal(std::string_view name, const std::vector<std::string>& candidates) {
  if (const auto nearest = nearest_name(name, candidates)) return "did you mean " + ticked(*nearest) + '?';
  std::string all;
  for (const std::string& candidate : candidates) all += (all.empty() ? "there are " : ", ") + candidate;
  return all;
}

/// The name of an existing file without links, dots and relation to the working directory.
std::optional<fs::path> existing(const fs::path& file) {
  std::error_code error;
  fs::path found = fs::canonical(file, error);
  if (error) return std::nullopt;
  return found;
}

}  // namespace

struct Registry::Impl {
  RegistryOptions options;
  std::map<std::string, AnyType, std::less<>> types;
  std::set<fs::path> files;                      ///< taken in already
  std::set<const koppel_plugin_entry*> entries;  ///< taken in already

  const AnyType* known(std::string_view name) const;
  std::vector<std::string> standard_names() const;
  std::vector<std::string> vendor_names(std::string_view vendor) const;
  Result<void> take_in(const std::shared_ptr<const Library>& library, Naming naming);
  Result<void> take_in_file(const fs::path& file, Naming naming);
  Result<fs::path> locate(const fs::path& file, const fs::path& scene_folder) const;
  Result<const AnyType*> standard(std::string_view name);
  Result<const AnyType*> stranger(std::string_view name, const PluginReference& from);
  Result<void> load_for(std::string_view name, std::string_view vendor, const PluginReference& from);
  template <typename T>
  Result<const T*> find(std::string_view name, const PluginReference& from, const Registry& registry);
};

const AnyType* Registry::Impl::known(std::string_view name) const {
  const auto found = types.find(name);
  return found == types.end() ? nullptr : &found->second;
}

std::vector<std::string> Registry::Impl::standard_names() const {
  std::vector<std::string> out;
  if (options.standard_plugins.empty()) {
    for (const BuiltinPlugin& builtin : options.builtins) out.emplace_back(builtin.type);
    return out;
  }
  std::error_code error;
  fs::directory_iterator entry(options.standard_plugins, error);
  while (!error && entry != fs::directory_iterator()) {
    if (entry->path().extension() == ".so") out.push_back(entry->path().stem().string());
    entry.increment(error);
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<std::string> Registry::Impl::vendor_names(std::string_view vendor) const {
  std::vector<std::string> out;
  for (const auto& [name, type] : types) {
    if (name.size() > vendor.size() && name.compare(0, vendor.size(), vendor) == 0 && name[vendor.size()] == '.') {
      out.push_back(name);
    }
  }
  return out;
}

/// All types or none.
Result<void> Registry::Impl::take_in(const std::shared_ptr<const Library>& library, Naming naming) {
  KOPPEL_TRY(std::vector<AnyType> offered, read_types(library, naming, options.log));
  for (const AnyType& type : offered) {
    if (const AnyType* taken = known(common(type).name)) {
      return tl::make_unexpected(
          plugin_error(Code::type_taken, library->origin(),
                       "type " + ticked(common(type).name) + " comes from " + common(*taken).origin + " already",
                       "use one of the two plugins"));
    }
  }
  for (AnyType& type : offered) {
    std::string name = common(type).name;
    types.emplace(std::move(name), std::move(type));
  }
  return {};
}

/// file: canonical.
Result<void> Registry::Impl::take_in_file(const fs::path& file, Naming naming) {
  if (files.count(file) != 0) return {};
  KOPPEL_TRY(const auto library, Library::open(file, options.log));
  KOPPEL_CHECK(take_in(library, naming));
  files.insert(file);
  return {};
}

/// Beside the scene, then on the plugin path. An empty folder would mean the working directory: it is passed over.
Result<fs::path> Registry::Impl::locate(const fs::path& file, const fs::path& scene_folder) const {
  std::vector<fs::path> folders = options.plugin_path;
  folders.insert(folders.begin(), scene_folder);
  if (file.is_absolute()) folders = {file.root_path()};
  std::string searched;
  for (const fs::path& folder : folders) {
    if (folder.empty()) continue;
    if (auto found = existing(folder / file)) return *found;
    searched += (searched.empty() ? "" : ", ") + folder.string();
  }
  if (file.is_absolute()) return failure(Code::plugin_not_found, file.string() + ": there is no such file");
  return failure(Code::plugin_not_found,
                 file.string() + ": not found in " + (searched.empty() ? "any folder" : searched),
                 "put the file beside the scene, or its folder on KOPPEL_PLUGIN_PATH");
}

Result<const AnyType*> Registry::Impl::standard(std::string_view name) {
  if (const AnyType* type = known(name)) return type;
  std::string origin;
  if (options.standard_plugins.empty()) {
    const auto builtin = std::find_if(options.builtins.begin(), options.builtins.end(),
                                      [name](const BuiltinPlugin& b) { return b.type == name; });
    if (builtin == options.builtins.end()) return nullptr;
    origin = "built in";
    KOPPEL_TRY(const auto library, Library::link(*builtin->entry, origin, options.log));
    KOPPEL_CHECK(take_in(library, Naming::plain));
  } else {
    const auto file = existing(options.standard_plugins / (std::string(name) + ".so"));
    if (!file) return nullptr;
    origin = file->string();
    KOPPEL_CHECK(take_in_file(*file, Naming::plain));
  }
  if (const AnyType* type = known(name)) return type;
  return tl::make_unexpected(
      plugin_error(Code::plugin_without_type, origin, "the standard plugin has no type " + ticked(name)));
}

Result<void> Registry::Impl::load_for(std::string_view name, std::string_view vendor, const PluginReference& from) {
  const fs::path file = from.file.empty() ? fs::path(std::string(vendor) + ".so") : fs::path(from.file);
  const auto found = locate(file, from.file.empty() ? fs::path() : from.scene_folder);
  if (found) return take_in_file(*found, Naming::prefixed);
  const auto siblings = vendor_names(vendor);
  if (from.file.empty() && !siblings.empty()) {
    return failure(Code::plugin_without_type, "plugin " + ticked(vendor) + " has no type " + ticked(name),
                   proposal(name, siblings));
  }
  Error error = found.error();
  error.message = "type " + ticked(name) + ": " + error.message;
  return tl::make_unexpected(std::move(error));
}

Result<const AnyType*> Registry::Impl::stranger(std::string_view name, const PluginReference& from) {
  const std::string_view vendor = name.substr(0, name.find('.'));
  if (const AnyType* type = known(name)) {
    // The type is there; but a scene that names another file must not get something else unawares.
    const std::string& origin = common(*type).origin;
    const auto file = from.file.empty() ? Result<fs::path>(fs::path(origin)) : locate(from.file, from.scene_folder);
    if (!file || *file == origin) return type;
    return failure(Code::type_taken,
                   "type " + ticked(name) + " comes from " + origin + " already, not from " + file->string(),
                   "name the same file everywhere");
  }
  KOPPEL_CHECK(load_for(name, vendor, from));
  if (const AnyType* type = known(name)) return type;
  const std::string file = from.file.empty() ? std::string(vendor) + ".so" : from.file;
  return failure(Code::plugin_without_type, file + " has no type " + ticked(name),
                 proposal(name, vendor_names(vendor)));
}

namespace {

/// Vendor and type become part of a file name: nothing but letters, digits, underscores and hyphens may stand in them.
bool is_type_name(std::string_view name) {
  const auto is_word = [](std::string_view word) {
    return !word.empty() && std::all_of(word.begin(), word.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
  };
  const auto dot = name.find('.');
  return is_word(name.substr(0, dot)) && (dot == name.npos || is_word(name.substr(dot + 1)));
}

}  // namespace

template <typename T>
Result<const T*> Registry::Impl::find(std::string_view name, const PluginReference& from, const Registry& registry) {
  const std::string kind(plugin_kind_name(kind_of<T>));
  if (!is_type_name(name)) {
    return failure(Code::unknown_type, ticked(name) + " is no name of a type",
                   "write a standard type's name, or `vendor.type`");
  }
  const bool plain = name.find('.') == name.npos;
  KOPPEL_TRY(const AnyType* type, plain ? standard(name) : stranger(name, from));
  if (type == nullptr) {
    return failure(Code::unknown_type, "there is no standard " + kind + " type " + ticked(name),
                   from.file.empty() ? proposal(name, registry.names(kind_of<T>))
                                     : "types from a plugin are written `vendor.type`");
  }
  const T* wanted = std::get_if<T>(type);
  if (wanted == nullptr) {
    return failure(
        Code::unknown_type,
        ticked(name) + " is a " + std::string(plugin_kind_name(common(*type).kind)) + " type, not a " + kind + " type",
        plain ? proposal(name, registry.names(kind_of<T>)) : "");
  }
  if (plain && !from.file.empty()) {
    return failure(Code::conflicting_keys, ticked(name) + " is a standard type and comes from no file",
                   "remove `plugin`, or write the type as `vendor.type`");
  }
  return wanted;
}

Registry::Registry(RegistryOptions options) : impl_(std::make_unique<Impl>()) {
  impl_->options = std::move(options);
  if (!impl_->options.log) impl_->options.log = silent_logger();
}

Registry::~Registry() = default;

Result<const JointType*> Registry::joint(std::string_view name, const PluginReference& from) {
  return impl_->find<JointType>(name, from, *this);
}
Result<const BodyType*> Registry::body(std::string_view name, const PluginReference& from) {
  return impl_->find<BodyType>(name, from, *this);
}
Result<const ConstraintType*> Registry::constraint(std::string_view name, const PluginReference& from) {
  return impl_->find<ConstraintType>(name, from, *this);
}
Result<const FunctionType*> Registry::function(std::string_view name, const PluginReference& from) {
  return impl_->find<FunctionType>(name, from, *this);
}
Result<const ForceType*> Registry::force(std::string_view name, const PluginReference& from) {
  return impl_->find<ForceType>(name, from, *this);
}

Result<void> Registry::add(const koppel_plugin_entry& entry) {
  if (impl_->entries.count(&entry) != 0) return {};
  KOPPEL_TRY(const auto library, Library::link(entry, "linked-in plugin", impl_->options.log));
  KOPPEL_CHECK(impl_->take_in(library, Naming::prefixed));
  impl_->entries.insert(&entry);
  return {};
}

Result<void> Registry::load(const std::filesystem::path& file) {
  const auto found = existing(file);
  if (!found) return failure(Code::plugin_not_found, file.string() + ": there is no such file");
  return impl_->take_in_file(*found, Naming::prefixed);
}

std::vector<std::string> Registry::names(PluginKind kind) const {
  // Only a plugin itself knows of which kind its type is: whoever asks for a list makes all of them load.
  std::vector<std::string> out;
  for (const std::string& name : impl_->standard_names()) {
    const auto type = impl_->standard(name);
    if (type && *type != nullptr && common(**type).kind == kind) out.push_back(name);
  }
  return out;
}

}  // namespace koppel
