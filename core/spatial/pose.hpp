// Poses: where a frame lies in another one.
#pragma once

#include "spatial/types.hpp"

namespace koppel {

/// X_AB: rotation R_AB and position of B's origin in A [m].
template <typename T>
struct PoseT {
  Matrix3T<T> rotation = Matrix3T<T>::Identity();
  Vector3T<T> position = Vector3T<T>::Zero();

  /// X_AC = X_AB * X_BC (C-3).
  PoseT operator*(const PoseT& other) const {
    return {rotation * other.rotation, position + rotation * other.position};
  }
  /// The point with coordinates p in B, in A.
  Vector3T<T> operator*(const Vector3T<T>& p) const { return position + rotation * p; }
  PoseT inverse() const { return {rotation.transpose(), -(rotation.transpose() * position)}; }
};

using Pose = PoseT<double>;

/// X_BC = X_AB^-1 X_AC, formed from differences so that a far origin costs no digits.
template <typename T>
PoseT<T> relative_pose(const PoseT<T>& b, const PoseT<T>& c) {
  return {b.rotation.transpose() * c.rotation, b.rotation.transpose() * (c.position - b.position)};
}

}  // namespace koppel
