// [simulation]: by which integrator and formulation, how accurate, or in which steps.
#include "scene/formulations.hpp"
#include "scene/integrators.hpp"
#include "scene/reading.hpp"

namespace koppel {
namespace {

const IntegratorName* read_integrator(TableReader& table, SimulationDescription& simulation) {
  const Node* node = table.find("integrator");
  if (node == nullptr) return nullptr;
  const auto name = table.values().text(*node, "`integrator`");
  if (!name) return nullptr;
  const IntegratorName* integrator = find_integrator(*name);
  if (integrator == nullptr) {
    table.report().error(Code::unknown_integrator, node->place, no_such_integrator(*name), integrator_choices(*name));
    return nullptr;
  }
  simulation.integrator = *name;
  return integrator;
}

const FormulationName* read_formulation(TableReader& table, SimulationDescription& simulation) {
  const Node* node = table.find("formulation");
  if (node == nullptr) return nullptr;
  const auto name = table.values().text(*node, "`formulation`");
  if (!name) return nullptr;
  const FormulationName* formulation = find_formulation(*name);
  if (formulation == nullptr) {
    table.report().error(Code::unknown_formulation, node->place, no_such_formulation(*name), formulation_choices());
    return nullptr;
  }
  simulation.formulation = *name;
  return formulation;
}

/// Integrator, formulation and `step` must go together.
void read_method(TableReader& table, SimulationDescription& simulation) {
  const IntegratorName* integrator = read_integrator(table, simulation);
  const FormulationName* formulation = read_formulation(table, simulation);
  std::string_view key = "integrator";
  if (integrator != nullptr && formulation != nullptr) {
    if (const auto found = clash(*integrator, *formulation)) {
      table.report().error(Code::conflicting_keys, table.find("formulation")->place,
                           "the integrator `" + std::string(integrator->name) + "` " + found->why, found->advice);
      return;
    }
  } else if (integrator == nullptr && formulation != nullptr && formulation->integrator) {
    integrator = &integrators()[static_cast<std::size_t>(*formulation->integrator)];
    key = "formulation";
  }
  if (integrator == nullptr) return;
  const std::string name(integrator->name);
  const bool takes_step = integrator->control == StepControl::step;
  if (takes_step && table.find("step") == nullptr) {
    table.report().error(Code::missing_key, table.find(key)->place,
                         "`" + name + "` takes fixed steps, and there is no `step`", "give `step`, for example '1 ms'");
  }
  if (!takes_step && table.find("step") != nullptr) {
    table.report().error(Code::conflicting_keys, table.place_of("step"),
                         "`" + name + "` adapts its steps and takes no `step`", "give `tolerance` instead");
  }
}

}  // namespace

void read_simulation(Reading& reading, Scope& scope, Scene& scene) {
  const Node* node = scope.document->root().find("simulation");
  if (node == nullptr) return;
  const ValueReader values = reading.values(scope, "simulation");
  if (!node->is_table()) return values.wrong_kind(*node, "[simulation]", "a table");
  TableReader table(*node, values);
  SimulationDescription& simulation = scene.simulation;
  if (const Node* tolerance = table.find("tolerance")) {
    simulation.tolerance = values.positive(*tolerance, "`tolerance`");
    if (simulation.tolerance.value_or(0.0) >= 1.0) {
      table.report().error(Code::out_of_range, tolerance->place,
                           "`tolerance` must be less than 1, and is " + number_text(*simulation.tolerance),
                           "it is relative: 1e-6 asks for about six digits in each step");
    }
  }
  if (const Node* step = table.find("step")) simulation.step = values.positive(*step, "`step`", "s");
  read_method(table, simulation);
  table.finish();
}

}  // namespace koppel
