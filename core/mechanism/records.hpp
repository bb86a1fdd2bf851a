// The recorded outputs of a scene.
#pragma once

#include "mechanism/kinematics.hpp"
#include "mechanism/loads.hpp"
#include "mechanism/mechanism.hpp"
#include "mechanism/state.hpp"

namespace koppel {

/// One number for each of mechanism.record_columns. After forward_motion at the state. loads: at the state; null if
/// Mechanism::records_loads is false.
void evaluate_records(const Mechanism& mechanism, const State& state, const Kinematics& kinematics, const Loads* loads,
                      double* values);

}  // namespace koppel
