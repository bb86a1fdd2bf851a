// Axis and angle, the natural invariants of a rotation: x = [u; angle], unit axis and angle [rad]. Four numbers with
// one constraint; the axis is undetermined at the identity (K-I-4.2.1a).
#pragma once

#include "spatial/rotation.hpp"
#include "spatial/rotation_coordinates.hpp"
#include "spatial/vector.hpp"

namespace koppel {

struct AxisAngle {
  static constexpr int size = 4;

  template <typename T>
  static Matrix3T<T> rotation(const Vector4T<T>& x) {
    return rotation_about<T>(x.template head<3>(), x[3]);
  }

  template <typename T>
  static Vector4T<T> quaternion(const Vector4T<T>& x) {
    using std::cos, std::sin;
    const T half = x[3] / T(2);
    return (Vector4T<T>() << cos(half), sin(half) * x.template head<3>()).finished();
  }

  /// Angle in [0, pi]. At the identity the axis is the previous one that the caller may give; it is singular there, and
  /// while the angle is nothing but rounding (K-I-4.2.2).
  template <typename T>
  static Extracted<T, 4> of_quaternion(const Vector4T<T>& q, const Vector3T<T>& previous = Vector3T<T>::UnitZ()) {
    using std::atan2, std::sqrt;
    const T w = q[0] < T(0) ? T(-q[0]) : q[0];
    const T sine = sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    // Shorter vectors have lost digits by being squared.
    if (sine < T(1e-140))
      return of_tiny<T>(w, q[0] < T(0) ? Vector3T<T>(-q.template tail<3>()) : q.template tail<3>(), previous);
    const T scale = q[0] < T(0) ? T(T(-1) / sine) : T(T(1) / sine);
    return {{scale * q[1], scale * q[2], scale * q[3], T(2) * atan2(sine, w)}, sine <= rounding_floor<T>() * w};
  }

  template <typename T>
  static Extracted<T, 4> of_rotation(const Matrix3T<T>& r) {
    return of_quaternion<T>(long_quaternion_of_rotation<T>(r));
  }

  template <typename T>
  static Vector4T<T> twin(const Vector4T<T>& x) {
    return -x;
  }

  /// |u|^2 - 1.
  template <typename T>
  static Eigen::Matrix<T, 1, 1> constraints(const Vector4T<T>& x) {
    return Eigen::Matrix<T, 1, 1>(x.template head<3>().squaredNorm() - T(1));
  }

  /// omega = angle' u + sin(angle) u' +- (1 - cos(angle)) u x u', + in base and - in body axes (K-I-4.2.4).
  template <typename T>
  static Eigen::Matrix<T, 3, 4> h_matrix(const Vector4T<T>& x, Axes axes) {
    using std::sin;
    const Vector3T<T> u = x.template head<3>();
    const T half = sin(x[3] / T(2)), versine = T(2) * half * half;
    Eigen::Matrix<T, 3, 4> h;
    h << sin(x[3]) * Matrix3T<T>::Identity() + (axes == Axes::base ? versine : T(-versine)) * skew(u), u;
    return h;
  }

  /// angle' = u . omega, u' = 1/2 (cot(angle/2) (1 - u u^T) -+ skew(u)) omega, - in base and + in body axes. Empty at
  /// angle 0 and full turns (K-I-4.2.4).
  template <typename T>
  static std::optional<Eigen::Matrix<T, 4, 3>> k_matrix(const Vector4T<T>& x, Axes axes) {
    using std::abs, std::cos, std::sin;
    const Vector3T<T> u = x.template head<3>();
    const T half = x[3] / T(2), sine = sin(half);
    if (abs(sine) <= rounding_floor<T>()) return std::nullopt;
    const T cotangent = cos(half) / sine / T(2);
    Eigen::Matrix<T, 4, 3> k;
    k << rotation_terms<T>(cotangent, -cotangent * u, u, T(axes == Axes::base ? -0.5 : 0.5) * u), u.transpose();
    return k;
  }

 private:
  template <typename T>
  static Extracted<T, 4> of_tiny(const T& w, const Vector3T<T>& v, const Vector3T<T>& previous) {
    using std::atan2;
    const auto p = polar<T>(v);
    Extracted<T, 4> result{{previous.x(), previous.y(), previous.z(), T(0)}, true};
    if (p) result.coordinates << p->direction, T(2) * atan2(p->length, w);
    return result;
  }
};

}  // namespace koppel
