// The way from a closed state to what its inputs ask for, past singular positions: slower than a step of Newton's
// method, and sure of its branch.
#pragma once

#include <Eigen/Core>

#include "closure/branch.hpp"
#include "closure/report.hpp"
#include "closure/work.hpp"
#include "mechanism/state.hpp"

namespace koppel {

enum class PassageEnd { arrived, limit, lost, plugin_failed };

/// From the position in the state's q, closed at its history's time, to its inputs and time: along the drives where
/// they lead from one to the other, else straight. Arrived: work.q is closed for the inputs; where only the branch
/// tells its rates, work.branch_rates has them. The report gets the limit, or the change points that were passed.
PassageEnd pass(Work& work, const State& state, Branch branch, Report& report);

}  // namespace koppel
