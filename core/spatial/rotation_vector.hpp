// Rotation vectors: axis times angle [rad]. The exponential map to quaternions and matrices, its inverse the logarithm,
// and the derivatives of both.
#pragma once

#include <cmath>
#include <optional>

#include "spatial/quaternion.hpp"
#include "spatial/rotation.hpp"
#include "spatial/rotation_coordinates.hpp"
#include "spatial/sinc.hpp"

namespace koppel {

/// Unit quaternion of a rotation vector [rad] of any length (K-I-4.5.2).
template <typename T>
inline Vector4T<T> quaternion_of_rotation_vector(const Vector3T<T>& phi) {
  const SincTerms<T> half = sinc_terms<T>(phi.squaredNorm() / T(4));
  const T factor = half.sinc / T(2);
  return {half.cosine, factor * phi.x(), factor * phi.y(), factor * phi.z()};
}

/// The exponential: rotation matrix exp(skew(phi)) of a rotation vector [rad] of any length (K-I-4.2.1b).
template <typename T>
inline Matrix3T<T> rotation_of_rotation_vector(const Vector3T<T>& phi) {
  const SincTerms<T> terms = sinc_terms<T>(phi.squaredNorm());
  return rotation_terms<T>(terms.cosine, terms.cosinc * phi, phi, terms.sinc * phi);
}

/// The logarithm: rotation vector [rad] of a quaternion (not zero), length in [0, pi]; to rounding at every angle
/// (K-I-4.2.2). At half a turn both signs are right, and one is returned.
template <typename T>
inline Vector3T<T> rotation_vector_of_quaternion(const Vector4T<T>& q) {
  using std::atan2, std::sqrt;
  const T w = q[0] < T(0) ? T(-q[0]) : q[0];
  const T sine = sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  // Too small to be squared, or zero: the angle is its sine.
  const T size = sine > T(0) ? T(T(2) * atan2(sine, w) / sine) : T(T(2) / w);
  const T factor = q[0] < T(0) ? T(-size) : size;
  return {factor * q[1], factor * q[2], factor * q[3]};
}

/// The logarithm of a rotation matrix [rad], length in [0, pi] (K-I-4.2.2, K-I-3.2.0).
template <typename T>
inline Vector3T<T> rotation_vector_of_rotation(const Matrix3T<T>& r) {
  return rotation_vector_of_quaternion<T>(long_quaternion_of_rotation<T>(r));
}

/// J_l: angular velocity = J_l(phi) d(phi)/dt in the axes from which phi turns; exp(phi + d) = exp(J_l d) exp(phi) to
/// first order (K-I-4.2.4). Smooth everywhere; at full turns only its rank falls to one.
template <typename T>
inline Matrix3T<T> left_jacobian(const Vector3T<T>& phi) {
  const SincTerms<T> terms = sinc_terms<T>(phi.squaredNorm());
  return rotation_terms<T>(terms.sinc, terms.sinc_defect * phi, phi, terms.cosinc * phi);
}

/// J_r: the same in the turned axes, exp(phi + d) = exp(phi) exp(J_r d); the transpose of J_l (K-I-4.2.4).
template <typename T>
Matrix3T<T> right_jacobian(const Vector3T<T>& phi) {
  return left_jacobian<T>(-phi);
}

/// J_l^-1: d(phi)/dt = J_l^-1 omega, omega in the axes from which phi turns (K-I-4.2.4). Grows without bound towards
/// full turns, 2 pi and its multiples; no logarithm is longer than pi, where its norm is pi/2.
template <typename T>
inline Matrix3T<T> left_jacobian_inverse(const Vector3T<T>& phi) {
  const T s = phi.squaredNorm();
  const T factor = cotangent_defect_of_square<T>(s);
  return rotation_terms<T>(T(1) - factor * s, factor * phi, phi, T(-0.5) * phi);
}

/// J_r^-1: the same for omega in the turned axes (K-I-4.2.4).
template <typename T>
Matrix3T<T> right_jacobian_inverse(const Vector3T<T>& phi) {
  return left_jacobian_inverse<T>(-phi);
}

/// Rotation vectors as coordinates (K-I-4.0a).
struct RotationVector {
  static constexpr int size = 3;

  template <typename T>
  static Matrix3T<T> rotation(const Vector3T<T>& phi) {
    return rotation_of_rotation_vector<T>(phi);
  }

  template <typename T>
  static Vector4T<T> quaternion(const Vector3T<T>& phi) {
    return quaternion_of_rotation_vector<T>(phi);
  }

  template <typename T>
  static Extracted<T, 3> of_quaternion(const Vector4T<T>& q) {
    return {rotation_vector_of_quaternion<T>(q)};
  }

  /// The vector of the other way round, 2 pi - |phi| long. Empty for the zero vector: all vectors of length 2 pi would
  /// do.
  template <typename T>
  static std::optional<Vector3T<T>> twin(const Vector3T<T>& phi) {
    const T angle = phi.norm();
    if (!(angle > T(0))) return std::nullopt;
    return Vector3T<T>((T(1) - T(2) * constants::pi<T>() / angle) * phi);
  }

  template <typename T>
  static Matrix3T<T> h_matrix(const Vector3T<T>& phi, Axes axes) {
    return axes == Axes::base ? left_jacobian<T>(phi) : right_jacobian<T>(phi);
  }

  /// Empty at full turns other than zero, to rounding.
  template <typename T>
  static std::optional<Matrix3T<T>> k_matrix(const Vector3T<T>& phi, Axes axes) {
    using std::abs;
    if (abs(sinc_terms<T>(phi.squaredNorm() / T(4)).sinc) <= rounding_floor<T>()) return std::nullopt;
    return axes == Axes::base ? left_jacobian_inverse<T>(phi) : right_jacobian_inverse<T>(phi);
  }
};

}  // namespace koppel
