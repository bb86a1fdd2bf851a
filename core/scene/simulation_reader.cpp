// [simulation]: how accurate, or in which steps.
#include "scene/reading.hpp"

namespace koppel {

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
  table.finish();
}

}  // namespace koppel
