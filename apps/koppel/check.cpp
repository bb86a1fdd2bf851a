// koppel check SCENE
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "koppel/at_start.hpp"
#include "koppel/command.hpp"

namespace koppel::app {
namespace {

/// More inputs than freedoms: they may fit here and now, but hardly everywhere.
std::optional<koppel_error> too_many_inputs(const Model& model, const AtStart& start) {
  const auto inputs = static_cast<std::int64_t>(model.sizes().inputs);
  if (!start.analysis || inputs <= start.analysis->mobility_rank) return std::nullopt;
  const int freedoms = start.analysis->mobility_rank;
  auto finding = sized<koppel_error>();
  finding.severity = KOPPEL_SEVERITY_WARNING;
  std::snprintf(finding.code, sizeof finding.code, "W0703");
  std::snprintf(finding.message, sizeof finding.message, "%lld input%s, but only %d freedom%s%s",
                static_cast<long long>(inputs), inputs == 1 ? "" : "s", freedoms, freedoms == 1 ? "" : "s",
                start.closed ? "" : " where the start values stand");
  std::snprintf(finding.advice, sizeof finding.advice, "drive no more coordinates than the mechanism has freedoms");
  return finding;
}

void print_mobility(const koppel_analysis& analysis, const std::optional<koppel_freedoms>& freedoms) {
  std::printf("mobility    %d by rank, %d by count", analysis.mobility_rank, analysis.mobility_count);
  if (freedoms && freedoms->planar_loops + freedoms->spherical_loops > 0) {
    std::printf(", %d with planar and spherical loops counted as such", freedoms->mobility_by_kind);
  }
  if (analysis.rank < analysis.equations) {
    std::printf("; %u of %u equations follow from the others", analysis.equations - analysis.rank, analysis.equations);
  }
  std::puts("");
  if (!freedoms) return;
  if (freedoms->isolated > 0) {
    std::printf("isolated    %u of the freedoms, in which one body moves alone\n", freedoms->isolated);
  }
  if (freedoms->shaky != 0) {
    std::puts("remark      shaky: gives way here, but has no other closed position near by");
  } else if (freedoms->mobility_nearby < freedoms->mobility_here) {
    std::printf("remark      a singular position: near by the mobility is %d\n", freedoms->mobility_nearby);
  }
}

std::optional<koppel_freedoms> freedoms_of(const AtStart& start) {
  auto freedoms = sized<koppel_freedoms>();
  const Motion& motion = start.motion;
  if (!start.closed || koppel_find_freedoms(motion.state.get(), motion.work.get(), &freedoms, nullptr) < 0) return {};
  return freedoms;
}

void print_text(const Model& model, const AtStart& start) {
  const koppel_sizes sizes = model.sizes();
  const std::string title = model.name(KOPPEL_KIND_SCENE, 1);
  std::printf("%s%s%s\n", model.name(KOPPEL_KIND_SCENE, 0).c_str(), title.empty() ? "" : ": ", title.c_str());
  std::printf("elements    %u bodies with the ground, %u joints, %u constraints, %u inputs, %u recorded columns\n",
              sizes.bodies, sizes.joints, sizes.constraints, sizes.inputs, sizes.records);
  std::printf("loops       %u, with %u equations for %u unknown rates\n", sizes.loops, sizes.equations, sizes.unknowns);
  if (start.analysis) print_mobility(*start.analysis, freedoms_of(start));
  if (start.closed) {
    std::printf("at t = 0    closed: residual %.1e, coordinates within %.1e, %u iterations, condition %.3g\n",
                start.report.residual, start.report.coordinate_error, start.report.iterations, start.report.condition);
  } else {
    std::puts("at t = 0    not closed");
  }
}

nlohmann::ordered_json to_json(const Model& model) {
  nlohmann::ordered_json document;
  document["closed"] = nullptr;
  document["mobility"] = nullptr;
  document["loops"] = nullptr;
  document["diagnostics"] = json_of_findings(model);
  return document;
}

void add_start(nlohmann::ordered_json& document, const Model& model, const AtStart& start) {
  const koppel_sizes sizes = model.sizes();
  document["scene"] = model.name(KOPPEL_KIND_SCENE, 0);
  document["closed"] = start.closed;
  document["loops"] = sizes.loops;
  document["bodies"] = sizes.bodies;
  document["joints"] = sizes.joints;
  document["constraints"] = sizes.constraints;
  document["inputs"] = sizes.inputs;
  document["unknowns"] = sizes.unknowns;
  add_counts(document, sizes, start.analysis);
  document["freedoms"] = nullptr;
  if (const auto freedoms = freedoms_of(start)) {
    document["freedoms"] = {{"by_kind", freedoms->mobility_by_kind},  {"nearby", freedoms->mobility_nearby},
                            {"planar_loops", freedoms->planar_loops}, {"spherical_loops", freedoms->spherical_loops},
                            {"isolated", freedoms->isolated},         {"indeterminate", freedoms->indeterminate},
                            {"shaky", freedoms->shaky != 0}};
  }
  if (start.closed) {
    document["residual"] = start.report.residual;
    document["coordinate_error"] = start.report.coordinate_error;
    document["condition"] = start.report.condition;
    document["iterations"] = start.report.iterations;
  }
}

Exit check(const std::string& file, bool json, bool verbose) {
  const Model model = load(file, verbose);
  nlohmann::ordered_json document = to_json(model);
  if (!json) model.print_findings();
  if (!model.mechanism) {
    if (json) print_json(document);
    return model.outcome;
  }
  const AtStart start = at_start(model);
  std::vector<koppel_error> findings;
  if (const auto finding = too_many_inputs(model, start)) findings.push_back(*finding);
  if (start.status < 0) findings.push_back(start.error);
  if (json) {
    add_start(document, model, start);
    for (const koppel_error& finding : findings) document["diagnostics"].push_back(json_of(finding));
    print_json(document);
  } else {
    print_text(model, start);
    for (const koppel_error& finding : findings) print_error(finding);
  }
  return exit_of(start.status);
}

}  // namespace

void add_check(CLI::App& app, const Common& common, Exit& outcome) {
  struct Options {
    std::string scene;
    bool json = false;
  };
  CLI::App* command = app.add_subcommand(
      "check", "Find every fault of a scene, count its freedoms and loops, close it at time 0 with its rates");
  auto options = std::make_shared<Options>();
  command->add_option("SCENE", options->scene, "The scene file")->required()->check(not_empty)->type_name("");
  command->add_flag("--json", options->json, "Print the result as JSON");
  command->callback([options, &common, &outcome] { outcome = check(options->scene, options->json, common.verbose); });
}

}  // namespace koppel::app
