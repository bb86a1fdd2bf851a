// The types of koppel's own plugins.
#pragma once

#include <memory>
#include <utility>

#include "koppel_builtin_plugins.h"
#include "plugin/registry.hpp"

namespace koppel::bench {

inline std::shared_ptr<Registry> standard_types() {
  RegistryOptions options;
  for (std::size_t i = 0; i < koppel_builtin_plugin_count; ++i) {
    options.builtins.push_back({koppel_builtin_plugins[i].type, koppel_builtin_plugins[i].entry});
  }
  options.log = silent_logger();
  return std::make_shared<Registry>(std::move(options));
}

}  // namespace koppel::bench
