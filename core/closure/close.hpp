// Closing, moving and differentiating a mechanism.
#pragma once

#include <cstdint>

#include "closure/branch.hpp"
#include "closure/report.hpp"
#include "closure/work.hpp"
#include "koppel/plugin.h"
#include "mechanism/state.hpp"

namespace koppel {

enum class Method { automatic, newton, ceres, flow };

struct CloseOptions {
  Method method = Method::automatic;
  std::uint32_t max_iterations = 0;  ///< 0: 50 for Newton, 500 for Ceres; of the flow there are none
  double tolerance = 0.0;            ///< 0: down to rounding
  Branch branch = Branch::stay;
};

/// Closes the loops with the inputs held at the state's values. A state that was closed before is followed from there,
/// by closed forms in the order of the mechanism's flow if it has such and is not near a singular position (then with
/// the rates and accelerations of its inputs), else in smaller steps of the inputs if need be, and along its curve of
/// closed positions where these are singular: past change points on the branch that is asked for (KOPPEL_CHANGE_POINT),
/// up to a limit (KOPPEL_NOT_CLOSED, the report tells it). Another is assembled: by Newton if it is near, by Ceres from
/// further away, by letting the inputs go, closing, and leading them back, and last by the solution flow, which finds a
/// closed position if there is one, or that there is none (verdict unreachable), for mechanisms that it can say all
/// solutions of. Status: as koppel_status; KOPPEL_NOT_CLOSED, KOPPEL_RETRY and KOPPEL_PLUGIN leave the state untouched.
koppel_status close(Work& work, State& state, const CloseOptions& options, Report& report);

/// Whether the loops are closed at the state's position and time; its inputs may ask for another position by now.
bool is_closed(const Mechanism& mechanism, const State& state);

/// Rates of a closed state from those of its inputs (K-II-3.5.1b); free motions get the least norm. KOPPEL_SINGULAR:
/// the inputs' rates are impossible here. KOPPEL_INVALID_ARGUMENT: the state is not closed.
koppel_status velocities(Work& work, State& state);

/// Accelerations, likewise (K-II-3.6.1); the state must have velocities.
koppel_status accelerations(Work& work, State& state);

/// To another time: inputs, closure, velocities, accelerations; on failure the state is as before. By closed forms in
/// the order of the mechanism's flow where it has such and is not near a singular position, else by close().
koppel_status move(Work& work, State& state, double time, Report& report, Branch branch = Branch::stay);

/// Forward kinematics at the state, with its rates and accelerations; results are in work.equations.kinematics.
bool realise(Work& work, const State& state);

}  // namespace koppel
