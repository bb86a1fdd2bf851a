// Rotations: matrices, rotation vectors, unit quaternions (w x y z), Cardan angles.
// A matrix R_AB maps components in B into A (C-3); as an operator it turns A into B (C-4).
#pragma once

#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "spatial/types.hpp"

namespace koppel {

/// Rotation about the unit vector u by an angle [rad] whose cosine and sine are given (K-I-4.2.1a).
template <typename T>
Matrix3T<T> rotation_about(const Vector3T<T>& u, const T& cosine, const T& sine) {
  const Vector3T<T> v = (T(1) - cosine) * u;
  Matrix3T<T> r;
  r(0, 0) = cosine + v.x() * u.x();
  r(1, 1) = cosine + v.y() * u.y();
  r(2, 2) = cosine + v.z() * u.z();
  const T xy = v.x() * u.y(), xz = v.x() * u.z(), yz = v.y() * u.z();
  r(0, 1) = xy - sine * u.z();
  r(1, 0) = xy + sine * u.z();
  r(0, 2) = xz + sine * u.y();
  r(2, 0) = xz - sine * u.y();
  r(1, 2) = yz - sine * u.x();
  r(2, 1) = yz + sine * u.x();
  return r;
}

template <typename T>
Matrix3T<T> rotation_about(const Vector3T<T>& u, const T& angle) {
  using std::cos, std::sin;
  return rotation_about<T>(u, cos(angle), sin(angle));
}

/// Matrix of a quaternion w x y z (C-8). The quaternion need not be of unit length: the result is that of the
/// normalised one.
template <typename T>
Matrix3T<T> rotation_of_quaternion(const Vector4T<T>& q) {
  const T s = T(2) / q.squaredNorm();
  const T x = q[1] * s, y = q[2] * s, z = q[3] * s;
  const T wx = q[0] * x, wy = q[0] * y, wz = q[0] * z;
  const T xx = q[1] * x, xy = q[1] * y, xz = q[1] * z;
  const T yy = q[2] * y, yz = q[2] * z, zz = q[3] * z;
  Matrix3T<T> r;
  r << T(1) - (yy + zz), xy - wz, xz + wy, xy + wz, T(1) - (xx + zz), yz - wx, xz - wy, yz + wx, T(1) - (xx + yy);
  return r;
}

/// Hamilton product (K-I-4.5.1).
template <typename T>
Vector4T<T> quaternion_product(const Vector4T<T>& a, const Vector4T<T>& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

/// Unit quaternion of a matrix, by the largest of the four components (K-I-4.5.3); the sign with w >= 0.
template <typename T>
Vector4T<T> quaternion_of_rotation(const Matrix3T<T>& r) {
  const Eigen::Quaternion<T> e(r);
  Vector4T<T> q(e.w(), e.x(), e.y(), e.z());
  q.normalize();
  return q[0] < T(0) ? Vector4T<T>(-q) : q;
}

/// Unit quaternion of a rotation vector [rad], regular at zero (K-I-4.5.2).
template <typename T>
Vector4T<T> quaternion_of_rotation_vector(const Vector3T<T>& phi) {
  using std::cos, std::sin, std::sqrt;
  const T square = phi.squaredNorm();
  if (square < T(1e-8)) {
    // Series: the next terms are below one unit of rounding.
    const T factor = T(0.5) - square * (T(1) / T(48) - square / T(3840));
    Vector4T<T> q;
    q << T(1) - square * (T(0.125) - square / T(384)), factor * phi;
    return q;
  }
  const T angle = sqrt(square);
  Vector4T<T> q;
  q << cos(angle / T(2)), sin(angle / T(2)) / angle * phi;
  return q;
}

/// Rotation vector [rad] of a unit quaternion, length in [0, pi]; accurate near 0 and near pi (K-I-4.2.2).
template <typename T>
Vector3T<T> rotation_vector_of_quaternion(const Vector4T<T>& q) {
  using std::atan2;
  const Vector3T<T> v = q[0] < T(0) ? Vector3T<T>(-q.template tail<3>()) : Vector3T<T>(q.template tail<3>());
  const T w = q[0] < T(0) ? T(-q[0]) : T(q[0]);
  const T n = v.norm();
  if (n < std::numeric_limits<double>::min()) return T(2) * v;
  return (T(2) * atan2(n, w) / n) * v;
}

/// Rotation vector [rad] of a matrix, length in [0, pi].
template <typename T>
Vector3T<T> rotation_vector(const Matrix3T<T>& r) {
  return rotation_vector_of_quaternion<T>(quaternion_of_rotation<T>(r));
}

/// Inverse of the right Jacobian of the exponential: d(phi)/dt = result * omega, omega in the turned frame's axes
/// (K-I-4.2.4). Regular at zero; undefined at full turns, which rotation_vector() never returns.
template <typename T>
Matrix3T<T> right_jacobian_inverse(const Vector3T<T>& phi) {
  using std::cos, std::sin, std::sqrt;
  const T square = phi.squaredNorm();
  T factor;
  if (square < T(1e-4)) {
    factor = T(1) / T(12) + square * (T(1) / T(720) + square / T(30240));
  } else {
    const T half = sqrt(square) / T(2);
    factor = (T(1) - half * cos(half) / sin(half)) / square;
  }
  const Matrix3T<T> s = skew(phi);
  return Matrix3T<T>::Identity() + T(0.5) * s + factor * s * s;
}

/// Cardan angles (alpha, beta, gamma) of R = Rx(alpha) Ry(beta) Rz(gamma) (K-I-4.4.1). beta in [-pi/2, pi/2]. Where
/// beta is +-pi/2 to rounding, gamma is set to 0; near there only the sum or difference of alpha and gamma is well
/// determined, and gamma is chosen so that the three together make the matrix.
template <typename T>
Vector3T<T> cardan_angles(const Matrix3T<T>& r) {
  using std::atan2, std::cos, std::sin, std::sqrt;
  const T cosine = sqrt(r(0, 0) * r(0, 0) + r(0, 1) * r(0, 1));
  const T beta = atan2(r(0, 2), cosine);
  if (cosine < T(8) * std::numeric_limits<double>::epsilon()) return {atan2(r(2, 1), r(1, 1)), beta, T(0)};
  const T alpha = atan2(-r(1, 2), r(2, 2));
  const T c = cos(alpha), s = sin(alpha);
  return {alpha, beta, atan2(c * r(1, 0) + s * r(2, 0), c * r(1, 1) + s * r(2, 1))};
}

/// Two unit vectors that complete the unit vector n to a right-handed frame (t1, t2, n); t1 = normalised(e x n) with e
/// the axis that n has least of.
template <typename T>
Eigen::Matrix<T, 3, 2> tangents(const Vector3T<T>& n) {
  Eigen::Index least = 0;
  n.cwiseAbs().minCoeff(&least);
  Eigen::Matrix<T, 3, 2> t;
  t.col(0) = Vector3T<T>::Unit(least).cross(n).normalized();
  t.col(1) = n.cross(t.col(0));
  return t;
}

}  // namespace koppel
