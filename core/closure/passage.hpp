// The way from a closed state to what its inputs ask for, past singular positions: slower than a step of Newton's
// method, and sure of its branch.
#pragma once

#include <Eigen/Core>

#include "closure/branch.hpp"
#include "closure/report.hpp"
#include "closure/work.hpp"
#include "koppel/plugin.h"
#include "mechanism/state.hpp"

namespace koppel {

enum class PassageEnd { arrived, limit, lost, plugin_failed };

/// From the position in the state's q, closed at its history's time, to its inputs and time: along the drives where
/// they lead from one to the other, else straight. Arrived: work.q is closed for the inputs; where only the branch
/// tells its rates, work.branch_rates has them. The report gets the limit, or the change points that were passed.
PassageEnd pass(Work& work, const State& state, Branch branch, Report& report);

/// From a closed state whose inputs are where its drives are, along its curve, past limits, by a duration of a path
/// parameter that runs with the arc length times `speed` (0: as fast as the drives at time 0). Position, rates and
/// accelerations by that parameter, and the time of the drives are then those at the end. KOPPEL_INVALID_ARGUMENT: not
/// such a state, or some constraint depends on time; KOPPEL_NOT_CLOSED: lost; the state is then untouched.
koppel_status follow(Work& work, State& state, double duration, double speed, Branch branch, Report& report);

}  // namespace koppel
