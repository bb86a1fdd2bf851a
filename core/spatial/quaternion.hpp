// Quaternions w x y z (C-8) and Euler parameters, the unit quaternions of rotations: q = cos(angle/2) + u sin(angle/2).
#pragma once

#include <cmath>
#include <optional>

#include "spatial/types.hpp"

namespace koppel {

/// Hamilton product (K-I-4.5.1). Of unit quaternions it is the composition: q_02 = q_01 q_12 (K-I-4.5.4).
template <typename T>
inline Vector4T<T> quaternion_product(const Vector4T<T>& a, const Vector4T<T>& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

/// The matrix of multiplication from the left: left_factor(a) b = a b (K-I-4.5.1).
template <typename T>
Eigen::Matrix<T, 4, 4> left_factor(const Vector4T<T>& a) {
  Eigen::Matrix<T, 4, 4> m;
  m << a[0], -a[1], -a[2], -a[3], a[1], a[0], -a[3], a[2], a[2], a[3], a[0], -a[1], a[3], -a[2], a[1], a[0];
  return m;
}

/// The matrix of multiplication from the right: right_factor(b) a = a b (K-I-4.5.1).
template <typename T>
Eigen::Matrix<T, 4, 4> right_factor(const Vector4T<T>& b) {
  Eigen::Matrix<T, 4, 4> m;
  m << b[0], -b[1], -b[2], -b[3], b[1], b[0], b[3], -b[2], b[2], -b[3], b[0], b[1], b[3], b[2], -b[1], b[0];
  return m;
}

/// w - x - y - z: of a unit quaternion, the opposite rotation.
template <typename T>
Vector4T<T> conjugate(const Vector4T<T>& q) {
  return {q[0], -q[1], -q[2], -q[3]};
}

/// q^-1 with q q^-1 = 1; empty for zero (K-I-4.5.1).
template <typename T>
std::optional<Vector4T<T>> quaternion_inverse(const Vector4T<T>& q) {
  const T scale = q.cwiseAbs().maxCoeff();
  if (!(scale > T(0))) return std::nullopt;
  const Vector4T<T> scaled = q / scale;
  return Vector4T<T>(conjugate<T>(scaled) / scaled.squaredNorm() / scale);
}

/// The vector v turned by the unit quaternion q: q v conj(q) (K-I-4.5.2).
template <typename T>
inline Vector3T<T> rotated(const Vector4T<T>& q, const Vector3T<T>& v) {
  const Vector3T<T> n = q.template tail<3>();
  const Vector3T<T> t = T(2) * n.cross(v);
  return v + q[0] * t + n.cross(t);
}

/// Matrix of a quaternion, which need not be of unit length: the result is that of the normalised one (K-I-4.5.2). Of
/// complex components the square of the length is the sum of their squares, so that the matrix is analytic in them.
template <typename T>
inline Matrix3T<T> rotation_of_quaternion(const Vector4T<T>& q) {
  const T s = T(2) / ((q[0] * q[0] + q[2] * q[2]) + (q[1] * q[1] + q[3] * q[3]));
  const T x = q[1] * s, y = q[2] * s, z = q[3] * s;
  const T wx = q[0] * x, wy = q[0] * y, wz = q[0] * z;
  const T xx = q[1] * x, xy = q[1] * y, xz = q[1] * z;
  const T yy = q[2] * y, yz = q[2] * z, zz = q[3] * z;
  Matrix3T<T> r;
  r << T(1) - (yy + zz), xy - wz, xz + wy, xy + wz, T(1) - (xx + zz), yz - wx, xz - wy, yz + wx, T(1) - (xx + yy);
  return r;
}

/// Which of the quaternion's components w x y z is greatest in size, by the matrix: 0 to 3. It is at least 1/2.
template <typename T>
inline int greatest_component(const Matrix3T<T>& r) {
  // 4 w^2 = 1 + trace, 4 x_k^2 = 1 - trace + 2 r_kk.
  int greatest = 0;
  T most = r.trace();
  for (int k = 0; k < 3; ++k) {
    if (r(k, k) > most) {
      most = r(k, k);
      greatest = k + 1;
    }
  }
  return greatest;
}

/// A quaternion of a rotation matrix, two to four units long, of either sign: four times its greatest
/// component, from the diagonal, times each of the components, so that no case is singular (K-I-4.5.3). For all that
/// does not depend on a quaternion's length.
template <typename T>
inline Vector4T<T> long_quaternion_of_rotation(const Matrix3T<T>& r) {
  switch (greatest_component<T>(r)) {
    case 0: return {T(1) + r.trace(), r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)};
    case 1: return {r(2, 1) - r(1, 2), T(1) + r(0, 0) - r(1, 1) - r(2, 2), r(0, 1) + r(1, 0), r(0, 2) + r(2, 0)};
    case 2: return {r(0, 2) - r(2, 0), r(0, 1) + r(1, 0), T(1) + r(1, 1) - r(2, 2) - r(0, 0), r(1, 2) + r(2, 1)};
    default: return {r(1, 0) - r(0, 1), r(0, 2) + r(2, 0), r(1, 2) + r(2, 1), T(1) + r(2, 2) - r(0, 0) - r(1, 1)};
  }
}

/// Unit quaternion of a rotation matrix, with w >= 0 (K-I-4.5.3). A matrix that is orthonormal only to some digits
/// gives a quaternion that is right to as many.
template <typename T>
inline Vector4T<T> quaternion_of_rotation(const Matrix3T<T>& r) {
  using std::sqrt;
  const Vector4T<T> q = long_quaternion_of_rotation<T>(r);
  // Number by number: what was just stored by ones is slow to load by twos.
  const T norm = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  const T factor = T(1) / (q[0] < T(0) ? T(-norm) : norm);
  return {factor * q[0], factor * q[1], factor * q[2], factor * q[3]};
}

/// q or -q, which are the same rotation: the one nearer to the previous quaternion, so that a motion has no jump
/// (K-I-4.5.3).
template <typename T>
Vector4T<T> near(const Vector4T<T>& q, const Vector4T<T>& previous) {
  return q.dot(previous) < T(0) ? Vector4T<T>(-q) : q;
}

}  // namespace koppel
