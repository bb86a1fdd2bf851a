// koppel simulate SCENE
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

#include "koppel/checkpoint.hpp"
#include "koppel/global_error.hpp"
#include "koppel/recorder.hpp"
#include "koppel/simulate_options.hpp"

namespace koppel::app {
namespace {

using Clock = std::chrono::steady_clock;

/// One simulation of one scene.
class Simulate {
 public:
  Simulate(const Model& model, const SimulateOptions& options)
      : model_(model),
        options_(options),
        motion_(start(model)),
        rows_(options.steps.value_or(model.settings().steps)),
        duration_(options.duration.value_or(model.settings().duration)),
        next_(options.every),
        recorder_(model, options.record) {}

  Exit run() {
    if (!motion_.state || !motion_.work) good(KOPPEL_NO_MEMORY);
    if (outcome_ != Exit::fine || !recorded(recorder_.open()) || !begin()) return outcome_;
    const Clock::time_point begin = Clock::now();
    for (std::uint32_t i = 0; i <= rows_ && !stopped_; ++i) {
      const double time = i == rows_ ? duration_ : duration_ * i / rows_;
      if (time <= resumed_at_) continue;
      if (options_.realtime)
        std::this_thread::sleep_until(begin + std::chrono::duration<double>(time - std::max(resumed_at_, 0.0)));
      if (!advance(time)) break;
      show_progress(i);
      if (!keep()) break;
    }
    seconds_ = std::chrono::duration<double>(Clock::now() - begin).count();
    if (simulation_) koppel_simulation_summarise(simulation_.get(), &summary_);
    const koppel_status closed = recorder_.close();
    if (outcome_ == Exit::fine) recorded(closed);
    return outcome_;
  }

  bool started() const { return simulation_ != nullptr; }

  void print(std::FILE* out) const {
    const double size = summary_.energy_size;
    std::fprintf(out, "%s: simulated %.6g of %.6g s in %.3g s\n", model_.name(KOPPEL_KIND_SCENE, 0).c_str(), reached_,
                 duration_, seconds_);
    std::fprintf(out, "freedoms    %u independent coordinates, chosen anew %u times\n", summary_.freedoms,
                 summary_.switches);
    std::fprintf(out, "steps       %llu by %s, and %llu rejected; %llu evaluations\n", count(summary_.steps),
                 name_by(koppel_simulation_integrator).c_str(), count(summary_.rejected), count(summary_.evaluations));
    if (summary_.stiff != 0) {
      std::fprintf(out, "stiff       steps were as short as stability wants them: try --integrator cvode\n");
    }
    if (summary_.events > 0) std::fprintf(out, "events      %u kinks or jumps of forces\n", summary_.events);
    print_crossings(out);
    if (comparison_) {
      std::fprintf(out, "error       of coordinates, estimated: %.2g at the end, %.2g at most\n", comparison_->last(),
                   comparison_->greatest());
    }
    std::fprintf(out, "energy      %.9g J at the end; unexplained change at most %.2g J%s\n", summary_.energy,
                 summary_.energy_error, size > 0.0 ? part(summary_.energy_error / size).c_str() : "");
    std::fprintf(out, "loops       open by at most %.2g, at rates of at most %.2g 1/s\n", summary_.position_drift,
                 summary_.velocity_drift);
    if (summary_.start_change > noticeable) {
      std::fprintf(out, "start       rates that were asked for do not fit the loops: changed by up to %.3g\n",
                   summary_.start_change);
    }
    recorder_.print(out);
  }

  nlohmann::ordered_json to_json() const {
    nlohmann::ordered_json document;
    document["scene"] = model_.name(KOPPEL_KIND_SCENE, 0);
    document["finished"] = started() && outcome_ == Exit::fine;
    document["time"] = reached_;
    document["duration"] = duration_;
    document["freedoms"] = summary_.freedoms;
    document["switches"] = summary_.switches;
    document["integrator"] = name_by(koppel_simulation_integrator);
    document["formulation"] = name_by(koppel_simulation_formulation);
    document["tolerance"] = summary_.tolerance;
    document["step"] = summary_.step;
    document["stiff"] = summary_.stiff != 0;
    document["steps"] = summary_.steps;
    document["rejected"] = summary_.rejected;
    document["evaluations"] = summary_.evaluations;
    document["events"] = summary_.events;
    document["crossings"] = nlohmann::ordered_json::array();
    for (const koppel_crossing& crossing : crossings_) {
      document["crossings"].push_back({{"watch", model_.name(KOPPEL_KIND_WATCH, crossing.watch)},
                                       {"time", crossing.time},
                                       {"rising", crossing.rising != 0},
                                       {"stop", crossing.stop != 0}});
    }
    document["seconds"] = seconds_;
    document["energy"] = summary_.energy;
    document["energy_error"] = summary_.energy_error;
    document["energy_size"] = summary_.energy_size;
    document["position_drift"] = summary_.position_drift;
    document["velocity_drift"] = summary_.velocity_drift;
    document["start_change"] = summary_.start_change;
    if (comparison_) document["global_error"] = {{"greatest", comparison_->greatest()}, {"end", comparison_->last()}};
    document["final"] = {{"coordinates", values(KOPPEL_Q, KOPPEL_KIND_COORDINATE, model_.sizes().coordinates)},
                         {"velocities", values(KOPPEL_V, KOPPEL_KIND_RATE, model_.sizes().rates)},
                         {"accelerations", values(KOPPEL_A, KOPPEL_KIND_RATE, model_.sizes().rates)}};
    recorder_.write(document);
    document["diagnostics"] = json_of_findings(model_);
    if (outcome_ != Exit::fine) {
      document["diagnostics"].push_back(json_of(error_));
      document["error"] = json_of(error_);
    }
    return document;
  }

 private:
  static constexpr double noticeable = 1e-9;

  static unsigned long long count(std::uint64_t n) { return static_cast<unsigned long long>(n); }

  static std::string part(double ratio) {
    char text[48];
    std::snprintf(text, sizeof text, ", %.2g of what moves", ratio);
    return text;
  }

  void print_crossings(std::FILE* out) const {
    constexpr std::size_t most = 10;
    for (std::size_t i = 0; i < std::min(most, crossings_.size()); ++i) {
      const koppel_crossing& crossing = crossings_[i];
      std::fprintf(out, "crossed     %s at %.9g s, %s%s\n", model_.name(KOPPEL_KIND_WATCH, crossing.watch).c_str(),
                   crossing.time, crossing.rising != 0 ? "rising" : "falling",
                   crossing.stop != 0 ? ": stopped there" : "");
    }
    if (crossings_.size() > most) std::fprintf(out, "            and %zu more\n", crossings_.size() - most);
  }

  std::string name_by(koppel_status (*name)(const koppel_simulation*, char*, size_t, size_t*)) const {
    return text_of(
        [&](char* text, std::size_t size, std::size_t* needed) { return name(simulation_.get(), text, size, needed); });
  }

  nlohmann::ordered_json values(std::int32_t what, std::int32_t kind, std::size_t size) const {
    auto result = nlohmann::ordered_json::object();
    std::vector<double> numbers(size);
    if (!motion_.state || koppel_state_get(motion_.state.get(), what, numbers.data(), size) < 0) return result;
    for (std::size_t i = 0; i < size; ++i) result[model_.name(kind, i)] = numbers[i];
    return result;
  }

  /// Keeps the outcome of a call that failed; false: it did.
  bool good(koppel_status status) {
    if (status >= 0) return true;
    outcome_ = exit_of(status);
    if (!options_.json) print_error(error_);
    return false;
  }

  /// As good(), of what the recorder did.
  bool recorded(koppel_status status) {
    if (status < 0) error_ = recorder_.error();
    return good(status);
  }

  /// Closes the loops at time 0 and starts from there; or goes on from where it was saved.
  bool begin() {
    if (!options_.resume.empty()) {
      if (!good(read_checkpoint(model_, options_.resume, simulation_, error_))) return false;
      reached_ = resumed_at_ = koppel_simulation_time(simulation_.get());
      next_ = reached_ + options_.every;
      return good(koppel_simulation_advance(simulation_.get(), reached_, motion_.state.get(), &error_));
    }
    auto report = sized<koppel_report>();
    if (!good(koppel_close(motion_.state.get(), motion_.work.get(), nullptr, &report, &error_))) return false;
    auto how = sized<koppel_simulation_options>();
    how.tolerance = options_.tolerance;
    how.step = options_.step;
    how.end = duration_;
    how.integrator = options_.integrator.empty() ? nullptr : options_.integrator.c_str();
    how.formulation = options_.formulation.empty() ? nullptr : options_.formulation.c_str();
    koppel_simulation* simulation = nullptr;
    if (!good(koppel_simulation_create(motion_.state.get(), &how, &simulation, &error_))) return false;
    simulation_.reset(simulation);
    if (!options_.estimate) return true;
    comparison_.emplace(model_);
    return good(comparison_->begin(motion_.state.get(), simulation, how, error_));
  }

  /// To a row's time, with a row for each crossing on the way; no further than to one that stops.
  bool advance(double time) {
    koppel_state* state = motion_.state.get();
    auto crossing = sized<koppel_crossing>();
    do {
      if (!good(koppel_simulation_watch(simulation_.get(), time, state, &crossing, &error_))) return false;
      reached_ = koppel_simulation_time(simulation_.get());
      if (!recorded(recorder_.write(motion_, reached_, nullptr))) return false;
      if (crossing.watch == KOPPEL_NO_WATCH) break;
      crossings_.push_back(crossing);
      stopped_ = crossing.stop != 0;
    } while (!stopped_ && reached_ < time);
    return !comparison_ || good(comparison_->compare(state, reached_, error_));
  }

  /// Saves the simulation where it is time, and at the end.
  bool keep() {
    if (options_.checkpoint.empty()) return true;
    const bool due = options_.every > 0.0 && reached_ >= next_;
    if (due) next_ = reached_ + options_.every;
    return (!due && !stopped_ && reached_ < duration_) ||
           good(write_checkpoint(simulation_.get(), options_.checkpoint, error_));
  }

  void show_progress(std::uint32_t row) const {
    if (options_.quiet || options_.json || isatty(STDERR_FILENO) == 0) return;
    const bool last = row == rows_ || stopped_;
    if (last || row * 100ull / rows_ != (row + 1) * 100ull / rows_) {
      std::fprintf(stderr, "\r%.4g of %.4g s%s", reached_, duration_, last ? "\r\033[K" : "");
    }
  }

  const Model& model_;
  const SimulateOptions& options_;
  Motion motion_;
  Simulation simulation_;
  std::optional<GlobalError> comparison_;
  std::uint32_t rows_;
  double duration_, reached_ = 0.0, seconds_ = 0.0;
  double resumed_at_ = -1.0, next_;  ///< where it was saved before; where it is to be saved next
  Recorder recorder_;
  std::vector<koppel_crossing> crossings_;
  bool stopped_ = false;  ///< by a crossing
  koppel_simulation_summary summary_ = sized<koppel_simulation_summary>();
  koppel_error error_ = sized<koppel_error>();
  Exit outcome_ = Exit::fine;
};

Exit simulate(const SimulateOptions& options, bool verbose) {
  const Model model = load(options.scene, verbose);
  if (!model.mechanism) return refused(model, options.json, "finished");
  if (!options.quiet && !options.json) model.print_findings();
  Simulate simulation(model, options);
  const Exit outcome = simulation.run();
  if (options.json) {
    print_json(simulation.to_json());
  } else if (!options.quiet && simulation.started()) {
    simulation.print(options.record.csv == "-" ? stderr : stdout);
  }
  return outcome;
}

}  // namespace

void add_simulate(CLI::App& app, const Common& common, Exit& outcome) {
  auto options = std::make_shared<SimulateOptions>();
  add_simulate_options(app, options, [options, &common, &outcome] { outcome = simulate(*options, common.verbose); });
}

}  // namespace koppel::app
