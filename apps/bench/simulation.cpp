// Motions by forces: error at the end over time, for each method and setting.
#include <cmath>
#include <memory>
#include <optional>

#include "bench/bench.hpp"
#include "bench/peers.hpp"
#include "bench/trial.hpp"

namespace koppel::app::bench {
namespace {

std::vector<double> tolerances(bool quick) {
  if (quick) return {1e-4, 1e-6, 1e-8, 1e-10};
  return {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12};
}

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// One curve in the making: a problem solved by one method.
class Curve {
 public:
  /// Starts the curve among those at `series`.
  Curve(Bench& bench, const Problem& problem, std::shared_ptr<Trial> trial, const Reference& reference,
        const Json::json_pointer& series, const Method& method)
      : bench_(bench), problem_(problem), trial_(std::move(trial)), reference_(reference), method_(method) {
    Json& all = bench.document.at(series);
    all.push_back({{"engine", "koppel"},
                   {"method", method.name},
                   {"setting", method.steps ? "step" : "tolerance"},
                   {"points", Json::array()}});
    place_ = series / (all.size() - 1);
  }

  /// Runs a setting once for its error, and leaves its time to the rounds. The number of evaluations it took; 0 if it
  /// did not get to the end.
  std::uint64_t add(double value) {
    const Setting setting{method_, value};
    Json& points = bench_.document.at(place_)["points"];
    const double first = trial_->run(setting);
    const bool finished = !std::isnan(first);
    Json point = {{"setting", setting.value}, {"finished", finished}};
    if (!finished) point["why"] = trial_->problem();
    if (finished) describe(point);
    points.push_back(std::move(point));
    if (!finished) return 0;
    bench_.rounds.add(
        problem_.name + ", " + setting.method.name + " " + short_number(setting.value),
        place_ / "points" / (points.size() - 1), [trial = trial_, setting] { return trial->run(setting); }, first);
    return trial_->summary().evaluations;
  }

 private:
  void describe(Json& point) {
    const koppel_simulation_summary& summary = trial_->summary();
    const double error = error_of(*trial_, reference_);
    const bool bound = error <= reference_.uncertainty;
    point["error"] = bound ? reference_.uncertainty : error;
    point["bound"] = bound;
    point["energy_error"] =
        summary.energy_size > 0.0 ? Json(summary.energy_error / summary.energy_size) : Json(nullptr);
    point["position_drift"] = summary.position_drift;
    point["velocity_drift"] = summary.velocity_drift;
    point["steps"] = summary.steps;
    point["rejected"] = summary.rejected;
    point["evaluations"] = summary.evaluations;
  }

  Bench& bench_;
  const Problem& problem_;
  std::shared_ptr<Trial> trial_;
  const Reference& reference_;
  const Method& method_;
  Json::json_pointer place_;
};

void add_curves(Bench& bench, const Problem& problem, const std::shared_ptr<Trial>& trial, const Reference& reference,
                const Json::json_pointer& place) {
  Curve adaptive(bench, problem, trial, reference, place, dormand_prince);
  Curve high_order(bench, problem, trial, reference, place, dop853);
  Curve fixed(bench, problem, trial, reference, place, classical);
  std::optional<Curve> by_tolerance, by_step;
  if (problem.with_multipliers) {
    by_tolerance.emplace(bench, problem, trial, reference, place, ggl);
    by_step.emplace(bench, problem, trial, reference, place, index3);
  }
  for (const double tolerance : tolerances(bench.plan.quick)) {
    const std::uint64_t evaluations = adaptive.add(tolerance);
    high_order.add(tolerance);
    if (by_tolerance) by_tolerance->add(tolerance);
    if (evaluations <= 4) continue;
    // As many evaluations in steps of one length, four to each.
    const double step = 4.0 * problem.end / static_cast<double>(evaluations);
    fixed.add(step);
    if (by_step) by_step->add(step);
  }
}

void add_problem(Bench& bench, const Problem& problem) {
  auto trial =
      std::make_shared<Trial>(load(bench.plan.scenes + "/dynamics/" + problem.name + ".toml", false), problem.end);
  Json entry = {{"name", problem.name},
                {"title", nullptr},
                {"end", problem.end},
                {"reference", nullptr},
                {"series", Json::array()}};
  if (!trial->problem().empty()) {
    entry["why"] = trial->problem();
    bench.entry("simulations", std::move(entry));
    return;
  }
  const Reference reference = reference_of(problem, *trial);
  entry["title"] = trial->model().name(KOPPEL_KIND_SCENE, 1);
  entry["reference"] = {
      {"source", reference.source}, {"uncertainty", reference.uncertainty}, {"quantities", reference.names}};
  const Json::json_pointer place = bench.entry("simulations", std::move(entry)) / "series";
  add_curves(bench, problem, trial, reference, place);
  add_peers(bench, problem, *trial, reference, place);
}

}  // namespace

void add_simulations(Bench& bench) {
  for (const Problem& problem : problems()) {
    if (!bench.wants("simulation", problem.name)) continue;
    progress("simulation/" + problem.name);
    add_problem(bench, problem);
  }
}

}  // namespace koppel::app::bench
