// Motions by forces: error at the end over time, for each method and setting.
#include <cmath>
#include <memory>

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
  Curve(Bench& bench, const Problem& problem, std::shared_ptr<Trial> trial, const Reference& reference,
        Json::json_pointer place)
      : bench_(bench), problem_(problem), trial_(std::move(trial)), reference_(reference), place_(std::move(place)) {}

  /// Runs a setting once for its error, and leaves its time to the rounds. The number of evaluations it took; 0 if it
  /// did not get to the end.
  std::uint64_t add(const Setting& setting) {
    Json& points = bench_.document.at(place_)["points"];
    const double first = trial_->run(setting);
    const bool finished = !std::isnan(first);
    Json point = {{"setting", setting.value}, {"finished", finished}};
    if (!finished) point["why"] = trial_->problem();
    if (finished) describe(point);
    points.push_back(std::move(point));
    if (!finished) return 0;
    bench_.rounds.add(
        problem_.name + ", " + setting.method + " " + short_number(setting.value),
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
  Json::json_pointer place_;
};

Json series(const char* method, const char* setting) {
  return {{"engine", "koppel"}, {"method", method}, {"setting", setting}, {"points", Json::array()}};
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
  entry["series"] = {series("dormand-prince", "tolerance"), series("classical", "step")};
  const Json::json_pointer place = bench.entry("simulations", std::move(entry)) / "series";

  Curve adaptive(bench, problem, trial, reference, place / 0), fixed(bench, problem, trial, reference, place / 1);
  for (const double tolerance : tolerances(bench.plan.quick)) {
    const std::uint64_t evaluations = adaptive.add({"dormand-prince", tolerance});
    // As many evaluations in steps of one length, four to each.
    if (evaluations > 4) fixed.add({"classical", 4.0 * problem.end / static_cast<double>(evaluations)});
  }
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
