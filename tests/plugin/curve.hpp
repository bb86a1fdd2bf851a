// A frame that moves with a constant twist, and derivatives of what is measured on the way.
#pragma once

#include <array>
#include <cmath>
#include <functional>

#include "spatial/pose.hpp"
#include "spatial/rotation.hpp"

namespace koppel::test {

using PoseNumbers = std::array<double, 12>;

inline PoseNumbers numbers_of(const Pose& pose) {
  PoseNumbers out{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out[static_cast<std::size_t>(3 * i + j)] = pose.rotation(i, j);
    out[static_cast<std::size_t>(9 + i)] = pose.position[i];
  }
  return out;
}

/// start * exp(t twist), the twist [angular; linear] in the moving frame; its angular part must not vanish.
inline Pose along_twist(const Pose& start, const Vector6& twist, double t) {
  const Vector3 omega = twist.head<3>(), v = twist.tail<3>();
  const double w = omega.norm();
  const Vector3 u = omega / w;
  const Matrix3 s = skew(u);
  const Matrix3 integral = t * Matrix3::Identity() + (1 - std::cos(w * t)) / w * s + (t - std::sin(w * t) / w) * s * s;
  return start * Pose{rotation_about<double>(u, w * t), integral * v};
}

/// The step of the difference formulas below: their truncation (h/length)^6/140 and their rounding eps length/h are
/// both about 1e-13 of the function's scale for functions that change over lengths of about 1.
inline constexpr double difference_step = 1e-2;

/// First derivative at 0 by central differences of sixth order.
inline double derivative(const std::function<double(double)>& f, double h = difference_step) {
  return (45 * (f(h) - f(-h)) - 9 * (f(2 * h) - f(-2 * h)) + (f(3 * h) - f(-3 * h))) / (60 * h);
}

/// Second derivative at 0, sixth order.
inline double second_derivative(const std::function<double(double)>& f, double h = difference_step) {
  return (2 * (f(3 * h) + f(-3 * h)) - 27 * (f(2 * h) + f(-2 * h)) + 270 * (f(h) + f(-h)) - 490 * f(0)) / (180 * h * h);
}

}  // namespace koppel::test
