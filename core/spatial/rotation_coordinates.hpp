// What all coordinates of a rotation have in common (K-I-4.0a). A set of coordinates is a type of functions on plain
// columns of numbers:
//
//   size                      how many there are, m
//   quaternion(x)             unit quaternion, any sign
//   of_quaternion(q)          coordinates of a unit quaternion, with a flag where they are not determined
//   h_matrix(x, axes)         3 x m matrix H: angular velocity = H dx/dt, in base or in body axes
//   k_matrix(x, axes)         m x 3 matrix K: dx/dt = K omega; K H = 1 on rates that are possible, H K = 1. Empty where
//                             it does not exist
//   rotation(x)               matrix R_base,body; optional, where there is a shorter way than by the quaternion
//   of_rotation(r)            coordinates of a matrix, likewise
//   twin(x)                   optional: the other coordinates of the same rotation
//   constraints(x)            optional, if m > 3: the conditions that they satisfy, zero if they do
//
// DirectionCosines (9), AxisAngle (4), RotationVector (3), EulerParameters (4), RodriguesParameters (3), and the twelve
// AngleSequences (3) are such types. Everything below is written once for all of them.
#pragma once

#include <concepts>
#include <numbers>
#include <optional>

#include "spatial/dual.hpp"
#include "spatial/quaternion.hpp"

namespace koppel {

/// In whose axes an angular velocity is written: those of the frame in which the rotation starts, or the turned ones.
enum class Axes { base, body };

/// Coordinates of a rotation.
template <typename T, int n>
struct Extracted {
  Eigen::Matrix<T, n, 1> coordinates;
  /// To rounding, others would do as well (the choice is documented), or none is exact. The coordinates are finite, and
  /// make the rotation to rounding, all the same.
  bool singular = false;
};

template <typename C>
concept RotationCoordinates = requires(const Eigen::Matrix<double, C::size, 1>& x, const Vector4& q, Axes axes) {
  { C::template quaternion<double>(x) } -> std::convertible_to<Vector4>;
  { C::template of_quaternion<double>(q) } -> std::same_as<Extracted<double, C::size>>;
  { C::template h_matrix<double>(x, axes) } -> std::convertible_to<Eigen::Matrix<double, 3, C::size>>;
  { C::template k_matrix<double>(x, axes) } -> std::same_as<std::optional<Eigen::Matrix<double, C::size, 3>>>;
};

namespace constants {
template <typename T>
T pi() {
  return constant<T>(std::numbers::pi_v<long double>);
}
}  // namespace constants

/// The angle [rad] in (-pi, pi] that differs from an angle in [-3 pi, 3 pi] by full turns.
template <typename T>
T wrapped(const T& angle) {
  const T pi = constants::pi<T>();
  if (angle > pi) return angle - T(2) * pi;
  if (angle <= -pi) return angle + T(2) * pi;
  return angle;
}

/// The angle [rad] that differs from the given one by full turns and is nearest to the previous one: a motion over
/// several turns has no jump (K-I-4.2.2).
template <typename T>
T unwrapped(const T& angle, const T& previous) {
  using std::round;
  const T turn = T(2) * constants::pi<T>();
  return angle + turn * round((previous - angle) / turn);
}

/// Rotation matrix R_base,body of coordinates (K-I-4.0a).
template <RotationCoordinates C, typename T>
Matrix3T<T> rotation(const Eigen::Matrix<T, C::size, 1>& x) {
  if constexpr (requires { C::template rotation<T>(x); }) {
    return C::template rotation<T>(x);
  } else {
    return rotation_of_quaternion<T>(C::template quaternion<T>(x));
  }
}

/// Coordinates of a rotation matrix (K-I-4.0a).
template <RotationCoordinates C, typename T>
Extracted<T, C::size> extracted(const Matrix3T<T>& r) {
  if constexpr (requires { C::template of_rotation<T>(r); }) {
    return C::template of_rotation<T>(r);
  } else {
    return C::template of_quaternion<T>(quaternion_of_rotation<T>(r));
  }
}

/// Coordinates of one kind made of those of another (K-I-4.7).
template <RotationCoordinates To, RotationCoordinates From, typename T>
Extracted<T, To::size> converted(const Eigen::Matrix<T, From::size, 1>& x) {
  if constexpr (From::size == 9) {
    return extracted<To, T>(rotation<From, T>(x));
  } else {
    return To::template of_quaternion<T>(From::template quaternion<T>(x));
  }
}

/// The angular velocity [rad/s] that goes with rates of the coordinates (K-I-4.0a).
template <RotationCoordinates C, typename T>
Vector3T<T> angular_velocity(const Eigen::Matrix<T, C::size, 1>& x, const Eigen::Matrix<T, C::size, 1>& rates,
                             Axes axes) {
  return C::template h_matrix<T>(x, axes) * rates;
}

/// The coordinates' rates at an angular velocity [rad/s]. Empty where the coordinates are singular (K-I-4.0a).
template <RotationCoordinates C, typename T>
std::optional<Eigen::Matrix<T, C::size, 1>> coordinate_rates(const Eigen::Matrix<T, C::size, 1>& x,
                                                             const Vector3T<T>& omega, Axes axes) {
  const auto k = C::template k_matrix<T>(x, axes);
  if (!k) return std::nullopt;
  return Eigen::Matrix<T, C::size, 1>(*k * omega);
}

/// The angular acceleration [rad/s^2] that goes with rates and accelerations of the coordinates, H x'' + H' x': the
/// rate of the angular velocity, exact, by dual numbers. The axes tell in which components it is written; it is the
/// same vector whether it is differentiated in the base or in the body (K-I-4.0a, K-I-5.1d).
template <RotationCoordinates C, typename T>
Vector3T<T> angular_acceleration(const Eigen::Matrix<T, C::size, 1>& x, const Eigen::Matrix<T, C::size, 1>& rates,
                                 const Eigen::Matrix<T, C::size, 1>& accelerations, Axes axes) {
  return dual_part(angular_velocity<C, Dual<T>>(dual(x, rates), dual(rates, accelerations), axes));
}

/// The coordinates' accelerations at an angular velocity [rad/s] and acceleration [rad/s^2], K alpha + K' omega; those
/// of coordinates with constraints satisfy them. Empty where the coordinates are singular (K-I-4.0a).
template <RotationCoordinates C, typename T>
std::optional<Eigen::Matrix<T, C::size, 1>> coordinate_accelerations(const Eigen::Matrix<T, C::size, 1>& x,
                                                                     const Vector3T<T>& omega, const Vector3T<T>& alpha,
                                                                     Axes axes) {
  const auto rates = coordinate_rates<C, T>(x, omega, axes);
  if (!rates) return std::nullopt;
  const auto moving = coordinate_rates<C, Dual<T>>(dual(x, *rates), dual(omega, alpha), axes);
  if (!moving) return std::nullopt;
  return Eigen::Matrix<T, C::size, 1>(dual_part(*moving));
}

}  // namespace koppel
