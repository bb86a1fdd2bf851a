// The recorded outputs of a scene.
#pragma once

#include <optional>

#include "mechanism/kinematics.hpp"
#include "mechanism/loads.hpp"
#include "mechanism/mechanism.hpp"
#include "mechanism/state.hpp"

namespace koppel {

/// The numbers of those records that are derivatives by this coordinate, or by none, that is by time; values has one
/// for each of mechanism.record_columns, and the others stay as they are. After forward_motion at the state. loads: at
/// the state; null if Mechanism::records_loads is false. An axis that is infinitely far, or not there, is not a number.
void evaluate_records(const Mechanism& mechanism, const State& state, const Kinematics& kinematics, const Loads* loads,
                      const std::optional<CoordinateReference>& by, double* values);

}  // namespace koppel
