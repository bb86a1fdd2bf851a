// Rodrigues parameters: axis times the tangent of half the angle. Three numbers without trigonometry; half a turn is
// out of their reach (K-I-4.6.1).
#pragma once

#include "spatial/rotation.hpp"
#include "spatial/rotation_coordinates.hpp"

namespace koppel {

struct RodriguesParameters {
  static constexpr int size = 3;

  template <typename T>
  static Vector4T<T> quaternion(const Vector3T<T>& lambda) {
    using std::sqrt;
    const T w = T(1) / sqrt(T(1) + lambda.squaredNorm());
    return (Vector4T<T>() << w, w * lambda).finished();
  }

  /// Singular at half a turn, to rounding: what is returned there differs from half a turn by less than one unit of
  /// rounding, and is about 1e16 long (K-I-4.6.1).
  template <typename T>
  static Extracted<T, 3> of_quaternion(const Vector4T<T>& q) {
    const T size = q[0] < T(0) ? T(-q[0]) : q[0];
    const T least = epsilon<T>() / T(4) * q.norm();
    const T w = size < least ? least : size;
    const Vector3T<T> v = q.template tail<3>();
    return {(q[0] < T(0) ? Vector3T<T>(-v) : v) / w, size <= T(32) * least};
  }

  /// omega = 2 / (1 + lambda^2) (1 +- skew(lambda)) dlambda/dt, + in base and - in body axes (K-I-4.6.2).
  template <typename T>
  static Matrix3T<T> h_matrix(const Vector3T<T>& lambda, Axes axes) {
    const T factor = T(2) / (T(1) + lambda.squaredNorm());
    return factor * (Matrix3T<T>::Identity() + skew(turned<T>(lambda, axes)));
  }

  /// dlambda/dt = 1/2 (1 + lambda lambda^T -+ skew(lambda)) omega: a polynomial, never empty (K-I-4.6.2).
  template <typename T>
  static std::optional<Matrix3T<T>> k_matrix(const Vector3T<T>& lambda, Axes axes) {
    const Vector3T<T> half = T(0.5) * lambda;
    return rotation_terms<T>(T(0.5), half, lambda, T(-0.5) * turned<T>(lambda, axes));
  }

 private:
  template <typename T>
  static Vector3T<T> turned(const Vector3T<T>& lambda, Axes axes) {
    return axes == Axes::base ? lambda : Vector3T<T>(-lambda);
  }
};

/// The parameters of R(a) R(b), without going by quaternions. Singular, with parameters that are about 1e16 long, where
/// the composition is half a turn (K-I-4.6.1).
template <typename T>
Extracted<T, 3> rodrigues_product(const Vector3T<T>& a, const Vector3T<T>& b) {
  // The quaternions (1, a) and (1, b) need no normalising.
  return RodriguesParameters::of_quaternion<T>((Vector4T<T>() << T(1) - a.dot(b), a + b + a.cross(b)).finished());
}

}  // namespace koppel
