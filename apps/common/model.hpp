// A scene read and compiled, as every program needs it, and what becomes of it when that fails.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/handles.hpp"

namespace koppel::app {

/// What a program returns to the shell.
enum class Exit { fine = 0, scene = 1, usage = 2, not_closed = 3, system = 4, worse = 5 };

/// The exit code that goes with a failed call.
Exit exit_of(koppel_status status);

/// Prints one finding the way the library prints lists of them, on standard error.
void print_error(const koppel_error& error);

/// A scene on its way to a mechanism; what could not be made is null, and the diagnostics say why.
struct Model {
  Engine engine;
  Diagnostics diagnostics;
  Scene scene;
  Mechanism mechanism;
  Exit outcome = Exit::fine;
  koppel_error error = sized<koppel_error>();  ///< the first one, where the outcome is not fine

  std::vector<koppel_error> findings() const;
  /// Prints all findings on standard error: of a scene that is fine, its warnings and notes.
  void print_findings() const;
  /// KOPPEL_KIND_FRAME and so on.
  std::string name(std::int32_t kind, std::size_t index) const;
  std::string unit(std::int32_t kind, std::size_t index) const;
  std::vector<std::string> names(std::int32_t kind, std::size_t count) const;
  koppel_sizes sizes() const;
  koppel_settings settings() const;
};

/// Reads, checks and compiles a scene. verbose: the library's log goes to standard error.
Model load(const std::string& file, bool verbose);
/// The same of a scene that is not in a file; it can refer to none.
Model load_text(const std::string& text);

/// A state at time 0 and the scratch memory to move it; null if memory is short.
struct Motion {
  State state;
  Work work;
};
Motion start(const Model& model);

}  // namespace koppel::app
