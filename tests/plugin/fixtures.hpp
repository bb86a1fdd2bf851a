// Registries with the standard plugins in both forms, and instances made from a few named values.
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "folders.hpp"
#include "koppel_builtin_plugins.h"
#include "plugin/registry.hpp"

namespace koppel::test {

/// The standard plugins that are linked in.
inline RegistryOptions linked_in() {
  RegistryOptions options;
  for (std::size_t i = 0; i < koppel_builtin_plugin_count; ++i) {
    options.builtins.push_back({koppel_builtin_plugins[i].type, koppel_builtin_plugins[i].entry});
  }
  return options;
}

/// The same ones as shared objects.
inline RegistryOptions as_shared_objects() {
  RegistryOptions options;
  options.standard_plugins = standard_plugins_folder();
  return options;
}

/// The linked-in ones, and strangers on the plugin path.
inline RegistryOptions with_strangers() {
  RegistryOptions options = linked_in();
  options.plugin_path = {test_plugins_folder()};
  return options;
}

using Given = std::map<std::string, std::vector<double>>;

/// Values as a checked scene would hand them over: what is not given takes its fallback. Of a coordinates parameter
/// only the number of entries counts.
inline std::vector<Value> values_of(const Type& type, const Given& given) {
  std::vector<Value> out;
  for (const Parameter& parameter : type.parameters) {
    Value value;
    if (const auto found = given.find(parameter.name); found != given.end()) {
      value.given = true;
      value.numbers = found->second;
      value.count = found->second.size();
      if (parameter.kind == ParameterKind::coordinates) value.numbers.clear();
    } else if (parameter.fallback) {
      value.numbers = *parameter.fallback;
      value.count = value.numbers.size();
    } else if (parameter.kind == ParameterKind::frame) {
      value.given = true;
      value.count = 1;
    }
    out.push_back(std::move(value));
  }
  return out;
}

inline Result<Instance> create(const Type& type, const Given& given) { return type.create(values_of(type, given)); }

/// The value, or a test failure that shows the error.
template <typename T>
T expect_value(Result<T> result) {
  if (!result) throw std::runtime_error(render(result.error()));
  return std::move(*result);
}

inline void expect_mentions(const Error& error, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(render(error).find(word), std::string::npos) << "`" << word << "` is missing in\n" << render(error);
  }
}

}  // namespace koppel::test
