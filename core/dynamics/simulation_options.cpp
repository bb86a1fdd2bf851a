#include "dynamics/simulation_options.hpp"

#include <string>

namespace koppel {
namespace {

constexpr double default_tolerance = 1e-8;

/// The formulation that is asked for; null: none is.
Result<const FormulationName*> choose_formulation(std::string_view name) {
  const FormulationName* asked = find_formulation(name);
  if (name.empty() || asked != nullptr) return asked;
  std::string list;
  for (const FormulationName& x : formulations()) list += (list.empty() ? "" : ", ") + std::string(x.name);
  return tl::make_unexpected(make_error(Code::unknown_formulation, {},
                                        "there is no formulation `" + std::string(name) + "`", "there are: " + list));
}

bool solves(const IntegratorName& integrator, const FormulationName& formulation) {
  return formulation.integrator ? formulation.integrator == integrator.kind
                                : !formulation_for(integrator.kind).integrator;
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
                    (formulation == nullptr || solves(*described, *formulation));
  return fits ? described : &default_integrator(control);
}

Result<void> check(const IntegratorName& integrator, const FormulationName& formulation) {
  const std::string element = "integrator " + std::string(integrator.name);
  if (!solves(integrator, formulation)) {
    const std::string_view other = formulation.integrator
                                       ? integrators()[static_cast<std::size_t>(*formulation.integrator)].name
                                       : default_integrator(integrator.control).name;
    return tl::make_unexpected(make_error(Code::conflicting_keys, element,
                                          "does not solve the formulation " + std::string(formulation.name),
                                          "take the formulation " + std::string(formulation_for(integrator.kind).name) +
                                              ", or the integrator " + std::string(other)));
  }
  if (formulation.kind == Formulation::projected && integrator.kind == IntegratorKind::cvode) {
    return tl::make_unexpected(make_error(Code::conflicting_keys, element,
                                          "goes on from what it remembers, not from what is projected",
                                          "take the formulation minimal or baumgarte"));
  }
  return {};
}

}  // namespace

Result<SimulationOptions> simulation_options(std::string_view formulation, std::string_view integrator,
                                             double tolerance, double step, const SimulationDescription& scene) {
  KOPPEL_TRY(const FormulationName* asked, choose_formulation(formulation));
  KOPPEL_TRY(const IntegratorName* chosen, choose(asked, integrator, tolerance, step, scene));
  const FormulationName& way = asked != nullptr ? *asked : formulation_for(chosen->kind);
  KOPPEL_CHECK(check(*chosen, way));
  SimulationOptions options;
  options.integrator = chosen->kind;
  options.formulation = way.kind;
  const std::string element = "integrator " + std::string(chosen->name);
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
