// Chains of growing length: time, error, memory.
#include <cmath>
#include <memory>
#include <utility>

#include "bench/bench.hpp"
#include "bench/chains.hpp"
#include "bench/machine.hpp"
#include "bench/trial.hpp"

namespace koppel::app::bench {
namespace {

/// A chain that is simulated, at one tolerance for all its lengths.
struct Chain {
  std::string name, title;
  std::string (*scene)(int count);
  Problem (*problem)(int count);
  std::vector<int> quick, full;
};

constexpr double tolerance = 1e-8;

Problem pendulum_problem(int count) {
  const std::string source = "reduced equations in quadruple precision";
  if (count == 10) {
    return {"", 0.2, {{"tip.x", 0.93543487658034883381}, {"tip.y", -0.19618382492755433533}}, source};
  }
  if (count == 100) return {"", 0.2, {{"tip.x", 0.93506520383788359626}, {"tip.y", -0.1962}}, source, 1e-15};
  return {"", 0.2};
}

Problem fourbar_problem(int count) {
  return {"", 1.0, {{"bar0.angle", fourbar_chain_angle(count, 1.0)}}, "moves like one pendulum", 1e-15};
}

const std::vector<Chain>& chains() {
  static const std::vector<Chain> table = {
      {"pendulum_chain",
       "rods that hang on each other, 0.2 s",
       pendulum_chain,
       pendulum_problem,
       {1, 2, 5, 10, 20},
       {1, 2, 5, 10, 20, 50, 100}},
      {"fourbar_chain",
       "IFToMM A02, 1 s",
       fourbar_chain,
       fourbar_problem,
       {1, 2, 5, 40},
       {1, 2, 5, 10, 20, 40, 100, 300, 1000, 4000}},
  };
  return table;
}

/// Seconds that reading and compiling takes.
double compiling(const std::string& text) {
  const Stopwatch watch;
  const Model model = load_text(text);
  return watch.seconds();
}

/// All that is needed to simulate a chain.
struct Held {
  Held(const std::string& text, double end, const Setting& setting)
      : trial(load_text(text), end), simulation(trial.ready(setting)) {}
  Trial trial;
  Simulation simulation;
};

void add_length(Bench& bench, const Chain& chain, int count, const Json::json_pointer& place) {
  const std::string text = chain.scene(count);
  const Problem problem = chain.problem(count);
  const Setting setting{dormand_prince, tolerance};
  const auto trial = std::make_shared<Trial>(load_text(text), problem.end);
  Json point = {{"size", count}, {"rates", trial->model().sizes().rates}};
  if (!trial->problem().empty()) return;
  const Reference reference = reference_of(problem, *trial);
  const double first = trial->run(setting);
  const bool finished = !std::isnan(first);
  point["finished"] = finished;
  if (finished) {
    const double error = error_of(*trial, reference);
    point["error"] = std::max(error, reference.uncertainty);
    point["bound"] = error <= reference.uncertainty;
    point["reference"] = reference.source;
    point["evaluations"] = trial->summary().evaluations;
    point["memory"] = memory_of([&] { return std::make_shared<Held>(text, problem.end, setting); });
  } else {
    point["why"] = trial->problem();
  }
  point["compiling"] = Json::object();
  Json& points = bench.document.at(place)["points"];
  points.push_back(std::move(point));
  const Json::json_pointer here = place / "points" / (points.size() - 1);
  const std::string label = chain.name + " of " + std::to_string(count);
  if (finished)
    bench.rounds.add(
        label, here, [trial, setting] { return trial->run(setting); }, first);
  bench.rounds.add(label + ", compiling", here / "compiling", [text] { return compiling(text); });
}

/// Steps of a run of a row of four-bars: all cranks stand as the first one is driven.
class Row {
 public:
  explicit Row(int count) : model_(load_text(fourbar_row(count))), motion_(start(model_)), moved_(start(model_)) {}

  std::size_t unknowns() const { return model_.sizes().unknowns; }
  /// Seconds of a step; worst: the greatest error of the last crank.
  double pass(double* worst) {
    const koppel_settings settings = model_.settings();
    koppel_state_copy(motion_.state.get(), moved_.state.get());
    if (koppel_move(moved_.state.get(), moved_.work.get(), 0.0, nullptr, nullptr) < 0) return not_a_number;
    const Stopwatch watch;
    for (std::uint32_t i = 1; i <= settings.steps; ++i) {
      const double time = settings.duration * i / settings.steps;
      if (koppel_move(moved_.state.get(), moved_.work.get(), time, nullptr, nullptr) < 0) return not_a_number;
      if (worst) *worst = std::max(*worst, off());
    }
    return watch.seconds() / settings.steps;
  }

 private:
  /// Of any bell crank from the first one.
  double off() const {
    std::vector<double> q(model_.sizes().coordinates);
    koppel_state_get(moved_.state.get(), KOPPEL_Q, q.data(), q.size());
    double worst = 0.0;
    for (std::size_t i = 2; i < q.size(); i += 3) worst = std::max(worst, std::abs(q[i] - q[0]));
    return worst;
  }

  Model model_;
  Motion motion_, moved_;
};

void add_row(Bench& bench) {
  const std::vector<int> sizes =
      bench.plan.quick ? std::vector<int>{1, 3, 10, 30} : std::vector<int>{1, 3, 10, 30, 100, 300, 1000, 4096};
  const Json::json_pointer place =
      bench.entry("scaling", {{"name", "fourbar_row"},
                              {"title", "four-bars driven by each other, one step of a run"},
                              {"points", Json::array()}});
  for (const int count : sizes) {
    progress("scaling/fourbar_row of " + std::to_string(count));
    const auto row = std::make_shared<Row>(count);
    double error = 0.0;
    const bool finished = !std::isnan(row->pass(&error));
    Json point = {{"size", count}, {"rates", row->unknowns()}, {"finished", finished}};
    if (finished) {
      point["error"] = std::max(error, std::numeric_limits<double>::epsilon());
      point["bound"] = error <= std::numeric_limits<double>::epsilon();
      point["reference"] = "all cranks stand alike";
      point["memory"] = memory_of([count] { return std::make_shared<Row>(count); });
    }
    point["compiling"] = Json::object();
    Json& points = bench.document.at(place)["points"];
    points.push_back(std::move(point));
    const Json::json_pointer here = place / "points" / (points.size() - 1);
    const std::string label = std::string("fourbar_row of ") + std::to_string(count);
    if (finished) bench.rounds.add(label, here, [row] { return row->pass(nullptr); });
    bench.rounds.add(label + ", compiling", here / "compiling",
                     [text = fourbar_row(count)] { return compiling(text); });
  }
}

}  // namespace

std::vector<std::string> scaling_names() {
  std::vector<std::string> names;
  for (const Chain& chain : chains()) names.push_back(chain.name);
  names.emplace_back("fourbar_row");
  return names;
}

void add_scaling(Bench& bench) {
  for (const Chain& chain : chains()) {
    if (!bench.wants("scaling", chain.name)) continue;
    const Json::json_pointer place = bench.entry(
        "scaling", {{"name", chain.name}, {"title", chain.title}, {"tolerance", tolerance}, {"points", Json::array()}});
    for (const int count : bench.plan.quick ? chain.quick : chain.full) {
      progress("scaling/" + chain.name + " of " + std::to_string(count));
      add_length(bench, chain, count, place);
    }
  }
  if (bench.wants("scaling", "fourbar_row")) add_row(bench);
}

}  // namespace koppel::app::bench
