// A way through a loop whose motions have rates and accelerations: how the frame at its end moves against its start
// (K-II-2.1). Nothing is allocated.
#pragma once

#include <cstdint>
#include <span>

#include "closure/loop_cut.hpp"

namespace koppel {

/// Where a variable stands and how it moves.
struct MovingPlace {
  Place<double> at{};              ///< as Place
  Vector3 rate = Vector3::Zero();  ///< of turns and slides the first component
  Vector3 acceleration = Vector3::Zero();
};

/// A pose and its motion, in the axes of the walk's start; velocity and acceleration are of the origin.
struct MovingPose {
  Pose pose;
  Vector3 angular_velocity = Vector3::Zero(), velocity = Vector3::Zero();
  Vector3 angular_acceleration = Vector3::Zero(), acceleration = Vector3::Zero();
};

/// The end of a way in its start, and how it moves.
MovingPose moving_end(const Way& way, std::span<const MovingPlace> places);

/// The end of a way, and how it changes with the rate of one scalar variable (zero if the way does not pass it).
struct WaySlope {
  Pose pose;
  Vector3 angular = Vector3::Zero(), linear = Vector3::Zero();
};
WaySlope slope(const Way& way, std::span<const MovingPlace> places, std::uint32_t variable);

}  // namespace koppel
