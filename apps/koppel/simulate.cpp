// koppel simulate SCENE
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

#include "koppel/command.hpp"
#include "koppel/recorder.hpp"

namespace koppel::app {
namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  std::string scene;
  std::optional<double> duration;
  std::optional<std::uint32_t> steps;
  double tolerance = 0.0, step = 0.0;
  RecorderOptions record;
  bool realtime = false;
  bool quiet = false;
  bool json = false;
};

/// One simulation of one scene.
class Simulate {
 public:
  Simulate(const Model& model, const Options& options)
      : model_(model),
        options_(options),
        motion_(start(model)),
        rows_(options.steps.value_or(model.settings().steps)),
        duration_(options.duration.value_or(model.settings().duration)),
        recorder_(model, options.record) {}

  Exit run() {
    if (!motion_.state || !motion_.work) good(KOPPEL_NO_MEMORY);
    if (outcome_ != Exit::fine || !recorded(recorder_.open()) || !begin()) return outcome_;
    const Clock::time_point begin = Clock::now();
    for (std::uint32_t i = 0; i <= rows_; ++i) {
      const double time = i == rows_ ? duration_ : duration_ * i / rows_;
      if (options_.realtime) std::this_thread::sleep_until(begin + std::chrono::duration<double>(time));
      if (!advance(time)) break;
      reached_ = time;
      show_progress(i);
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
    std::fprintf(out, "steps       %llu, and %llu rejected; %llu evaluations\n", count(summary_.steps),
                 count(summary_.rejected), count(summary_.evaluations));
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
    document["steps"] = summary_.steps;
    document["rejected"] = summary_.rejected;
    document["evaluations"] = summary_.evaluations;
    document["seconds"] = seconds_;
    document["energy"] = summary_.energy;
    document["energy_error"] = summary_.energy_error;
    document["energy_size"] = summary_.energy_size;
    document["position_drift"] = summary_.position_drift;
    document["velocity_drift"] = summary_.velocity_drift;
    document["start_change"] = summary_.start_change;
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

  /// Closes the loops at time 0 and starts from there.
  bool begin() {
    auto report = sized<koppel_report>();
    if (!good(koppel_close(motion_.state.get(), motion_.work.get(), nullptr, &report, &error_))) return false;
    auto how = sized<koppel_simulation_options>();
    how.tolerance = options_.tolerance;
    how.step = options_.step;
    how.end = duration_;
    koppel_simulation* simulation = nullptr;
    if (!good(koppel_simulation_create(motion_.state.get(), &how, &simulation, &error_))) return false;
    simulation_.reset(simulation);
    return true;
  }

  bool advance(double time) {
    koppel_state* state = motion_.state.get();
    if (!good(koppel_simulation_advance(simulation_.get(), time, state, &error_))) return false;
    return recorded(recorder_.write(motion_, time, nullptr));
  }

  void show_progress(std::uint32_t row) const {
    if (options_.quiet || options_.json || isatty(STDERR_FILENO) == 0) return;
    const bool last = row == rows_;
    if (last || row * 100ull / rows_ != (row + 1) * 100ull / rows_) {
      std::fprintf(stderr, "\r%.4g of %.4g s%s", reached_, duration_, last ? "\r\033[K" : "");
    }
  }

  const Model& model_;
  const Options& options_;
  Motion motion_;
  Simulation simulation_;
  std::uint32_t rows_;
  double duration_, reached_ = 0.0, seconds_ = 0.0;
  Recorder recorder_;
  koppel_simulation_summary summary_ = sized<koppel_simulation_summary>();
  koppel_error error_ = sized<koppel_error>();
  Exit outcome_ = Exit::fine;
};

Exit simulate(const Options& options, bool verbose) {
  const Model model = load(options.scene, verbose);
  if (!model.mechanism) {
    if (options.json) {
      print_json({{"finished", false}, {"diagnostics", json_of_findings(model)}, {"error", json_of(model.error)}});
    } else {
      model.print_findings();
    }
    return model.outcome;
  }
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

std::string positive(const std::string& text) {
  double value = 0.0;
  const bool good = CLI::detail::lexical_cast(text, value) && value > 0.0 && std::isfinite(value);
  return good ? "" : "must be a positive number";
}

}  // namespace

void add_simulate(CLI::App& app, const Common& common, Exit& outcome) {
  CLI::App* command = app.add_subcommand(
      "simulate", "Move a scene by its forces, masses and drives; record, stream, tell how exactly and how fast");
  auto options = std::make_shared<Options>();
  command->add_option("SCENE", options->scene, "The scene file")->required()->check(not_empty)->type_name("");
  command->add_option("--duration", options->duration, "How long; default: as the scene proposes")
      ->check(positive)
      ->type_name("SECONDS");
  command->add_option("--steps", options->steps, "How many rows of output; default: as the scene proposes")
      ->check(CLI::Range(1u, 1000000000u))
      ->type_name("N");
  CLI::Option* tolerance =
      command
          ->add_option("--tolerance", options->tolerance,
                       "Error of an integration step that is allowed; default: as the scene says, or 1e-8")
          ->check(positive)
          ->type_name("X");
  command->add_option("--step", options->step, "Integrate in fixed steps instead, by the classical Runge-Kutta method")
      ->check(positive)
      ->excludes(tolerance)
      ->type_name("SECONDS");
  CLI::Option* csv = add_recorder_options(*command, options->record,
                                          "Write time and recorded columns (SI units, radians); - is standard output");
  command->add_flag("--realtime", options->realtime, "Let a second of the motion take a second");
  command->add_flag("-q,--quiet", options->quiet, "Print errors only");
  command->add_flag("--json", options->json, "Print the summary as JSON");
  command->callback([options, csv, &common, &outcome] {
    if (options->json && csv->count() > 0 && options->record.csv == "-") {
      throw CLI::ValidationError("--csv", "standard output cannot take both the table and --json");
    }
    outcome = simulate(*options, common.verbose);
  });
}

}  // namespace koppel::app
