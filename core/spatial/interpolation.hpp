// Between two rotations: the turn about one fixed axis, at a constant rate.
#pragma once

#include "spatial/rotation_vector.hpp"

namespace koppel {

/// A rotation, or a pose, on the way from one to another.
template <typename Value>
struct Interpolated {
  Value value;
  bool ambiguous;  ///< half a turn lies between them, to rounding: the other way round is as short
};

/// The unit quaternion at a fraction of the shorter way: 0 gives the first rotation, 1 the second (or its negative),
/// others continue the turn beyond. Turning the base frame turns the result.
template <typename T>
Interpolated<Vector4T<T>> interpolated(const Vector4T<T>& from, const Vector4T<T>& to, const T& fraction) {
  const Vector4T<T> between = quaternion_product<T>(conjugate<T>(from), to);
  const Vector3T<T> phi = fraction * rotation_vector_of_quaternion<T>(between);
  const T w = between[0] < T(0) ? T(-between[0]) : between[0];
  return {quaternion_product<T>(from, quaternion_of_rotation_vector<T>(phi)), w <= rounding_floor<T>()};
}

/// The same for rotation matrices.
template <typename T>
Interpolated<Matrix3T<T>> interpolated(const Matrix3T<T>& from, const Matrix3T<T>& to, const T& fraction) {
  const Vector4T<T> start = Vector4T<T>::Unit(0);
  const auto turn = interpolated<T>(start, quaternion_of_rotation<T>(from.transpose() * to), fraction);
  return {from * rotation_of_quaternion<T>(turn.value), turn.ambiguous};
}

}  // namespace koppel
