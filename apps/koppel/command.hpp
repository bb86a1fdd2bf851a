// The subcommands of `koppel`. Each add_... registers one; when the user chooses it, it runs and leaves its exit code
// in `outcome`.
#pragma once

#include <cstdio>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/model.hpp"

namespace koppel::app {

/// Options that every subcommand understands.
struct Common {
  bool verbose = false;
};

void add_check(CLI::App& app, const Common& common, Exit& outcome);
void add_explain(CLI::App& app, const Common& common, Exit& outcome);
void add_run(CLI::App& app, const Common& common, Exit& outcome);

/// One finding as it stands in --json.
inline nlohmann::ordered_json json_of(const koppel_error& error) {
  const char* severity = error.severity == KOPPEL_SEVERITY_NOTE      ? "note"
                         : error.severity == KOPPEL_SEVERITY_WARNING ? "warning"
                                                                     : "error";
  return {{"code", error.code},     {"severity", severity},     {"file", error.file},     {"line", error.line},
          {"column", error.column}, {"message", error.message}, {"advice", error.advice}, {"element", error.element}};
}

inline nlohmann::ordered_json json_of(const koppel_analysis& analysis) {
  return {{"count", analysis.mobility_count}, {"rank", analysis.mobility_rank}};
}

/// Prints a document on standard output. Texts from files that are not UTF-8 do not stop it.
inline void print_json(const nlohmann::ordered_json& document) {
  std::puts(document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
}

}  // namespace koppel::app
