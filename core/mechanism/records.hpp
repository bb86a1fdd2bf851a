// The recorded outputs of a scene.
#pragma once

#include "mechanism/kinematics.hpp"
#include "mechanism/mechanism.hpp"
#include "mechanism/state.hpp"

namespace koppel {

/// One number for each of mechanism.record_columns. After forward_motion at the state.
void evaluate_records(const Mechanism& mechanism, const State& state, const Kinematics& kinematics, double* values);

}  // namespace koppel
