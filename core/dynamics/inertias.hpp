// Mass properties of all nodes, asked from the bodies' plugins when dynamics is asked for.
#pragma once

#include <memory>
#include <vector>

#include "base/error.hpp"
#include "mechanism/mechanism.hpp"
#include "spatial/spatial_inertia.hpp"

namespace koppel {

struct Inertias {
  std::vector<SpatialInertia>
      of_node;                 ///< in the node's axes, centre from its origin; none of ground and second halves
  std::vector<bool> has_mass;  ///< by node: mass or moments of inertia
  double mass = 0.0;           ///< [kg] of all
};

/// Errors: those of body_inertia().
Result<Inertias> inertias(const Mechanism& mechanism);

}  // namespace koppel
