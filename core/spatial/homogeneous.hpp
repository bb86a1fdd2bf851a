// Homogeneous coordinates: points with a fourth coordinate of one, directions with zero, poses as 4x4 matrices.
#pragma once

#include <optional>

#include "spatial/pose.hpp"

namespace koppel {

template <typename T>
using Matrix4T = Eigen::Matrix<T, 4, 4>;
using Matrix4 = Matrix4T<double>;

/// [p; 1]: a point at p [m], which a pose turns and shifts (C-16, K-I-3.3.1).
template <typename T>
Vector4T<T> homogeneous_point(const Vector3T<T>& p) {
  return {p.x(), p.y(), p.z(), T(1)};
}

/// [d; 0]: a free vector such as a direction or a velocity, which a pose only turns (C-16, K-I-3.3.1).
template <typename T>
Vector4T<T> homogeneous_direction(const Vector3T<T>& d) {
  return {d.x(), d.y(), d.z(), T(0)};
}

/// [[R, p], [0, 1]]: the matrix of X_AB. Products and inverses are those of the poses (K-I-3.3.1).
template <typename T>
Matrix4T<T> homogeneous_matrix(const PoseT<T>& x_ab) {
  Matrix4T<T> m = Matrix4T<T>::Identity();
  m.template topLeftCorner<3, 3>() = x_ab.rotation;
  m.template topRightCorner<3, 1>() = x_ab.position;
  return m;
}

/// The pose of a homogeneous matrix. Empty if the last row is not (0, 0, 0, 1), the one to rounding; whether the
/// rotation is one is not asked (K-I-3.3.1).
template <typename T>
std::optional<PoseT<T>> pose_of_homogeneous(const Matrix4T<T>& m) {
  using std::abs;
  const bool affine = m(3, 0) == T(0) && m(3, 1) == T(0) && m(3, 2) == T(0);
  if (!affine || !(abs(m(3, 3) - T(1)) <= rounding_floor<T>())) return std::nullopt;
  return PoseT<T>{m.template topLeftCorner<3, 3>(), m.template topRightCorner<3, 1>()};
}

}  // namespace koppel
