// koppel run SCENE
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

#include "koppel/at_start.hpp"
#include "koppel/command.hpp"
#include "koppel/recorder.hpp"
#include "koppel/summary.hpp"

namespace koppel::app {
namespace {

using Clock = std::chrono::steady_clock;

struct Options {
  std::string scene;
  std::optional<double> duration;
  std::optional<std::uint32_t> steps;
  RecorderOptions record;
  bool through = false;
  std::string branch = "stay";
  bool realtime = false;
  bool quiet = false;
  bool json = false;
};

/// What ended a run, with the step and the time where it did; they are null if there was no step yet.
nlohmann::ordered_json json_of_failure(const koppel_error& error, std::optional<std::uint32_t> step, double time) {
  nlohmann::ordered_json document = json_of(error);
  document["step"] = nullptr;
  document["time"] = nullptr;
  if (step) {
    document["step"] = *step;
    document["time"] = time;
  }
  return document;
}

/// One run of one scene. Each part returns what went wrong, if anything; run() goes through all of them.
class Run {
 public:
  Run(const Model& model, const Options& options)
      : model_(model),
        options_(options),
        motion_(start(model)),
        steps_(options.steps.value_or(model.settings().steps)),
        duration_(options.duration.value_or(model.settings().duration)),
        recorder_(model, options.record, columns(options)) {
    way_.branch = options.branch == "take" ? KOPPEL_BRANCH_TAKE : KOPPEL_BRANCH_STAY;
  }

  Exit run() {
    if (!open()) return outcome_;
    const Clock::time_point begin = Clock::now();
    for (std::uint32_t i = 0; i <= steps_; ++i) {
      const double time = duration_ * i / steps_;
      if (options_.realtime) std::this_thread::sleep_until(begin + std::chrono::duration<double>(time));
      if (!step(i, time)) {
        failed_step_ = i;
        break;
      }
      show_progress(i);
    }
    close();
    return outcome_;
  }

  /// False: not even the first position was found.
  bool started() const { return started_; }

  void print(std::FILE* out) const {
    std::fprintf(out, "%s: %u of %u steps over %.6g s\n", model_.name(KOPPEL_KIND_SCENE, 0).c_str(), summary_.steps(),
                 steps_, duration_);
    if (analysis_) {
      std::fprintf(out, "mobility    %d by rank, %d by count\n", analysis_->mobility_rank, analysis_->mobility_count);
    }
    summary_.print(out);
    recorder_.print(out);
  }

  nlohmann::ordered_json to_json() const {
    nlohmann::ordered_json document;
    document["scene"] = model_.name(KOPPEL_KIND_SCENE, 0);
    document["closed"] = started_ && outcome_ != Exit::not_closed;
    document["duration"] = duration_;
    add_counts(document, model_.sizes(), analysis_);
    summary_.write(document);
    recorder_.write(document);
    document["diagnostics"] = json_of_findings(model_);
    if (outcome_ != Exit::fine) {
      document["diagnostics"].push_back(json_of(error_));
      document["error"] = json_of_failure(error_, failed_step_, duration_ * failed_step_.value_or(0) / steps_);
      if (!limit_.is_null()) document["error"]["limit"] = limit_;
    }
    return document;
  }

 private:
  /// Keeps the outcome of a call that failed; false: it did.
  bool good(koppel_status status) {
    if (status >= 0) return true;
    outcome_ = exit_of(status);
    if (!options_.json) print_error(error_);
    return false;
  }

  bool open() {
    if (!motion_.state || !motion_.work) return good(KOPPEL_NO_MEMORY);
    return recorded(recorder_.open());
  }

  /// As good(), of what the recorder did.
  bool recorded(koppel_status status) {
    if (status < 0) error_ = recorder_.error();
    return good(status);
  }

  static std::vector<std::string> columns(const Options& options) {
    if (options.through) return {"residual", "drive_time"};
    return {"residual"};
  }

  bool step(std::uint32_t index, double time) {
    auto report = sized<koppel_report>();
    koppel_state* state = motion_.state.get();
    koppel_work* work = motion_.work.get();
    const Clock::time_point before = Clock::now();
    const bool follow = options_.through && index > 0;
    const koppel_status status = follow ? koppel_follow(state, work, duration_ / steps_, &way_, &report, &error_)
                                        : koppel_move_on(state, work, time, &way_, &report, &error_);
    const double seconds = std::chrono::duration<double>(Clock::now() - before).count();
    if (status < 0) {
      if (!options_.json) std::fprintf(stderr, "step %u, t = %.6g s:\n", index, time);
      if (index == 0) analysis_ = at_start(model_).analysis;
      if (report.verdict == KOPPEL_VERDICT_LIMIT) limit_ = json_of_limit(report);
      return good(status);
    }
    pass_singular_positions(time, report);
    if (index == 0) {
      started_ = true;
      summary_.assemble(status, report, seconds);
      auto analysis = sized<koppel_analysis>();
      if (!good(koppel_analyse(state, work, &analysis, &error_))) return false;
      analysis_ = analysis;
    } else {
      summary_.add(time, status, report, seconds);
    }
    if ((status & KOPPEL_LIMIT_EXCEEDED) != 0) {
      summary_.leave_limits(time, text_of([state](char* text, std::size_t size, std::size_t* needed) {
                              return koppel_limits_exceeded(state, text, size, needed);
                            }));
    }
    return write(time, report);
  }

  /// Coordinates in SI units, radians.
  nlohmann::ordered_json json_of_limit(const koppel_report& report) const {
    const std::string input = model_.name(KOPPEL_KIND_INPUT, static_cast<std::size_t>(report.limit_input));
    nlohmann::ordered_json limit{
        {"drive", input}, {"value", report.limit_value}, {"time", report.limit_time}, {"drive_instead", nullptr}};
    if (report.drive_instead >= 0) {
      limit["drive_instead"] = model_.name(KOPPEL_KIND_COORDINATE, static_cast<std::size_t>(report.drive_instead));
    }
    return limit;
  }

  void pass_singular_positions(double time, const koppel_report& report) {
    if (report.change_points > 0) summary_.pass_change_points(report.change_points, report.change_point_time);
    if (report.limits > 0) summary_.pass_limits(time, json_of_limit(report));
  }

  bool write(double time, const koppel_report& report) {
    more_ = {report.residual};
    if (options_.through) more_.push_back(koppel_state_time(motion_.state.get()));
    return recorded(recorder_.write(motion_, time, &report, more_));
  }

  void show_progress(std::uint32_t index) const {
    if (options_.quiet || options_.json || isatty(STDERR_FILENO) == 0) return;
    const bool last = index == steps_;
    if (last || index * 100ull / steps_ != (index + 1) * 100ull / steps_) {
      std::fprintf(stderr, "\r%u of %u steps%s", index, steps_, last ? "\r\033[K" : "");
    }
  }

  void close() {
    const koppel_status status = recorder_.close();
    if (outcome_ == Exit::fine) recorded(status);
  }

  const Model& model_;
  const Options& options_;
  Motion motion_;
  std::uint32_t steps_;
  double duration_;
  Recorder recorder_;
  std::vector<double> more_;
  bool started_ = false;
  std::optional<koppel_analysis> analysis_;  ///< at time 0
  std::optional<std::uint32_t> failed_step_;
  nlohmann::ordered_json limit_;  ///< that ended the run
  koppel_motion_options way_ = sized<koppel_motion_options>();
  Summary summary_;
  koppel_error error_ = sized<koppel_error>();
  Exit outcome_ = Exit::fine;
};

Exit run(const Options& options, bool verbose) {
  const Model model = load(options.scene, verbose);
  if (!model.mechanism) {
    if (options.json) {
      print_json({{"closed", nullptr},
                  {"diagnostics", json_of_findings(model)},
                  {"error", json_of_failure(model.error, std::nullopt, 0.0)}});
    } else {
      model.print_findings();
    }
    return model.outcome;
  }
  if (!options.quiet) {
    if (!options.json) model.print_findings();
    if (model.sizes().inputs == 0) std::fputs("note: nothing is driven: nothing moves\n", stderr);
  }
  Run run(model, options);
  const Exit outcome = run.run();
  if (options.json) {
    print_json(run.to_json());
  } else if (!options.quiet && run.started()) {
    run.print(options.record.csv == "-" ? stderr : stdout);
  }
  return outcome;
}

std::string seconds(const std::string& text) {
  double value = 0.0;
  const bool good = CLI::detail::lexical_cast(text, value) && value > 0.0 && std::isfinite(value);
  return good ? "" : "must be a positive number of seconds";
}

std::string step_count(const std::string& text) {
  std::int64_t value = 0;
  const bool good = CLI::detail::lexical_cast(text, value) && value >= 1 && value <= 1000000000;
  return good ? "" : "must be a whole number from 1 to 1000000000";
}

}  // namespace

void add_run(CLI::App& app, const Common& common, Exit& outcome) {
  CLI::App* command =
      app.add_subcommand("run", "Move the drives of a scene over time; record, stream, tell how exactly and how fast");
  auto options = std::make_shared<Options>();
  command->add_option("SCENE", options->scene, "The scene file")->required()->check(not_empty)->type_name("");
  command->add_option("--duration", options->duration, "How long to run; default: as the scene proposes")
      ->check(seconds)
      ->type_name("SECONDS");
  command->add_option("--steps", options->steps, "Number of steps; default: as the scene proposes")
      ->check(step_count)
      ->type_name("N");
  CLI::Option* csv = add_recorder_options(
      *command, options->record, "Write time, recorded columns (SI units, radians) and residual; - is standard output");
  command->add_flag("--through", options->through,
                    "Go on where a drive goes no further: it turns back, and time runs with the length of the way");
  command
      ->add_option("--branch", options->branch,
                   "Where branches meet: stay (go on as the motion came) or take (the other branch); default: stay")
      ->check(CLI::IsMember({"stay", "take"}))
      ->type_name("WHICH");
  command->add_flag("--realtime", options->realtime, "Let a second of the run take a second");
  command->add_flag("-q,--quiet", options->quiet, "Print errors only");
  command->add_flag("--json", options->json, "Print the summary as JSON");
  command->callback([options, csv, &common, &outcome] {
    if (options->json && csv->count() > 0 && options->record.csv == "-") {
      throw CLI::ValidationError("--csv", "standard output cannot take both the table and --json");
    }
    outcome = run(*options, common.verbose);
  });
}

}  // namespace koppel::app
