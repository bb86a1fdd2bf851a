// The recorded outputs of a closed mechanism, transfer functions among them.
#pragma once

#include "closure/work.hpp"
#include "koppel/plugin.h"
#include "mechanism/loads.hpp"
#include "mechanism/state.hpp"

namespace koppel {

/// One number for each of mechanism.record_columns, by the rates and accelerations that the state has; derivatives by
/// a drive instead of time (K-II-3.5.1b, K-II-3.6.1: transfer functions) with the other drives at rest, and not numbers
/// where the drive cannot move. loads: as for evaluate_records(). KOPPEL_PLUGIN; KOPPEL_INVALID_ARGUMENT: the state is
/// not closed, which such derivatives need.
koppel_status evaluate_recording(Work& work, const State& state, const Loads* loads, double* values);

}  // namespace koppel
