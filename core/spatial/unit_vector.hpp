// Unit vectors as coordinates of joints: the axes along which their rates count.
#pragma once

#include "spatial/vector.hpp"

namespace koppel {

/// Two unit vectors that complete the unit vector n to a right-handed frame (t1, t2, n): x and y after the shortest
/// turn that takes z to n. They change smoothly with n but at n = -z, where they are x and -y. (tangents() jumps in
/// many places, which fixed axes do not mind.)
template <typename T>
Eigen::Matrix<T, 3, 2> rate_axes(const Vector3T<T>& n) {
  const T x = n[0], y = n[1], z = n[2], across = x * x + y * y;
  Eigen::Matrix<T, 3, 2> t;
  if (z < T(0) && across < T(1e-300)) {
    t << T(1), T(0), T(0), T(-1), T(0), T(0);
    return t;
  }
  // 1 / (1 + z), without its cancellation.
  const T f = z > T(0) ? T(1) / (T(1) + z) : (T(1) - z) / across;
  t << T(1) - f * x * x, -f * x * y, -f * x * y, T(1) - f * y * y, -x, -y;
  return t;
}

}  // namespace koppel
