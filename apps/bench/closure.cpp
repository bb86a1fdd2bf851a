// Closed positions of shipped scenes: from the step before and from the scene's start, by each method.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <utility>

#include "bench/bench.hpp"
#include "bench/problems.hpp"
#include "common/model.hpp"

namespace koppel::app::bench {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// How positions are closed.
struct Way {
  const char* name;
  bool warm;   ///< from the step before; else from the scene's start, at t = 0
  int method;  ///< KOPPEL_METHOD_AUTO ...; -1: koppel_move, with velocities and accelerations
};

constexpr Way ways[] = {
    {"step", true, -1},
    {"newton", true, KOPPEL_METHOD_NEWTON},
    {"start", false, KOPPEL_METHOD_AUTO},
    {"start by newton", false, KOPPEL_METHOD_NEWTON},
    {"start by ceres", false, KOPPEL_METHOD_CERES},
    {"start by flow", false, KOPPEL_METHOD_FLOW},
};

/// How well the closures of a pass went.
struct Figures {
  double residual = 0.0, coordinate_error = 0.0, difference = 0.0;
  std::uint64_t iterations = 0, closed = 0, failed = 0;
};

/// The run of a scene, its positions kept to start from and to compare with.
class Run {
 public:
  Run(Model model, std::uint32_t most_steps) : model_(std::move(model)), motion_(start(model_)) {
    const koppel_settings settings = model_.settings();
    const std::uint32_t steps = std::min(settings.steps, most_steps);
    State state = copy(*motion_.state);
    for (std::uint32_t i = 0; i <= steps; ++i) {
      times_.push_back(settings.duration * i / settings.steps);
      if (koppel_move(state.get(), motion_.work.get(), times_.back(), nullptr, nullptr) < 0) break;
      positions_.push_back(copy(*state));
    }
    moved_ = copy(*motion_.state);
  }

  std::size_t steps() const { return positions_.size() < 2 ? 0 : positions_.size() - 1; }
  const Model& model() const { return model_; }

  bool in_closed_form() const {
    const std::string flow = text_of([this](char* text, std::size_t size, std::size_t* needed) {
      return koppel_flow_explain(model_.mechanism.get(), KOPPEL_FLOW_TEXT, text, size, needed);
    });
    return flow.find("Every step is in closed form") != std::string::npos;
  }

  /// One pass. Seconds of a closure; figures may be null.
  double pass(const Way& way, Figures* figures) {
    double seconds = 0.0;
    const std::size_t last = way.warm ? steps() : 0;
    for (std::size_t i = way.warm ? 1 : 0; i <= last; ++i) seconds += close(way, i, figures);
    return seconds / static_cast<double>(way.warm ? last : 1);
  }

 private:
  State copy(const koppel_state& from) const {
    koppel_state* state = nullptr;
    if (koppel_state_create(model_.mechanism.get(), &state) >= 0) koppel_state_copy(&from, state);
    return State(state);
  }

  double close(const Way& way, std::size_t step, Figures* figures) {
    koppel_state* state = moved_.get();
    auto report = sized<koppel_report>();
    auto options = sized<koppel_close_options>();
    options.method = std::max(way.method, 0);
    koppel_state_copy(way.warm ? positions_[step - 1].get() : motion_.state.get(), state);
    koppel_status status = KOPPEL_OK;
    const Stopwatch watch;
    if (way.method < 0) {
      status = koppel_move(state, motion_.work.get(), times_[step], &report, nullptr);
    } else {
      koppel_state_set_time(state, times_[step], nullptr);
      status = koppel_close(state, motion_.work.get(), &options, &report, nullptr);
    }
    const double seconds = watch.seconds();
    if (figures) take(*figures, status, report, step);
    return seconds;
  }

  void take(Figures& figures, koppel_status status, const koppel_report& report, std::size_t step) const {
    if (status < 0) {
      ++figures.failed;
      return;
    }
    ++figures.closed;
    figures.iterations += report.iterations;
    figures.residual = std::max(figures.residual, report.residual);
    figures.coordinate_error = std::max(figures.coordinate_error, report.coordinate_error);
    figures.difference = std::max(figures.difference, difference(step));
  }

  /// Of the coordinates from those of the run: angles but for full turns, lengths over the scene's length.
  double difference(std::size_t step) const {
    const std::size_t n = model_.sizes().coordinates;
    std::vector<double> here(n), there(n);
    koppel_state_get(moved_.get(), KOPPEL_Q, here.data(), n);
    koppel_state_get(positions_[step].get(), KOPPEL_Q, there.data(), n);
    double worst = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const std::string unit = model_.unit(KOPPEL_KIND_COORDINATE, i);
      double off = here[i] - there[i];
      if (unit == "rad") off = std::remainder(off, 2.0 * std::numbers::pi);
      if (unit == "m") off /= model_.settings().length;
      worst = std::max(worst, std::abs(off));
    }
    return worst;
  }

  Model model_;
  Motion motion_;
  State moved_;
  std::vector<double> times_;
  std::vector<State> positions_;
};

Json describe(const Way& way, const Figures& figures) {
  Json data = {{"way", way.name}, {"warm", way.warm}, {"closed", figures.closed}, {"failed", figures.failed}};
  const bool any = figures.closed > 0;
  data["residual"] = any ? Json(figures.residual) : Json(nullptr);
  data["coordinate_error"] = any ? Json(figures.coordinate_error) : Json(nullptr);
  data["difference"] = any ? Json(figures.difference) : Json(nullptr);
  data["iterations"] =
      any ? Json(static_cast<double>(figures.iterations) / static_cast<double>(figures.closed)) : Json(nullptr);
  return data;
}

void add_scene(Bench& bench, const std::string& name) {
  const auto run =
      std::make_shared<Run>(load(bench.plan.scenes + '/' + name + ".toml", false), bench.plan.quick ? 40 : 1000);
  if (run->steps() == 0) return;
  const koppel_sizes sizes = run->model().sizes();
  const Json::json_pointer place = bench.entry("closures", {{"name", name},
                                                            {"title", run->model().name(KOPPEL_KIND_SCENE, 1)},
                                                            {"equations", sizes.equations},
                                                            {"unknowns", sizes.unknowns},
                                                            {"steps", run->steps()},
                                                            {"ways", Json::array()}});
  for (const Way& way : ways) {
    if (way.method == KOPPEL_METHOD_FLOW && bench.plan.quick && !run->in_closed_form()) continue;  // may take seconds
    Figures figures;
    const double first = run->pass(way, &figures);
    Json& list = bench.document.at(place)["ways"];
    list.push_back(describe(way, figures));
    if (figures.failed > 0) continue;  // the time of a failure is none to compare
    bench.rounds.add(
        name + ", " + way.name, place / "ways" / (list.size() - 1), [run, way] { return run->pass(way, nullptr); },
        first);
  }
}

}  // namespace

std::vector<std::string> closure_scenes(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

void add_closures(Bench& bench) {
  for (const std::string& scene : closure_scenes(bench.plan.scenes)) {
    if (!bench.wants("closure", scene)) continue;
    progress("closure/" + scene);
    add_scene(bench, scene);
  }
}

}  // namespace koppel::app::bench
