// Motion of a body in a plane: the poles of its velocities and accelerations, the circle on which paths have no
// curvature, and the two curves that roll on each other.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "spatial/types.hpp"

namespace koppel {

template <typename T>
using Vector2T = Eigen::Matrix<T, 2, 1>;
using Vector2 = Vector2T<double>;

/// A vector of the plane turned by a quarter to the left, from x to y.
template <typename T>
Vector2T<T> quarter_turned(const Vector2T<T>& v) {
  return {-v.y(), v.x()};
}

/// Motion of a plane K_1 in a plane K_0 at one moment: where its origin is [m] and the angle from K_0's x axis to its
/// own [rad, to the left]; their first and second derivatives [m/s, rad/s, m/s^2, rad/s^2]. All vectors in the axes of
/// K_0.
template <typename T>
struct PlanarMotionT {
  Vector2T<T> position = Vector2T<T>::Zero();
  T angle = T(0);
  Vector2T<T> velocity = Vector2T<T>::Zero();
  T rate = T(0);
  Vector2T<T> acceleration = Vector2T<T>::Zero();
  T angular_acceleration = T(0);

  /// Coordinates in K_1 of the point at p in K_0.
  Vector2T<T> in_body(const Vector2T<T>& p) const {
    using std::cos, std::sin;
    const Vector2T<T> r = p - position;
    const T c = cos(angle), s = sin(angle);
    return {c * r.x() + s * r.y(), c * r.y() - s * r.x()};
  }
  /// Velocity [m/s] of the point of K_1 that is at p in K_0.
  Vector2T<T> velocity_at(const Vector2T<T>& p) const { return velocity + rate * quarter_turned<T>(p - position); }
  /// Acceleration [m/s^2] of the point of K_1 that is at p in K_0.
  Vector2T<T> acceleration_at(const Vector2T<T>& p) const {
    const Vector2T<T> r = p - position;
    return acceleration + angular_acceleration * quarter_turned<T>(r) - (rate * rate) * r;
  }
};

using PlanarMotion = PlanarMotionT<double>;

/// What a plane does at one moment.
enum class PlanarKind {
  rest,
  translation,  ///< all velocities are equal: the pole is infinitely far, across them
  rotation,     ///< about the pole
};

/// The pole of the velocities, the point of K_1 that is at rest: its place in K_0 and the same in K_1 [m]. Both are
/// zero unless the kind is rotation.
template <typename T>
struct PlanarPoleT {
  PlanarKind kind = PlanarKind::rest;
  Vector2T<T> fixed = Vector2T<T>::Zero();
  Vector2T<T> moving = Vector2T<T>::Zero();
};

/// r_P = r_O + (omega x v_O) / omega^2 (K-I-3.3.2c). A motion is a translation where omega times a length [m] that is
/// typical of the mechanism is rounding beside the velocity.
template <typename T>
PlanarPoleT<T> velocity_pole(const PlanarMotionT<T>& motion, const T& length) {
  using std::abs, std::hypot;
  const T speed = hypot(motion.velocity.x(), motion.velocity.y());
  const T turning = abs(motion.rate) * length;
  if (!(speed > T(0)) && !(turning > T(0))) return {};
  if (!(turning > rounding_floor<T>() * speed)) return {.kind = PlanarKind::translation};
  const Vector2T<T> pole = motion.position + quarter_turned<T>(motion.velocity) / motion.rate;
  return {PlanarKind::rotation, pole, motion.in_body(pole)};
}

/// Where the point of K_1 without acceleration is, in K_0 [m]. Empty where the plane has neither angular velocity nor
/// angular acceleration, to rounding beside the acceleration over a typical length [m]: then all accelerations are
/// equal.
template <typename T>
std::optional<Vector2T<T>> acceleration_pole(const PlanarMotionT<T>& motion, const T& length) {
  using std::hypot;
  const T square = motion.rate * motion.rate, turning = hypot(square, motion.angular_acceleration);
  const Vector2T<T>& a = motion.acceleration;
  if (!(turning * length > rounding_floor<T>() * hypot(a.x(), a.y()))) return std::nullopt;
  const T cosine = square / turning, sine = motion.angular_acceleration / turning;
  return Vector2T<T>(motion.position + (cosine * a + sine * quarter_turned<T>(a)) / turning);
}

/// How the velocity pole moves, and what follows for the curvature of paths (Euler and Savary).
template <typename T>
struct InflectionT {
  Vector2T<T> pole;           ///< of the velocities, in K_0 [m]
  Vector2T<T> pole_velocity;  ///< at which the pole changes place, along both polodes [m/s]; not a velocity of K_1
  /// The point opposite to the pole on the inflection circle, in K_0 [m]. The points of K_1 on this circle have paths
  /// without curvature; its diameter is |pole_velocity / rate|.
  Vector2T<T> inflection_pole;
};

/// Empty where velocity_pole() finds no pole.
template <typename T>
std::optional<InflectionT<T>> inflection(const PlanarMotionT<T>& motion, const T& length) {
  const auto pole = velocity_pole<T>(motion, length);
  if (pole.kind != PlanarKind::rotation) return std::nullopt;
  // The body's point at the pole accelerates by -omega x pole velocity, whatever the angular acceleration.
  const Vector2T<T> a = motion.acceleration_at(pole.fixed) / motion.rate;
  return InflectionT<T>{pole.fixed, quarter_turned<T>(a), pole.fixed + a / motion.rate};
}

/// A piece of both polodes: the poles of a run of samples, in K_0 and in K_1 [m]. The moving one rolls on the fixed
/// one.
template <typename T>
struct PolodesT {
  std::size_t first = 0;  ///< index of the first sample; the others follow without a gap
  std::vector<Vector2T<T>> fixed;
  std::vector<Vector2T<T>> moving;
};

/// The polodes of a sampled motion. They break where a sample has no pole, and where the turning changes its sense
/// between two samples: there the pole passes through infinity.
template <typename T>
std::vector<PolodesT<T>> polodes(std::span<const PlanarMotionT<T>> samples, const T& length) {
  std::vector<PolodesT<T>> pieces;
  bool open = false;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto pole = velocity_pole<T>(samples[i], length);
    if (open && (samples[i].rate > T(0)) != (samples[i - 1].rate > T(0))) open = false;
    if (pole.kind != PlanarKind::rotation) {
      open = false;
      continue;
    }
    if (!open) pieces.push_back({.first = i, .fixed = {}, .moving = {}});
    open = true;
    pieces.back().fixed.push_back(pole.fixed);
    pieces.back().moving.push_back(pole.moving);
  }
  return pieces;
}

}  // namespace koppel
