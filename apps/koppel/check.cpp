// koppel check SCENE
#include <algorithm>
#include <cmath>
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

/// A start value that gave way.
struct Moved {
  std::string name, unit;
  double wished = 0.0, found = 0.0;

  double by() const { return std::abs(found - wished); }
};

/// Those that closing changed by more than how they are written down, the greatest change first.
std::vector<Moved> moved(const Model& model, const AtStart& start) {
  constexpr double written = 1e-6;
  std::vector<double> q(model.sizes().coordinates);
  std::vector<Moved> all;
  if (!start.closed || koppel_state_get(start.motion.state.get(), KOPPEL_Q, q.data(), q.size()) < 0) return all;
  for (std::size_t i = 0; i < q.size(); ++i) {
    std::int32_t wish = KOPPEL_START_FREE;
    double value = 0.0;
    koppel_mechanism_start(model.mechanism.get(), i, &wish, &value);
    if (wish == KOPPEL_START_FREE || std::abs(q[i] - value) <= written) continue;
    all.push_back({model.name(KOPPEL_KIND_COORDINATE, i), model.unit(KOPPEL_KIND_COORDINATE, i), value, q[i]});
  }
  std::stable_sort(all.begin(), all.end(), [](const Moved& a, const Moved& b) { return a.by() > b.by(); });
  return all;
}

void print_moved(const std::vector<Moved>& all) {
  constexpr std::size_t most = 5;
  for (std::size_t i = 0; i < std::min(all.size(), most); ++i) {
    std::printf("%s %s from %.6g to %.6g %s\n", i == 0 ? "moved      " : "           ", all[i].name.c_str(),
                all[i].wished, all[i].found, all[i].unit.c_str());
  }
  if (all.size() > most) std::printf("            and %zu more start values, by less\n", all.size() - most);
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
    print_moved(moved(model, start));
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
    document["moved"] = nlohmann::ordered_json::array();
    for (const Moved& each : moved(model, start)) {
      document["moved"].push_back({{"coordinate", each.name}, {"from", each.wished}, {"to", each.found}});
    }
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
