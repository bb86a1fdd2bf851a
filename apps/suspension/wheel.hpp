// What a suspension does to its wheel: position and angles, ISO 8855 (x forward, y left, z up).
#pragma once

#include <array>

namespace koppel::app {

using Point = std::array<double, 3>;

/// A wheel at one travel. Toe is positive where the front of the wheel points inwards, camber where its top leans
/// outwards, for left and right wheels alike.
struct Wheel {
  Point centre{};            ///< [m] in the world
  Point contact{};           ///< [m] lowest point of a tyre of the given radius; the centre for radius 0
  double camber = 0.0;       ///< [rad]
  double toe = 0.0;          ///< [rad]
  double camber_rate = 0.0;  ///< [rad/s]
  double toe_rate = 0.0;     ///< [rad/s]
};

/// pose: of the frame of the wheel, its y axis along the axis of rotation towards the left; twist: world axes, at its
/// origin; side: +1 for a left wheel, -1 for a right one; radius: of the tyre [m].
Wheel wheel_of(const double* pose, const double* twist, double side, double radius);

}  // namespace koppel::app
