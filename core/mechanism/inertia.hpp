// Mass properties of a body, asked from its plugin only when somebody needs them.
#pragma once

#include "base/error.hpp"
#include "base/id.hpp"
#include "mechanism/mechanism.hpp"

namespace koppel {

/// Mass, centre and inertia about the body frame's origin. The ground has none: all zero. Errors: instance_refused,
/// plugin_misbehaved (negative mass, not finite).
Result<koppel_inertia> body_inertia(const Mechanism& mechanism, BodyId body);

}  // namespace koppel
