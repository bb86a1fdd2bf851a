#include "dynamics/simulation_options.hpp"

#include <string>

namespace koppel {
namespace {

constexpr double default_tolerance = 1e-8;

/// The integrator that is asked for, or the scene's where it goes with what is asked for, or the default one.
Result<const IntegratorName*> choose(std::string_view integrator, double tolerance, double step,
                                     const SimulationDescription& scene) {
  if (!integrator.empty()) {
    const IntegratorName* asked = find_integrator(integrator);
    if (asked != nullptr) return asked;
    return tl::make_unexpected(
        make_error(Code::unknown_integrator, {}, no_such_integrator(integrator), integrator_choices(integrator)));
  }
  const bool steps = step > 0.0 || (tolerance == 0.0 && scene.step);
  const StepControl control = steps ? StepControl::step : StepControl::tolerance;
  const IntegratorName* described = find_integrator(scene.integrator);
  return described != nullptr && described->control == control ? described : &default_integrator(control);
}

Result<Formulation> choose_formulation(std::string_view name) {
  if (name.empty()) return formulations().front().kind;
  if (const FormulationName* asked = find_formulation(name)) return asked->kind;
  std::string list;
  for (const FormulationName& x : formulations()) list += (list.empty() ? "" : ", ") + std::string(x.name);
  return tl::make_unexpected(make_error(Code::unknown_formulation, {},
                                        "there is no formulation `" + std::string(name) + "`", "there are: " + list));
}

}  // namespace

Result<SimulationOptions> simulation_options(std::string_view formulation, std::string_view integrator,
                                             double tolerance, double step, const SimulationDescription& scene) {
  KOPPEL_TRY(const IntegratorName* chosen, choose(integrator, tolerance, step, scene));
  SimulationOptions options;
  options.integrator = chosen->kind;
  KOPPEL_TRY(options.formulation, choose_formulation(formulation));
  if (options.formulation == Formulation::projected && options.integrator == IntegratorKind::cvode) {
    return tl::make_unexpected(make_error(Code::conflicting_keys, "integrator cvode",
                                          "goes on from what it remembers, not from what is projected",
                                          "take the formulation minimal or baumgarte"));
  }
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
