// How a simulation integrates: what the caller asks for, else what the scene says, else what suits most.
#pragma once

#include <string_view>

#include "base/error.hpp"
#include "scene/formulations.hpp"
#include "scene/integrators.hpp"
#include "scene/scene.hpp"

namespace koppel {

struct SimulationOptions {
  Formulation formulation = Formulation::minimal;
  IntegratorKind integrator = IntegratorKind::dormand_prince;
  double tolerance = 1e-8;  ///< of one step: radians, lengths over the scene's, their rates per second; 0: fixed steps
  double step = 0.0;        ///< [s] of fixed steps; 0: by the tolerance
  double end = 0.0;         ///< [s] where the last step shall end
};

/// Options but for the end. formulation, integrator: empty: not asked for; tolerance and step: 0: not asked for. What
/// is asked for goes before what the scene says, also where that does not go with it. Errors: unknown_formulation,
/// unknown_integrator; conflicting_keys, if the integrator takes steps by a tolerance and a step is asked for;
/// missing_key, if it takes a step and there is none.
Result<SimulationOptions> simulation_options(std::string_view formulation, std::string_view integrator,
                                             double tolerance, double step, const SimulationDescription& scene);

}  // namespace koppel
