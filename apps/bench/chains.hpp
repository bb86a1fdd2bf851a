// Scenes of any size, and what is known of their motion.
#pragma once

#include <string>

namespace koppel::app::bench {

/// `count` uniform rods, 1 m and 1 kg all together, that hang on each other and are let go level.
std::string pendulum_chain(int count);

/// IFToMM A02: `count` windows of bars and couplers, each 1 m and 1 kg; upright, the tips at 1 m/s.
std::string fourbar_chain(int count);
/// Its first bar's angle [rad] after a time [s], negative as the bars turn that way: it moves like one pendulum.
double fourbar_chain_angle(int count, double time);

/// Angle after a time of angle'' = -k sin(angle) [rad, s], for some swings exact to rounding.
double swing(double k, double angle, double rate, double time);

/// `count` parallelograms side by side, each driven by the one before; the first bell crank swings by 20 deg in 1 s.
/// All cranks stand alike at any time.
std::string fourbar_row(int count);

}  // namespace koppel::app::bench
