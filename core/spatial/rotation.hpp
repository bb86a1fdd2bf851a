// Rotation matrices. R_AB maps components in B into A (C-3); as an operator it turns the axes of A into those of B
// (C-4).
#pragma once

#include <cmath>

#include <Eigen/SVD>

#include "spatial/types.hpp"

namespace koppel {

/// diagonal I + a b^T + skew(c), with a parallel to b: the shape of a rotation and of its derivatives.
template <typename T>
inline Matrix3T<T> rotation_terms(const T& diagonal, const Vector3T<T>& a, const Vector3T<T>& b, const Vector3T<T>& c) {
  const T xy = a.x() * b.y(), xz = a.x() * b.z(), yz = a.y() * b.z();
  Matrix3T<T> r;
  r << diagonal + a.x() * b.x(), xy - c.z(), xz + c.y(),  //
      xy + c.z(), diagonal + a.y() * b.y(), yz - c.x(),   //
      xz - c.y(), yz + c.x(), diagonal + a.z() * b.z();
  return r;
}

/// Rotation about the unit vector u by an angle [rad] whose cosine and sine are given: right-handed, regular at every
/// angle. u has the same components in both frames (K-I-4.2.1a).
///
/// Turns compose by the matrix product, which does not commute (K-I-4.2.3a). Each about an axis given in the frame that
/// the turns before it have made, they stand in order: R_02 = R_01 R_12 (K-I-4.2.3b). Each about an axis that stays in
/// the base, the last stands leftmost; an axis that is carried along is turned first, u_2 = R_1 u_20 (K-I-4.2.3c).
template <typename T>
inline Matrix3T<T> rotation_about(const Vector3T<T>& u, const T& cosine, const T& sine) {
  return rotation_terms<T>(cosine, (T(1) - cosine) * u, u, sine * u);
}

template <typename T>
inline Matrix3T<T> rotation_about(const Vector3T<T>& u, const T& angle) {
  using std::cos, std::sin;
  return rotation_about<T>(u, cos(angle), sin(angle));
}

/// How far the columns are from being orthonormal: the greatest entry of |R^T R - I|. Says nothing of handedness
/// (K-I-2.1.3).
template <typename T>
T orthonormality_residual(const Matrix3T<T>& r) {
  return (r.transpose() * r - Matrix3T<T>::Identity()).cwiseAbs().maxCoeff();
}

/// Whether R is a rotation: orthonormal to the tolerance, and right-handed (K-I-2.1.3). False if an entry is not
/// finite.
template <typename T>
bool is_rotation(const Matrix3T<T>& r, const T& tolerance = T(1e-10)) {
  return orthonormality_residual<T>(r) <= tolerance && r.determinant() > T(0);
}

/// The table of angles [rad] in [0, pi] whose cosines are the entries of R_AB: of axis i of A with axis j of B. Where a
/// cosine is near one, the angle comes from the sine (K-I-2.1.3).
template <typename T>
Matrix3T<T> direction_cosine_angles(const Matrix3T<T>& r) {
  using std::atan2, std::hypot;
  Matrix3T<T> angles;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) angles(i, j) = atan2(hypot(r((i + 1) % 3, j), r((i + 2) % 3, j)), r(i, j));
  }
  return angles;
}

/// A rotation found for a matrix that may be none.
template <typename T>
struct NearestRotation {
  Matrix3T<T> rotation;
  T distance;      ///< Frobenius norm of what was changed
  bool ambiguous;  ///< other rotations are as near, to rounding: the two least stretches, the last with its handedness,
                   ///< cancel
};

/// The rotation nearest to M in the Frobenius norm: the orthogonal factor of its polar decomposition, its handedness
/// mended along the direction that matters least (K-I-2.1.3). M must be finite.
template <typename T>
NearestRotation<T> nearest_rotation(const Matrix3T<T>& m) {
  const Eigen::JacobiSVD<Matrix3T<T>> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const bool mirrors = (svd.matrixU() * svd.matrixV().transpose()).determinant() < T(0);
  Vector3T<T> sign(T(1), T(1), mirrors ? T(-1) : T(1));
  const Matrix3T<T> r = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  const Vector3T<T>& sigma = svd.singularValues();
  // The sum of the two least singular values, the last with the sign of the handedness, decides about uniqueness.
  return {r, (m - r).norm(), sigma[1] + sign[2] * sigma[2] <= rounding_floor<T>() * sigma[0]};
}

}  // namespace koppel
