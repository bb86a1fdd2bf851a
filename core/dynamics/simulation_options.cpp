#include "dynamics/simulation_options.hpp"

#include <string>

namespace koppel {
namespace {

constexpr double default_tolerance = 1e-8;

/// The formulation that is asked for, or the scene's where it goes with what else is asked for; null: neither.
Result<const FormulationName*> choose_formulation(std::string_view name, std::string_view integrator, double tolerance,
                                                  double step, const SimulationDescription& scene) {
  if (!name.empty()) {
    if (const FormulationName* asked = find_formulation(name)) return asked;
    return tl::make_unexpected(
        make_error(Code::unknown_formulation, {}, no_such_formulation(name), formulation_choices()));
  }
  const FormulationName* described = find_formulation(scene.formulation);
  if (described == nullptr) return described;
  const IntegratorName* asked = find_integrator(integrator);
  if (asked != nullptr) return clash(*asked, *described) ? nullptr : described;
  if (!described->integrator) return described;
  const StepControl control = integrators()[static_cast<std::size_t>(*described->integrator)].control;
  const bool other = control == StepControl::tolerance ? step > 0.0 : tolerance > 0.0;
  return other ? nullptr : described;
}

/// The integrator that is asked for, or the scene's where it goes with what is asked for, or the default one.
Result<const IntegratorName*> choose(const FormulationName* formulation, std::string_view integrator, double tolerance,
                                     double step, const SimulationDescription& scene) {
  if (!integrator.empty()) {
    const IntegratorName* asked = find_integrator(integrator);
    if (asked != nullptr) return asked;
    return tl::make_unexpected(
        make_error(Code::unknown_integrator, {}, no_such_integrator(integrator), integrator_choices(integrator)));
  }
  if (formulation != nullptr && formulation->integrator) {
    return &integrators()[static_cast<std::size_t>(*formulation->integrator)];
  }
  const bool steps = step > 0.0 || (tolerance == 0.0 && scene.step);
  const StepControl control = steps ? StepControl::step : StepControl::tolerance;
  const IntegratorName* described = find_integrator(scene.integrator);
  const bool fits = described != nullptr && described->control == control &&
                    (formulation == nullptr || !clash(*described, *formulation));
  return fits ? described : &default_integrator(control);
}

}  // namespace

Result<SimulationOptions> simulation_options(std::string_view formulation, std::string_view integrator,
                                             double tolerance, double step, const SimulationDescription& scene) {
  KOPPEL_TRY(const FormulationName* asked, choose_formulation(formulation, integrator, tolerance, step, scene));
  KOPPEL_TRY(const IntegratorName* chosen, choose(asked, integrator, tolerance, step, scene));
  const FormulationName& way = asked != nullptr ? *asked : formulation_for(chosen->kind);
  const std::string element = "integrator " + std::string(chosen->name);
  if (const auto found = clash(*chosen, way)) {
    return tl::make_unexpected(make_error(Code::conflicting_keys, element, found->why, found->advice));
  }
  SimulationOptions options;
  options.integrator = chosen->kind;
  options.formulation = way.kind;
  if (chosen->control == StepControl::tolerance) {
    if (step > 0.0) {
      return tl::make_unexpected(make_error(Code::conflicting_keys, element, "adapts its steps to a tolerance",
                                            "give a tolerance instead of a step"));
    }
    options.tolerance = tolerance > 0.0 ? tolerance : scene.tolerance.value_or(default_tolerance);
    return options;
  }
  options.tolerance = 0.0;
  options.step = step > 0.0 ? step : scene.step.value_or(0.0);
  if (options.step > 0.0) return options;
  return tl::make_unexpected(
      make_error(Code::missing_key, element, "takes steps of a fixed length, and none is given", "give a step"));
}

}  // namespace koppel
