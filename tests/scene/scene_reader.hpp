// Reads scenes from texts with the standard types, for all tests of this room.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "koppel_builtin_plugins.h"
#include "scene/scene.hpp"

namespace koppel {

inline RegistryOptions standard_types() {
  RegistryOptions options;
  for (std::size_t i = 0; i < koppel_builtin_plugin_count; ++i) {
    options.builtins.push_back({koppel_builtin_plugins[i].type, koppel_builtin_plugins[i].entry});
  }
  options.log = silent_logger();
  return options;
}

/// Owns the types that the scenes read by it point to.
class SceneReader {
 public:
  Result<Scene> read(std::string_view text, const std::filesystem::path& folder = {}) {
    diagnostics = {};
    return read_scene_text(registry, text, folder, diagnostics);
  }
  Result<Scene> read_file(const std::filesystem::path& file) {
    diagnostics = {};
    return read_scene_file(registry, file, diagnostics);
  }
  /// The scene, or a failed test and an empty scene.
  Scene good(std::string_view text, const std::filesystem::path& folder = {}) {
    auto scene = read(text, folder);
    EXPECT_TRUE(scene.has_value()) << diagnostics.render();
    return scene ? std::move(*scene) : Scene{};
  }
  std::vector<Error> of(Severity severity) const {
    std::vector<Error> out;
    for (const Error& finding : diagnostics.findings()) {
      if (finding.severity == severity) out.push_back(finding);
    }
    return out;
  }

  Registry registry{standard_types()};
  Diagnostics diagnostics;
};

/// What the caret marks.
inline std::string marked(const Error& error) {
  const Source& at = error.source;
  if (at.column < 1 || static_cast<std::size_t>(at.column) > at.line_text.size()) return {};
  return at.line_text.substr(static_cast<std::size_t>(at.column) - 1, static_cast<std::size_t>(at.length));
}

}  // namespace koppel
