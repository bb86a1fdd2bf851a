// koppel equilibrium SCENE
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "koppel/at_start.hpp"
#include "koppel/command.hpp"
#include "koppel/resting.hpp"
#include "koppel/text_table.hpp"

namespace koppel::app {
namespace {

struct Options {
  std::string scene;
  double time = 0.0;
  bool steady = false, nearest = false, json = false;
};

std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

const char* const holdings[] = {"unstable", "indifferent", "stable"};

/// Where one scene rests.
class Rest {
 public:
  Rest(const Model& model, const Options& options) : model_(model), options_(options), motion_(start(model)) {}

  Exit find() {
    if (!good(close_at(motion_, options_.time, error_))) return outcome_;
    start_ = coordinates();
    auto how = sized<koppel_equilibrium_options>();
    how.drives = options_.steady ? KOPPEL_DRIVES_MOVING : KOPPEL_DRIVES_HELD;
    how.search = options_.nearest ? KOPPEL_SEARCH_NEAREST : KOPPEL_SEARCH_SETTLE;
    koppel_equilibrium* equilibrium = nullptr;
    if (!good(koppel_equilibrium_find(motion_.state.get(), &how, &equilibrium, &error_))) return outcome_;
    equilibrium_.reset(equilibrium);
    koppel_equilibrium_summarise(equilibrium, &summary_);
    koppel_equilibrium_take(equilibrium, motion_.state.get());
    if (summary_.found == 0) not_found();
    return outcome_;
  }

  bool ended() const { return equilibrium_ != nullptr; }
  void print() const;
  nlohmann::ordered_json to_json() const;

 private:
  static constexpr double noticeable = 1e-9;

  bool good(koppel_status status) {
    if (status >= 0) return true;
    outcome_ = exit_of(status);
    return false;
  }

  void not_found() {
    outcome_ = Exit::not_closed;
    error_ = no_rest(model_, equilibrium_.get());
  }

  /// In steady motion the other coordinates stand while the drives move.
  bool steady() const { return summary_.unrest <= noticeable; }
  std::vector<double> coordinates() const {
    std::vector<double> q(model_.sizes().coordinates);
    koppel_state_get(motion_.state.get(), KOPPEL_Q, q.data(), q.size());
    return q;
  }
  std::vector<double> direction(std::size_t i, double& stiffness) const {
    std::vector<double> rates(model_.sizes().rates);
    koppel_equilibrium_direction(equilibrium_.get(), i, &stiffness, rates.data(), rates.size());
    return rates;
  }
  const char* holding(std::size_t i) const {
    return holdings[i < summary_.unstable ? 0 : i < summary_.unstable + summary_.indifferent ? 1 : 2];
  }
  nlohmann::ordered_json stiffness() const;

  const Model& model_;
  const Options& options_;
  Motion motion_;
  Equilibrium equilibrium_;
  std::vector<double> start_;
  koppel_equilibrium_summary summary_ = sized<koppel_equilibrium_summary>();
  koppel_error error_ = sized<koppel_error>();
  Exit outcome_ = Exit::fine;
};

void Rest::print() const {
  if (outcome_ != Exit::fine) print_error(error_);
  if (!ended()) return;
  const auto rate = [&](std::size_t i) { return model_.name(KOPPEL_KIND_RATE, i); };
  const std::string name = model_.name(KOPPEL_KIND_SCENE, 0);
  if (summary_.found == 0) {
    std::printf("%s: no rest found in %u iterations; this is where it got to\n", name.c_str(), summary_.iterations);
  } else {
    std::printf("%s: %s, %s, after %u iterations\n", name.c_str(), options_.steady ? "goes on steadily" : "rests",
                summary_.unstable > 0      ? "unstable"
                : summary_.indifferent > 0 ? "indifferent"
                                           : "stable",
                summary_.iterations);
  }
  if (summary_.freedoms > 0) {
    std::printf("force       %.3g %s left along %s, %.2g of the size of the forces\n", summary_.force,
                model_.unit(KOPPEL_KIND_RATE, summary_.worst) == "m/s" ? "N" : "N m", rate(summary_.worst).c_str(),
                summary_.residual);
  }
  std::printf("error       %.2g of a coordinate [rad, lengths of the scene], by the force left\n",
              summary_.coordinate_error);
  std::printf("energy      %.9g J, potential\n", summary_.energy);
  if (summary_.moved > 0.0) {
    std::printf("moved       %s most, by %.6g\n", rate(summary_.moved_most).c_str(), summary_.moved);
  }
  if (options_.steady && !steady()) {
    std::printf("not steady  beside the drives, coordinates move at up to %.3g 1/s\n", summary_.unrest);
  }
  if (summary_.found != 0) {
    std::printf("freedoms    %u: %u stable, %u unstable, %u indifferent; stiffness to %.2g J%s%s\n", summary_.freedoms,
                summary_.stable, summary_.unstable, summary_.indifferent, summary_.stiffness_error,
                summary_.circulatory != 0 ? "; not symmetric: see koppel linearise" : "",
                summary_.states_held != 0 ? "; internal states of forces held: see koppel linearise" : "");
    for (std::size_t i = 0; i < summary_.freedoms; ++i) {
      double value = 0.0;
      const std::vector<double> rates = direction(i, value);
      // Plus nothing: a zero without a sign.
      std::printf("  %12.6g J  %-11s  %s\n", value + 0.0, holding(i), participants(model_, rates).c_str());
    }
  }
  const std::vector<double> now = coordinates();
  std::vector<std::vector<std::string>> table{
      {"coordinate"}, {"start"}, {summary_.found != 0 ? "at rest" : "there"}, {""}};
  for (std::size_t i = 0; i < now.size(); ++i) {
    table[0].push_back(model_.name(KOPPEL_KIND_COORDINATE, i));
    table[1].push_back(digits(start_[i]));
    table[2].push_back(digits(now[i]));
    table[3].push_back(model_.unit(KOPPEL_KIND_COORDINATE, i));
  }
  print_table(table);
}

nlohmann::ordered_json Rest::stiffness() const {
  if (summary_.found == 0) return nullptr;
  const std::size_t n = summary_.freedoms;
  std::vector<std::uint32_t> independent(n);
  std::vector<double> values(n * n), errors(n * n);
  koppel_equilibrium_independent(equilibrium_.get(), independent.data(), n);
  koppel_equilibrium_stiffness(equilibrium_.get(), values.data(), errors.data(), n * n);
  nlohmann::ordered_json document;
  document["independent"] = nlohmann::ordered_json::array();
  for (const std::uint32_t i : independent) document["independent"].push_back(model_.name(KOPPEL_KIND_RATE, i));
  document["matrix"] = json_of_matrix(values, n, n);
  document["errors"] = json_of_matrix(errors, n, n);
  document["error"] = summary_.stiffness_error;
  document["symmetric"] = summary_.circulatory == 0;
  document["states_held"] = summary_.states_held != 0;
  document["directions"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < n; ++i) {
    double value = 0.0;
    const std::vector<double> rates = direction(i, value);
    auto along = nlohmann::ordered_json::object();
    for (std::size_t k = 0; k < rates.size(); ++k) along[model_.name(KOPPEL_KIND_RATE, k)] = rates[k];
    document["directions"].push_back({{"stiffness", value}, {"holding", holding(i)}, {"along", along}});
  }
  return document;
}

nlohmann::ordered_json Rest::to_json() const {
  nlohmann::ordered_json document;
  document["scene"] = model_.name(KOPPEL_KIND_SCENE, 0);
  document["time"] = options_.time;
  document["found"] = ended() && summary_.found != 0;
  document["stable"] = nullptr;
  if (ended()) {
    if (summary_.found != 0) document["stable"] = summary_.stable == summary_.freedoms;
    document["steady"] = options_.steady ? nlohmann::ordered_json(steady()) : nlohmann::ordered_json(nullptr);
    document["freedoms"] = summary_.freedoms;
    document["iterations"] = summary_.iterations;
    document["residual"] = summary_.residual;
    document["force"] = nullptr;
    if (summary_.freedoms > 0) {
      document["force"] = {{"along", model_.name(KOPPEL_KIND_RATE, summary_.worst)}, {"value", summary_.force}};
    }
    document["coordinate_error"] = summary_.coordinate_error;
    document["energy"] = summary_.energy;
    document["moved"] = {{"most", model_.name(KOPPEL_KIND_RATE, summary_.moved_most)}, {"by", summary_.moved}};
    auto places = nlohmann::ordered_json::object();
    const std::vector<double> now = coordinates();
    for (std::size_t i = 0; i < now.size(); ++i) places[model_.name(KOPPEL_KIND_COORDINATE, i)] = now[i];
    document["coordinates"] = std::move(places);
    document["stiffness"] = stiffness();
  }
  document["diagnostics"] = json_of_findings(model_);
  if (outcome_ != Exit::fine) {
    document["diagnostics"].push_back(json_of(error_));
    document["error"] = json_of(error_);
  }
  return document;
}

Exit equilibrium(const Options& options, bool verbose) {
  const Model model = load(options.scene, verbose);
  if (!model.mechanism) return refused(model, options.json, "found");
  if (!options.json) model.print_findings();
  Rest rest(model, options);
  const Exit outcome = rest.find();
  if (options.json) {
    print_json(rest.to_json());
  } else {
    rest.print();
  }
  return outcome;
}

}  // namespace

void add_equilibrium(CLI::App& app, const Common& common, Exit& outcome) {
  CLI::App* command = app.add_subcommand(
      "equilibrium", "Find where a scene rests under its forces while its drives hold; tell whether it stays there");
  auto options = std::make_shared<Options>();
  command->add_option("SCENE", options->scene, "The scene file")->required()->check(not_empty)->type_name("");
  command->add_option("--time", options->time, "When the drives hold; default: 0")->type_name("SECONDS");
  command->add_flag("--steady", options->steady, "Let the drives go on with their rates: what they do not move rests");
  command->add_flag("--nearest", options->nearest, "Go to the nearest balance of forces, be it stable or not");
  command->add_flag("--json", options->json, "Print everything as JSON");
  command->callback([options, &common, &outcome] { outcome = equilibrium(*options, common.verbose); });
}

}  // namespace koppel::app
