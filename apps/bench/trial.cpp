#include "bench/trial.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "bench/rounds.hpp"

namespace koppel::app::bench {
namespace {

/// Where a name stands.
struct Place {
  std::int32_t kind = 0;
  std::size_t index = 0;
};

Place place_of(const Model& model, const std::string& name) {
  Place place;
  for (const std::int32_t kind : {KOPPEL_KIND_COORDINATE, KOPPEL_KIND_RATE, KOPPEL_KIND_RECORD}) {
    if (koppel_mechanism_find(model.mechanism.get(), kind, name.c_str(), &place.index, nullptr) == KOPPEL_OK) {
      place.kind = kind;
      break;
    }
  }
  return place;
}

koppel_simulation_options options_of(const Setting& setting, double end) {
  auto options = sized<koppel_simulation_options>();
  (setting.method.steps ? options.step : options.tolerance) = setting.value;
  options.integrator = setting.method.integrator;
  options.formulation = setting.method.formulation;
  options.end = end;
  return options;
}

/// What koppel itself finds at two higher accuracies; the finer one counts, the difference is its uncertainty.
Reference computed(Trial& trial) {
  constexpr double coarse = 1e-12, fine = 1e-13;
  Reference reference;
  reference.names = trial.model().names(KOPPEL_KIND_COORDINATE, trial.model().sizes().coordinates);
  reference.source = "koppel at tolerances 1e-12 and 1e-13, as far as they agree";
  reference.uncertainty = not_a_number;
  if (std::isnan(trial.run({dormand_prince, coarse}))) return reference;
  reference.values = trial.values(reference.names);
  if (std::isnan(trial.run({dormand_prince, fine}))) return reference;
  reference.uncertainty = error_of(trial, reference);
  reference.values = trial.values(reference.names);
  return reference;
}

}  // namespace

Trial::Trial(Model model, double end) : model_(std::move(model)), end_(end) {
  if (model_.outcome != Exit::fine) {
    problem_ = model_.error.message;
    return;
  }
  start_ = start(model_);
  moved_ = start(model_);
  if (!start_.state || !moved_.state || !start_.work || !moved_.work) {
    problem_ = "out of memory";
    return;
  }
  auto report = sized<koppel_report>();
  good(koppel_close(start_.state.get(), start_.work.get(), nullptr, &report, &error_));
}

bool Trial::good(koppel_status status) {
  if (status < 0) problem_ = error_.message;
  return status >= 0;
}

Simulation Trial::ready(const Setting& setting) {
  problem_.clear();
  const koppel_simulation_options options = options_of(setting, end_);
  koppel_simulation* made = nullptr;
  if (!good(koppel_state_copy(start_.state.get(), moved_.state.get()))) return nullptr;
  if (!good(koppel_simulation_create(moved_.state.get(), &options, &made, &error_))) return nullptr;
  return Simulation(made);
}

double Trial::run(const Setting& setting) {
  const Stopwatch watch;
  const Simulation simulation = ready(setting);
  if (!simulation) return not_a_number;
  if (!good(koppel_simulation_advance(simulation.get(), end_, moved_.state.get(), &error_))) return not_a_number;
  const double seconds = watch.seconds();
  koppel_simulation_summarise(simulation.get(), &summary_);
  return seconds;
}

double Trial::scale(const std::string& name) const {
  const Place place = place_of(model_, name);
  const std::string unit = place.kind == 0 ? "" : model_.unit(place.kind, place.index);
  return unit == "m" || unit == "m/s" ? model_.settings().length : 1.0;
}

std::vector<double> Trial::values(const std::vector<std::string>& names) {
  const koppel_sizes sizes = model_.sizes();
  std::vector<double> q(sizes.coordinates), v(sizes.rates), records(sizes.records), values;
  koppel_state_get(moved_.state.get(), KOPPEL_Q, q.data(), q.size());
  koppel_state_get(moved_.state.get(), KOPPEL_V, v.data(), v.size());
  koppel_records(moved_.state.get(), moved_.work.get(), records.data(), records.size());
  for (const std::string& name : names) {
    const Place place = place_of(model_, name);
    const double value = place.kind == KOPPEL_KIND_COORDINATE ? q[place.index]
                         : place.kind == KOPPEL_KIND_RATE     ? v[place.index]
                         : place.kind == KOPPEL_KIND_RECORD   ? records[place.index]
                                                              : not_a_number;
    values.push_back(value / scale(name));
  }
  return values;
}

Reference reference_of(const Problem& problem, Trial& trial) {
  if (problem.digits.empty()) return computed(trial);
  Reference reference;
  reference.source = problem.source;
  double greatest = 0.0;
  for (const Digit& digit : problem.digits) {
    reference.names.push_back(digit.name);
    reference.values.push_back(digit.value / trial.scale(digit.name));
    greatest = std::max(greatest, std::abs(reference.values.back()));
  }
  reference.uncertainty = problem.uncertainty + 0.5 * std::numeric_limits<double>::epsilon() * greatest;
  return reference;
}

double error_of(Trial& trial, const Reference& reference) {
  const std::vector<double> values = trial.values(reference.names);
  double error = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double off = std::abs(values[i] - reference.values[i]);
    if (!(off <= error)) error = off;  // what is not a number counts as worst
  }
  return error;
}

}  // namespace koppel::app::bench
