#include "suspension/wheel.hpp"

#include <cmath>

namespace koppel::app {

Wheel wheel_of(const double* pose, const double* twist, double side, double radius) {
  const Point axis = {pose[1], pose[4], pose[7]};
  const Point rate = {twist[1] * axis[2] - twist[2] * axis[1], twist[2] * axis[0] - twist[0] * axis[2],
                      twist[0] * axis[1] - twist[1] * axis[0]};
  const double level = axis[0] * axis[0] + axis[1] * axis[1];  // squared length of the axis seen from above
  Wheel wheel;
  wheel.centre = {pose[9], pose[10], pose[11]};
  wheel.toe = side * std::atan2(axis[0], axis[1]);
  wheel.toe_rate = side * (rate[0] * axis[1] - axis[0] * rate[1]) / level;
  wheel.camber = -side * std::asin(axis[2]);
  wheel.camber_rate = -side * rate[2] / std::sqrt(level);
  // Down along the wheel's plane: minus z, less its part along the axis.
  const double scale = radius / std::sqrt(level);
  for (std::size_t i = 0; i < 3; ++i) {
    wheel.contact[i] = wheel.centre[i] + scale * (axis[2] * axis[i] - (i == 2 ? 1.0 : 0.0));
  }
  return wheel;
}

}  // namespace koppel::app
