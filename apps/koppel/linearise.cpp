// koppel linearise SCENE
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "koppel/at_start.hpp"
#include "koppel/command.hpp"
#include "koppel/linear_equations.hpp"
#include "koppel/resting.hpp"

namespace koppel::app {
namespace {

struct Options {
  std::string scene;
  double time = 0.0;
  std::string at = "equilibrium";
  std::vector<std::string> inputs, outputs;
  bool steady = false, json = false;
};

const char* const courses[] = {"unsteady", "steady", "resting"};

/// The linear equations of one scene.
class Linear {
 public:
  Linear(const Model& model, const Options& options) : model_(model), options_(options), motion_(start(model)) {}

  Exit make() {
    if (!good(close_at(motion_, options_.time, error_)) || !choose_efforts() || !place() || !linearise()) {
      return outcome_;
    }
    states_ = linear_numbers(linearisation_.get(), KOPPEL_LINEAR_STATE, summary_.states, {});
    inputs_ = linear_numbers(linearisation_.get(), KOPPEL_LINEAR_INPUT, summary_.inputs, options_.inputs);
    outputs_ = linear_numbers(linearisation_.get(), KOPPEL_LINEAR_OUTPUT, summary_.outputs, options_.outputs);
    for (std::size_t i = 0; i < summary_.states; ++i)
      modes_.push_back(linear_mode(linearisation_.get(), i, model_.sizes().rates));
    return outcome_;
  }

  void print() const;
  nlohmann::ordered_json to_json() const;

 private:
  bool good(koppel_status status) {
    if (status >= 0) return true;
    outcome_ = exit_of(status);
    return false;
  }

  /// Inputs that no drive sets are efforts.
  bool choose_efforts() {
    std::size_t index = 0;
    for (const std::string& name : options_.inputs) {
      if (koppel_mechanism_find(model_.mechanism.get(), KOPPEL_KIND_INPUT, name.c_str(), &index, nullptr) >= 0)
        continue;
      if (koppel_mechanism_find(model_.mechanism.get(), KOPPEL_KIND_RATE, name.c_str(), &index, &error_) < 0) {
        return refuse();
      }
      efforts_.push_back(static_cast<std::uint32_t>(index));
    }
    for (const std::string& name : options_.outputs) {
      if (koppel_mechanism_find(model_.mechanism.get(), KOPPEL_KIND_RECORD, name.c_str(), &index, &error_) < 0) {
        return refuse();
      }
    }
    return true;
  }
  bool refuse() {
    outcome_ = Exit::usage;
    return false;
  }

  /// Goes to the equilibrium, or takes over the rates of the start.
  bool place() {
    if (options_.at == "equilibrium") return rest();
    koppel_simulation* simulation = nullptr;
    if (!good(koppel_simulation_create(motion_.state.get(), nullptr, &simulation, &error_))) return false;
    const Simulation owner(simulation);
    return good(koppel_simulation_advance(simulation, options_.time, motion_.state.get(), &error_));
  }
  bool rest() {
    auto how = sized<koppel_equilibrium_options>();
    how.drives = options_.steady ? KOPPEL_DRIVES_MOVING : KOPPEL_DRIVES_HELD;
    koppel_equilibrium* equilibrium = nullptr;
    if (!good(koppel_equilibrium_find(motion_.state.get(), &how, &equilibrium, &error_))) return false;
    equilibrium_.reset(equilibrium);
    auto summary = sized<koppel_equilibrium_summary>();
    koppel_equilibrium_summarise(equilibrium, &summary);
    if (summary.found != 0) return true;
    error_ = no_rest(model_, equilibrium);
    return good(KOPPEL_NOT_CLOSED);
  }

  bool linearise() {
    auto how = sized<koppel_linearisation_options>();
    how.drives = options_.steady || !equilibrium_ ? KOPPEL_DRIVES_MOVING : KOPPEL_DRIVES_HELD;
    how.equilibrium = equilibrium_.get();
    how.efforts = efforts_.data();
    how.effort_count = efforts_.size();
    koppel_linearisation* linearisation = nullptr;
    if (!good(koppel_linearise(motion_.state.get(), &how, &linearisation, &error_))) return false;
    linearisation_.reset(linearisation);
    return good(koppel_linearisation_summarise(linearisation, &summary_));
  }

  nlohmann::ordered_json reduced(std::int32_t what) const;

  const Model& model_;
  const Options& options_;
  Motion motion_;
  std::vector<std::uint32_t> efforts_;
  Equilibrium equilibrium_;
  Linearisation linearisation_;
  koppel_linearisation_summary summary_ = sized<koppel_linearisation_summary>();
  LinearNumbers states_, inputs_, outputs_;
  std::vector<LinearMode> modes_;
  koppel_error error_ = sized<koppel_error>();
  Exit outcome_ = Exit::fine;
};

void Linear::print() const {
  if (outcome_ != Exit::fine) {
    print_error(error_);
    return;
  }
  std::printf("%s: linear about %s at t = %g s\n", model_.name(KOPPEL_KIND_SCENE, 0).c_str(),
              equilibrium_ ? "its equilibrium" : "its start", options_.time);
  std::printf("state       %u coordinates, %u numbers; %s\n", summary_.freedoms, summary_.states,
              courses[summary_.course]);
  if (summary_.course == KOPPEL_COURSE_UNSTEADY) {
    std::printf("warning     its rates change by up to %.3g 1/s^2: eigenvalues tell of this instant only\n",
                summary_.drift);
  }
  unsigned unstable = 0;
  for (const LinearMode& mode : modes_) unstable += mode.eigenvalue.real() > mode.error ? 1u : 0u;
  std::printf("stability   %u of %zu eigenvalues grow\n", unstable, modes_.size());
  std::printf("%14s %10s %27s %9s  %s\n", "frequency [Hz]", "damping", "eigenvalue [1/s]", "error", "shape");
  for (const LinearMode& mode : modes_) {
    if (mode.is_conjugate()) continue;
    char damping[16] = "-";
    if (!mode.is_zero()) std::snprintf(damping, sizeof damping, "%.6f", mode.damping());
    char value[64];
    const double imaginary = mode.eigenvalue.imag();
    std::snprintf(value, sizeof value, imaginary > 0.0 ? "%.6g +- %.6gi" : "%.6g", mode.eigenvalue.real(), imaginary);
    std::printf("%14.8g %10s %27s %9.1e  %s\n", mode.is_zero() ? 0.0 : mode.frequency(), damping, value, mode.error,
                participants(model_, mode.real).c_str());
  }
}

nlohmann::ordered_json Linear::reduced(std::int32_t what) const {
  LinearNumbers all;
  for (std::size_t i = 0; i < summary_.freedoms; ++i) all.shown.push_back(i);
  return json_of_linear_matrix(linearisation_.get(), what, all, summary_.freedoms, all, summary_.freedoms);
}

nlohmann::ordered_json Linear::to_json() const {
  nlohmann::ordered_json document;
  document["scene"] = model_.name(KOPPEL_KIND_SCENE, 0);
  document["time"] = options_.time;
  document["at"] = options_.at;
  document["diagnostics"] = json_of_findings(model_);
  if (outcome_ != Exit::fine) {
    document["diagnostics"].push_back(json_of(error_));
    document["error"] = json_of(error_);
    return document;
  }
  const std::size_t n = summary_.states, m = summary_.inputs, p = summary_.outputs;
  document["course"] = courses[summary_.course];
  document["drift"] = summary_.drift;
  document["freedoms"] = summary_.freedoms;
  document["states"] = json_of_numbers(states_);
  document["inputs"] = json_of_numbers(inputs_);
  document["outputs"] = json_of_numbers(outputs_);
  document["A"] = json_of_linear_matrix(linearisation_.get(), KOPPEL_MATRIX_A, states_, n, states_, n);
  document["B"] = json_of_linear_matrix(linearisation_.get(), KOPPEL_MATRIX_B, states_, n, inputs_, m);
  document["C"] = json_of_linear_matrix(linearisation_.get(), KOPPEL_MATRIX_C, outputs_, p, states_, n);
  document["D"] = json_of_linear_matrix(linearisation_.get(), KOPPEL_MATRIX_D, outputs_, p, inputs_, m);
  document["mass"] = reduced(KOPPEL_MATRIX_MASS);
  document["damping"] = reduced(KOPPEL_MATRIX_DAMPING);
  document["stiffness"] = reduced(KOPPEL_MATRIX_STIFFNESS);
  document["modes"] = nlohmann::ordered_json::array();
  for (const LinearMode& mode : modes_) document["modes"].push_back(json_of_mode(model_, mode));
  return document;
}

Exit linearise(const Options& options, bool verbose) {
  const Model model = load(options.scene, verbose);
  if (!model.mechanism) return refused(model, options.json, nullptr);
  if (!options.json) model.print_findings();
  Linear linear(model, options);
  const Exit outcome = linear.make();
  if (options.json) {
    print_json(linear.to_json());
  } else {
    linear.print();
  }
  return outcome;
}

}  // namespace

void add_linearise(CLI::App& app, const Common& common, Exit& outcome) {
  CLI::App* command = app.add_subcommand(
      "linearise", "Make the equations of motion linear about a position; eigenvalues, modes, and how exact they are");
  auto options = std::make_shared<Options>();
  command->add_option("SCENE", options->scene, "The scene file")->required()->check(not_empty)->type_name("");
  command->add_option("--time", options->time, "When; default: 0")->type_name("SECONDS");
  command->add_option("--at", options->at, "Where it rests (default), or as it starts, with its rates")
      ->check(CLI::IsMember({"equilibrium", "start"}))
      ->type_name("equilibrium|start");
  command->add_flag("--steady", options->steady, "At an equilibrium: let the drives go on with their rates");
  command
      ->add_option(
          "--inputs", options->inputs,
          "Coordinates: of a driven one value, rate and acceleration are inputs, of others an effort; default: "
          "all drives")
      ->delimiter(',')
      ->type_name("NAMES");
  command->add_option("--outputs", options->outputs, "Recorded columns; default: all")
      ->delimiter(',')
      ->type_name("NAMES");
  command->add_flag("--json", options->json, "Print everything as JSON, matrices too");
  command->callback([options, &common, &outcome] { outcome = linearise(*options, common.verbose); });
}

}  // namespace koppel::app
