// Reads the type tables of a plugin into checked C++ types. Nothing that a table says is believed before it is checked
// against plugin.h; every finding names plugin, type and field.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "base/error.hpp"
#include "plugin/library.hpp"
#include "plugin/type.hpp"

namespace koppel {

using AnyType = std::variant<JointType, BodyType, ConstraintType, FunctionType, ForceType>;

/// Where a plugin comes from decides which names it may give to its types.
enum class Naming {
  plain,    ///< a standard plugin: "revolute"
  prefixed  ///< any other: "vendor.type" with the name of its entry as vendor
};

inline const Type& common(const AnyType& type) {
  return std::visit([](const auto& t) -> const Type& { return t; }, type);
}

/// All types of a plugin. Error: plugin_malformed; then none of them is to be used.
Result<std::vector<AnyType>> read_types(const std::shared_ptr<const Library>& library, Naming naming,
                                        const Logger& log);

}  // namespace koppel
