// koppel check SCENE
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>

#include "koppel/command.hpp"

namespace koppel::app {
namespace {

/// What can be said of a scene that has been compiled: whether it closes at time 0, and the counts there.
struct Closure {
  koppel_status status = KOPPEL_OK;
  koppel_error error = sized<koppel_error>();
  koppel_report report = sized<koppel_report>();
  koppel_analysis analysis = sized<koppel_analysis>();

  bool closed() const { return status >= 0; }
};

Closure close_at_start(const Model& model) {
  Closure closure;
  const Motion motion = start(model);
  koppel_state* state = motion.state.get();
  koppel_work* work = motion.work.get();
  closure.status = koppel_state_set_time(state, 0.0, &closure.error);
  if (closure.closed()) closure.status = koppel_close(state, work, nullptr, &closure.report, &closure.error);
  // The counts are told of an open position too: they may be the reason.
  const koppel_status analysed = koppel_analyse(state, work, &closure.analysis, nullptr);
  if (closure.closed() && analysed < 0) closure.status = analysed;
  return closure;
}

void print_mobility(const koppel_analysis& analysis) {
  std::printf("mobility    %d by rank, %d by count", analysis.mobility_rank, analysis.mobility_count);
  if (analysis.rank < analysis.equations) {
    std::printf("; %u of %u equations follow from the others", analysis.equations - analysis.rank, analysis.equations);
  }
  std::puts("");
}

void print_text(const Model& model, const Closure& closure) {
  const koppel_sizes sizes = model.sizes();
  const std::string title = model.name(KOPPEL_KIND_SCENE, 1);
  std::printf("%s%s%s\n", model.name(KOPPEL_KIND_SCENE, 0).c_str(), title.empty() ? "" : ": ", title.c_str());
  std::printf("elements    %u bodies with the ground, %u joints, %u constraints, %u inputs, %u recorded columns\n",
              sizes.bodies, sizes.joints, sizes.constraints, sizes.inputs, sizes.records);
  std::printf("loops       %u, with %u equations for %u unknown rates\n", sizes.loops, sizes.equations, sizes.unknowns);
  print_mobility(closure.analysis);
  if (closure.closed()) {
    std::printf("at t = 0    closed: residual %.1e, coordinates within %.1e, %u iterations, condition %.3g\n",
                closure.report.residual, closure.report.coordinate_error, closure.report.iterations,
                closure.report.condition);
  } else {
    std::puts("at t = 0    not closed");
  }
}

nlohmann::ordered_json to_json(const Model& model) {
  nlohmann::ordered_json document;
  document["closed"] = nullptr;
  document["mobility"] = nullptr;
  document["loops"] = nullptr;
  document["diagnostics"] = nlohmann::ordered_json::array();
  for (const koppel_error& finding : model.findings()) document["diagnostics"].push_back(json_of(finding));
  if (model.outcome != Exit::fine && document["diagnostics"].empty()) {
    document["diagnostics"].push_back(json_of(model.error));
  }
  return document;
}

void add_closure(nlohmann::ordered_json& document, const Model& model, const Closure& closure) {
  const koppel_sizes sizes = model.sizes();
  document["scene"] = model.name(KOPPEL_KIND_SCENE, 0);
  document["closed"] = closure.closed();
  document["loops"] = sizes.loops;
  document["bodies"] = sizes.bodies;
  document["joints"] = sizes.joints;
  document["constraints"] = sizes.constraints;
  document["inputs"] = sizes.inputs;
  document["unknowns"] = sizes.unknowns;
  add_counts(document, sizes, closure.analysis);
  if (closure.closed()) {
    document["residual"] = closure.report.residual;
    document["coordinate_error"] = closure.report.coordinate_error;
    document["condition"] = closure.report.condition;
    document["iterations"] = closure.report.iterations;
  } else {
    document["diagnostics"].push_back(json_of(closure.error));
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
  const Closure closure = close_at_start(model);
  if (json) {
    add_closure(document, model, closure);
    print_json(document);
  } else {
    print_text(model, closure);
    if (!closure.closed()) print_error(closure.error);
  }
  return exit_of(closure.status);
}

}  // namespace

void add_check(CLI::App& app, const Common& common, Exit& outcome) {
  struct Options {
    std::string scene;
    bool json = false;
  };
  CLI::App* command =
      app.add_subcommand("check", "Find every fault of a scene, count its freedoms and loops, close it once");
  auto options = std::make_shared<Options>();
  command->add_option("SCENE", options->scene, "The scene file")->required()->type_name("");
  command->add_flag("--json", options->json, "Print the result as JSON");
  command->callback([options, &common, &outcome] { outcome = check(options->scene, options->json, common.verbose); });
}

}  // namespace koppel::app
