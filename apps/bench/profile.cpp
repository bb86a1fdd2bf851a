// Where the time goes in the run of a scene: from its start through all its steps, each handed to a stream.
#include <memory>
#include <utility>

#include "bench/bench.hpp"
#include "bench/problems.hpp"
#include "bench/sampler.hpp"
#include "common/model.hpp"

namespace koppel::app::bench {
namespace {

/// The run of a scene, by its drives or under its forces.
class Run {
 public:
  Run(const Model& model, bool simulated, double end)
      : model_(model), start_(start(model)), moved_(start(model)), simulated_(simulated), end_(end) {
    auto options = sized<koppel_stream_options>();
    options.url = "memq://";  // nobody listens: what is timed is how states are handed over
    koppel_stream* stream = nullptr;
    koppel_stream_open(model.mechanism.get(), &options, &stream, nullptr);
    stream_.reset(stream);
  }

  bool once() {
    koppel_state* const state = moved_.state.get();
    if (!stream_ || koppel_state_copy(start_.state.get(), state) < 0) return false;
    if (simulated_ && !begin()) return false;
    const std::uint32_t steps = model_.settings().steps;
    auto report = sized<koppel_report>();
    for (std::uint32_t i = 0; i <= steps; ++i) {
      const double time = end_ * i / steps;
      const koppel_status status = simulated_ ? koppel_simulation_advance(simulation_.get(), time, state, nullptr)
                                              : koppel_move(state, moved_.work.get(), time, &report, nullptr);
      if (status < 0) return false;
      koppel_stream_publish(stream_.get(), state, moved_.work.get(), simulated_ ? nullptr : &report);
    }
    return true;
  }

 private:
  bool begin() {
    auto options = sized<koppel_simulation_options>();
    options.tolerance = 1e-8;
    options.end = end_;
    koppel_simulation* made = nullptr;
    if (koppel_close(moved_.state.get(), moved_.work.get(), nullptr, nullptr, nullptr) < 0) return false;
    if (koppel_simulation_create(moved_.state.get(), &options, &made, nullptr) < 0) return false;
    simulation_.reset(made);
    return true;
  }

  const Model& model_;
  Motion start_, moved_;
  bool simulated_;
  double end_;
  Stream stream_;
  Simulation simulation_;
};

void add_scene(Bench& bench, const std::string& name, const std::string& file, const Problem* problem) {
  if (!bench.wants("profile", name)) return;
  progress("profile/" + name);
  const Model model = load(file, false);
  Json entry = {{"name", name}, {"title", nullptr}, {"samples", 0}, {"runs", 0}, {"parts", Json::array()}};
  if (model.outcome != Exit::fine) {
    entry["why"] = model.error.message;
    bench.entry("profiles", std::move(entry));
    return;
  }
  entry["title"] = model.name(KOPPEL_KIND_SCENE, 1);
  Run run(model, problem != nullptr, problem ? problem->end : model.settings().duration);
  const Samples samples = sample([&run] { return run.once(); }, bench.plan.quick ? 0.25 : 2.0);
  std::size_t all = 0;
  for (const std::size_t count : samples.counts) all += count;
  entry["samples"] = all;
  entry["runs"] = samples.runs;
  if (!samples.problem.empty()) entry["why"] = samples.problem;
  for (std::size_t i = 0; i < samples.counts.size() && all > 0 && samples.problem.empty(); ++i) {
    entry["parts"].push_back(
        {{"part", profile_parts()[i]}, {"share", static_cast<double>(samples.counts[i]) / static_cast<double>(all)}});
  }
  bench.entry("profiles", std::move(entry));
}

}  // namespace

void add_profiles(Bench& bench) {
  for (const std::string& scene : closure_scenes(bench.plan.scenes))
    add_scene(bench, scene, bench.plan.scenes + '/' + scene + ".toml", nullptr);
  for (const Problem& problem : problems())
    add_scene(bench, problem.name, bench.plan.scenes + "/dynamics/" + problem.name + ".toml", &problem);
}

}  // namespace koppel::app::bench
