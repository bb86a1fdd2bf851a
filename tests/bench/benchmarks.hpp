// What is timed, one function for each. A batch is one pass over the steps of the scene's run; times are those of one
// item.
#pragma once

#include <benchmark/benchmark.h>

#include "run.hpp"

namespace koppel::bench {

/// Forward kinematics of all bodies, and the columns of all rates.
void position(benchmark::State& timer, const Run& run);
/// The same with velocities and accelerations.
void position_and_motion(benchmark::State& timer, const Run& run);

/// The step to the next position of the run, its inputs set, by Newton.
void newton_warm(benchmark::State& timer, const Run& run);
/// From the scene's start to its first position, by Ceres.
void ceres_cold(benchmark::State& timer, const Run& run);
/// Velocities and accelerations of a position just closed.
void rates(benchmark::State& timer, const Run& run);
/// A whole step of a run: inputs, closure, velocities, accelerations.
void move_step(benchmark::State& timer, const Run& run);

/// All closed positions for the inputs at time 0.
void all_modes(benchmark::State& timer, const Run& run);

}  // namespace koppel::bench
