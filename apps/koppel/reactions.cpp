// koppel reactions SCENE
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "koppel/command.hpp"
#include "koppel/text_table.hpp"

namespace koppel::app {
namespace {

struct Options {
  std::string scene;
  double time = 0.0;
  bool json = false;
};

/// What joints and drives bear at a time, or why it is not known.
struct Bearing {
  koppel_status status = KOPPEL_OK;
  koppel_error error = sized<koppel_error>();
  std::vector<double> wrenches, efforts;
  std::vector<std::uint8_t> determined;
};

/// Closes the mechanism at time 0 and lets forces and drives move it to the time.
koppel_status move_to(const Motion& motion, double time, koppel_error* error) {
  koppel_state* state = motion.state.get();
  auto report = sized<koppel_report>();
  koppel_status status = koppel_close(state, motion.work.get(), nullptr, &report, error);
  if (status < 0) return status;
  auto options = sized<koppel_simulation_options>();
  options.end = time;
  koppel_simulation* made = nullptr;
  status = koppel_simulation_create(state, &options, &made, error);
  if (status < 0) return status;
  const Simulation simulation(made);
  return koppel_simulation_advance(made, time, state, error);
}

Bearing bearing(const Model& model, double time) {
  Bearing result;
  const Motion motion = start(model);
  if (!motion.state || !motion.work) {
    result.status = KOPPEL_NO_MEMORY;
    return result;
  }
  result.status = move_to(motion, time, &result.error);
  if (result.status < 0) return result;
  result.wrenches.resize(std::size_t{6} * model.sizes().joints);
  result.efforts.resize(model.sizes().rates);
  result.determined.resize(result.wrenches.size() + result.efforts.size());
  result.status =
      koppel_reactions(motion.state.get(), motion.work.get(), result.wrenches.data(), result.wrenches.size(),
                       result.efforts.data(), result.efforts.size(), result.determined.data(), &result.error);
  return result;
}

std::string cell(double value, bool determined) {
  char text[32];
  std::snprintf(text, sizeof text, "%s%.6g", determined ? "" : "~", value);
  return text;
}

/// Wrenches are [moment; force]; forces come first in what is shown.
constexpr std::array<std::size_t, 6> shown = {3, 4, 5, 0, 1, 2};
constexpr std::array<const char*, 6> headings = {"force x [N]", "y", "z", "moment x [N m]", "y", "z"};

double greatest_of(const std::vector<double>& values) {
  double greatest = 0.0;
  for (const double value : values) greatest = std::max(greatest, std::abs(value));
  return greatest;
}

/// With zeros for what is but rounding beside the greatest load.
std::vector<double> without_rounding(std::vector<double> values, double greatest) {
  for (double& value : values) {
    if (std::abs(value) <= 1e-12 * greatest) value = 0.0;
  }
  return values;
}

void print(const Model& model, const Options& options, const Bearing& bearing) {
  const std::size_t joints = model.sizes().joints;
  std::printf("%s at t = %g s\n\n", model.name(KOPPEL_KIND_SCENE, 0).c_str(), options.time);
  std::vector<std::vector<std::string>> table{{"joint"}};
  for (std::size_t i = 0; i < joints; ++i) table[0].push_back(model.name(KOPPEL_KIND_JOINT, i));
  const double greatest = std::max(greatest_of(bearing.wrenches), greatest_of(bearing.efforts));
  const std::vector<double> wrenches = without_rounding(bearing.wrenches, greatest);
  for (std::size_t k = 0; k < shown.size(); ++k) {
    std::vector<std::string> column{headings[k]};
    for (std::size_t i = 0; i < joints; ++i) {
      const std::size_t at = 6 * i + shown[k];
      column.push_back(cell(wrenches[at], bearing.determined[at] != 0));
    }
    table.push_back(std::move(column));
  }
  print_table(table);
  const std::vector<std::string> inputs = model.names(KOPPEL_KIND_INPUT, model.sizes().inputs);
  std::vector<std::vector<std::string>> efforts{{"effort"}, {""}, {""}};
  const std::vector<double> values = without_rounding(bearing.efforts, greatest);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string name = model.name(KOPPEL_KIND_RATE, i);
    if (values[i] == 0.0 && std::find(inputs.begin(), inputs.end(), name) == inputs.end()) continue;
    efforts[0].push_back(name);
    efforts[1].push_back(cell(values[i], bearing.determined[wrenches.size() + i] != 0));
    efforts[2].emplace_back(model.unit(KOPPEL_KIND_RATE, i) == "m/s" ? "N" : "N m");
  }
  std::puts("");
  if (efforts[0].size() > 1) {
    print_table(efforts);
    std::puts("");
  }
  std::puts("What each joint puts on the body at its outlet, in the axes and about the origin of its outlet frame.");
  if (std::any_of(bearing.determined.begin(), bearing.determined.end(), [](std::uint8_t is) { return is == 0; })) {
    std::puts("~ is not determined by the motion: of all loads that fit, the least are shown.");
  }
}

nlohmann::ordered_json to_json(const Model& model, const Options& options, const Bearing& bearing) {
  nlohmann::ordered_json document;
  document["scene"] = model.name(KOPPEL_KIND_SCENE, 0);
  document["time"] = options.time;
  document["found"] = bearing.status >= 0;
  auto joints = nlohmann::ordered_json::array();
  for (std::size_t i = 0; 6 * i < bearing.wrenches.size(); ++i) {
    const auto three = [&](const auto& from, std::size_t first) {
      const auto begin = from.begin() + static_cast<std::ptrdiff_t>(6 * i + first);
      return nlohmann::ordered_json(std::vector<double>(begin, begin + 3));
    };
    const auto known = [&](std::size_t first) {
      auto list = nlohmann::ordered_json::array();
      for (std::size_t k = 0; k < 3; ++k) list.push_back(bearing.determined[6 * i + first + k] != 0);
      return list;
    };
    joints.push_back({{"name", model.name(KOPPEL_KIND_JOINT, i)},
                      {"force", three(bearing.wrenches, 3)},
                      {"moment", three(bearing.wrenches, 0)},
                      {"determined", {{"force", known(3)}, {"moment", known(0)}}}});
  }
  document["joints"] = std::move(joints);
  auto efforts = nlohmann::ordered_json::object();
  auto determined = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < bearing.efforts.size(); ++i) {
    const std::string name = model.name(KOPPEL_KIND_RATE, i);
    efforts[name] = bearing.efforts[i];
    determined[name] = bearing.determined[bearing.wrenches.size() + i] != 0;
  }
  document["efforts"] = std::move(efforts);
  document["efforts_determined"] = std::move(determined);
  document["diagnostics"] = json_of_findings(model);
  if (bearing.status < 0) {
    document["diagnostics"].push_back(json_of(bearing.error));
    document["error"] = json_of(bearing.error);
  }
  return document;
}

Exit reactions(const Options& options, bool verbose) {
  const Model model = load(options.scene, verbose);
  if (!model.mechanism) return refused(model, options.json, "found");
  const Bearing found = bearing(model, options.time);
  if (options.json) {
    print_json(to_json(model, options, found));
  } else {
    model.print_findings();
    if (found.status < 0) {
      print_error(found.error);
    } else {
      print(model, options, found);
    }
  }
  return found.status < 0 ? exit_of(found.status) : Exit::fine;
}

}  // namespace

void add_reactions(CLI::App& app, const Common& common, Exit& outcome) {
  CLI::App* command = app.add_subcommand(
      "reactions", "What every joint and drive bears: forces, moments, efforts, and which of them are not determined");
  auto options = std::make_shared<Options>();
  command->add_option("SCENE", options->scene, "The scene file")->required()->check(not_empty)->type_name("");
  command->add_option("--time", options->time, "When, after forces and drives have moved it from t = 0; default: 0")
      ->check(CLI::Range(0.0, 1e9))
      ->type_name("SECONDS");
  command->add_flag("--json", options->json, "Print the result as JSON");
  command->callback([options, &common, &outcome] { outcome = reactions(*options, common.verbose); });
}

}  // namespace koppel::app
