// The subcommands of `koppel`. Each add_... registers one; when the user chooses it, it runs and leaves its exit code
// in `outcome`.
#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/model.hpp"

namespace koppel::app {

/// Options that every subcommand understands.
struct Common {
  bool verbose = false;
};

void add_bench(CLI::App& app, const Common& common, Exit& outcome);
void add_check(CLI::App& app, const Common& common, Exit& outcome);
void add_explain(CLI::App& app, const Common& common, Exit& outcome);
void add_modes(CLI::App& app, const Common& common, Exit& outcome);
void add_reactions(CLI::App& app, const Common& common, Exit& outcome);
void add_run(CLI::App& app, const Common& common, Exit& outcome);
void add_equilibrium(CLI::App& app, const Common& common, Exit& outcome);
void add_linearise(CLI::App& app, const Common& common, Exit& outcome);
void add_simulate(CLI::App& app, const Common& common, Exit& outcome);

/// One finding as it stands in --json.
inline nlohmann::ordered_json json_of(const koppel_error& error) {
  const char* severity = error.severity == KOPPEL_SEVERITY_NOTE      ? "note"
                         : error.severity == KOPPEL_SEVERITY_WARNING ? "warning"
                                                                     : "error";
  return {{"code", error.code},     {"severity", severity},     {"file", error.file},     {"line", error.line},
          {"column", error.column}, {"message", error.message}, {"advice", error.advice}, {"element", error.element}};
}

/// What was found in reading and compiling, as it stands in --json.
inline nlohmann::ordered_json json_of_findings(const Model& model) {
  auto list = nlohmann::ordered_json::array();
  for (const koppel_error& finding : model.findings()) list.push_back(json_of(finding));
  if (model.outcome != Exit::fine && list.empty()) list.push_back(json_of(model.error));
  return list;
}

/// Mobility and ranks as they stand in --json. jacobian_rank is that of the loop equations in the rates of all joints,
/// so that it does not depend on where the loops are cut; equations and rank are those of the closure as it is solved.
/// Without an analysis they are null.
inline void add_counts(nlohmann::ordered_json& document, const koppel_sizes& sizes,
                       const std::optional<koppel_analysis>& analysis) {
  if (!analysis) {
    for (const char* key : {"mobility", "jacobian_rank", "equations", "rank"}) document[key] = nullptr;
    return;
  }
  document["mobility"] = {{"count", analysis->mobility_count}, {"rank", analysis->mobility_rank}};
  document["jacobian_rank"] = static_cast<std::int64_t>(sizes.rates) - analysis->mobility_rank;
  document["equations"] = analysis->equations;
  document["rank"] = analysis->rank;
}

/// A check for options that name something.
inline std::string not_empty(const std::string& text) { return text.empty() ? "must not be empty" : ""; }

/// Prints a document on standard output. Texts from files that are not UTF-8 do not stop it.
inline void print_json(const nlohmann::ordered_json& document) {
  std::puts(document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
}

/// Tells why a scene has become no mechanism. success: the key that says no in JSON; null: there is none.
inline Exit refused(const Model& model, bool json, const char* success) {
  if (json) {
    nlohmann::ordered_json document;
    if (success != nullptr) document[success] = false;
    document["diagnostics"] = json_of_findings(model);
    document["error"] = json_of(model.error);
    print_json(document);
  } else {
    model.print_findings();
  }
  return model.outcome;
}

}  // namespace koppel::app
