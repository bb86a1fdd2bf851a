// Rotations at which something may go wrong: about the axes and between them, by the angles where formulas change, and
// in and near gimbal lock. As quaternions in long double, which hold the angle exactly enough to be the reference.
#pragma once

#include <numbers>
#include <vector>

#include "directions.hpp"
#include "spatial/angle_sequence.hpp"
#include "spatial/axis_angle.hpp"

namespace koppel::test {

inline std::vector<Vector4T<long double>> special_rotations() {
  using Real = long double;
  constexpr double pi = std::numbers::pi;
  std::vector<Vector4T<Real>> all;
  Random random(11);
  for (const double angle :
       {0.0,           1e-300, 1e-160,         1e-16, 1e-15,      1e-12,     1e-8,      1e-4,       1e-2, 1.0,
        pi / 2 - 1e-8, pi / 2, pi / 2 + 1e-12, 2.0,   2 * pi / 3, pi - 1e-4, pi - 1e-8, pi - 1e-15, pi,   -pi / 2}) {
    const auto turn = [&](const Vector3T<Real>& u) {
      all.push_back(
          AxisAngle::quaternion<Real>((Vector4T<Real>() << u.normalized(), static_cast<Real>(angle)).finished()));
    };
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          if (x != 0 || y != 0 || z != 0) turn(Vector3T<Real>(x, y, z));
        }
      }
    }
    for (int n = 0; n < 20; ++n) turn(random.direction().cast<Real>());
  }
  for (const double off : {1e-2, 1e-5, 1e-8, 1e-11, 1e-14, 1e-15, 1e-16, 1e-100, 0.0}) {
    for (const double middle : {off, pi - off, pi / 2 - off, off - pi / 2}) {
      for (int n = 0; n < 20; ++n) {
        const Vector3T<Real> angles(random.between(-3, 3), middle, random.between(-3, 3));
        all.push_back(EulerAngles::quaternion<Real>(angles));
        all.push_back(CardanAngles::quaternion<Real>(angles));
      }
    }
  }
  return all;
}

}  // namespace koppel::test
