// Three successive turns about coordinate axes that are carried along: R = R_i(a) R_j(b) R_k(c), all twelve sequences
// (K-I-4.3.0). First axis and third the same: Euler angles. Three different axes: Cardan (Tait-Bryan) angles.
#pragma once

#include <cmath>
#include <optional>

#include "spatial/rotation_coordinates.hpp"
#include "spatial/vector.hpp"

namespace koppel {

/// The sequence about the axes i, j, k (0 = x, 1 = y, 2 = z; K-I-4.3.0). Coordinates: the three angles [rad] in the
/// order of the turns. The same angles in reverse order, about the axes k, j, i that stay fixed, make the same
/// rotation.
///
/// Singular where first and third axis fall together (gimbal lock): middle angle 0 or pi for Euler, +-pi/2 for Cardan
/// angles. There only the sum or difference of the two outer angles is determined; where rounding leaves no more than
/// that, the third is 0.
template <int i, int j, int k>
struct AngleSequence {
  static_assert(i != j && j != k, "two successive turns about one axis are one turn");
  static constexpr int size = 3;
  static constexpr bool is_euler = i == k;
  /// The axis that is neither of the first two, and the sign with which e_i x e_j points along it.
  static constexpr int other = 3 - i - j;
  static constexpr int parity = (j - i + 3) % 3 == 1 ? 1 : -1;

  template <typename T>
  static Matrix3T<T> rotation(const Vector3T<T>& angles) {
    Matrix3T<T> r = Matrix3T<T>::Identity();
    turn<i>(r, angles[0]);
    turn<j>(r, angles[1]);
    turn<k>(r, angles[2]);
    return r;
  }

  template <typename T>
  static Vector4T<T> quaternion(const Vector3T<T>& angles) {
    using std::cos, std::sin;
    const T c1 = cos(angles[0] / T(2)), s1 = sin(angles[0] / T(2));
    const T c2 = cos(angles[1] / T(2)), s2 = sin(angles[1] / T(2));
    const T c3 = cos(angles[2] / T(2)), s3 = sin(angles[2] / T(2));
    const T p(parity);
    Vector4T<T> q;
    if constexpr (is_euler) {
      q[0] = c2 * (c1 * c3 - s1 * s3);
      q[1 + i] = c2 * (s1 * c3 + c1 * s3);
      q[1 + j] = s2 * (c1 * c3 + s1 * s3);
      q[1 + other] = p * s2 * (s1 * c3 - c1 * s3);
    } else {
      q[0] = c1 * c2 * c3 - p * s1 * s2 * s3;
      q[1 + i] = s1 * c2 * c3 + p * c1 * s2 * s3;
      q[1 + j] = c1 * s2 * c3 - p * s1 * c2 * s3;
      q[1 + k] = c1 * c2 * s3 + p * s1 * s2 * c3;
    }
    return q;
  }

  /// Outer angles in (-pi, pi]; the middle one in [0, pi] for Euler, in [-pi/2, pi/2] for Cardan angles (K-I-4.3.1,
  /// K-I-4.4.1). The angles make the rotation to rounding however near to gimbal lock they are; singular is set where
  /// nothing but rounding is left of the sine (cosine) of the middle angle.
  template <typename T>
  static Extracted<T, 3> of_quaternion(const Vector4T<T>& q) {
    using std::atan2, std::sqrt;
    const Vector4T<T> p = amplitudes<T>(q);
    const T in = p.template head<2>().norm(), out = p.template tail<2>().norm();
    T middle;
    if constexpr (is_euler) {
      middle = T(2) * atan2(out, in);
    } else {
      middle = atan2(T(2) * (q[0] * q[1 + j] + T(parity) * q[1 + i] * q[1 + k]), in * out);
    }
    // Twice the product of both is the sine, or cosine, of the middle angle.
    const T lesser = in < out ? in : out, whole = in + out;
    T sum = atan2(p[1], p[0]), difference = atan2(p[3], p[2]);
    if (lesser <= epsilon<T>() * whole) (in < out ? sum : difference) = in < out ? difference : sum;
    const bool singular = T(2) * lesser <= rounding_floor<T>() * whole;
    return {{wrapped<T>(sum + difference), middle, wrapped<T>(T(is_euler ? 1 : parity) * (sum - difference))},
            singular};
  }

  /// The same of a matrix: by its entries, of which the small ones are exact where the quaternion's are not, near
  /// gimbal lock (K-I-4.3.1, K-I-4.4.1).
  template <typename T>
  static Extracted<T, 3> of_rotation(const Matrix3T<T>& r) {
    using std::atan2, std::cos, std::hypot, std::sin;
    const T p(parity);
    const T lever = is_euler ? hypot(r(i, j), r(i, other)) : hypot(r(i, i), r(i, j));
    const T middle = is_euler ? atan2(lever, r(i, i)) : atan2(T(p * r(i, other)), lever);
    const bool singular = lever <= rounding_floor<T>();
    if (lever <= rounding_floor<T>() / T(2)) {
      return {{atan2(T(p * r(other, j)), r(j, j)), middle, T(0)}, true};
    }
    const T first = is_euler ? atan2(r(j, i), T(-p * r(other, i))) : atan2(T(-p * r(j, other)), r(other, other));
    // The rest after the first turn: so the three together make the matrix, however uncertain the first may be.
    const T c = cos(first), s = p * sin(first);
    const T along = c * r(j, j) + s * r(other, j);
    const T across =
        is_euler ? T(-p * (c * r(j, other) + s * r(other, other))) : T(p * (c * r(j, i) + s * r(other, i)));
    return {{first, middle, atan2(across, along)}, singular};
  }

  /// The other angles of the same rotation, those of the other configuration of the chain of three revolute joints
  /// (K-I-4.3.1, K-I-4.4.1). Outer angles in (-pi, pi].
  template <typename T>
  static Vector3T<T> twin(const Vector3T<T>& angles) {
    const T pi = constants::pi<T>();
    return {wrapped<T>(angles[0] + pi), wrapped<T>(is_euler ? T(-angles[1]) : T(pi - angles[1])),
            wrapped<T>(angles[2] + pi)};
  }

  /// 1 / |sine (Euler) or cosine (Cardan) of the middle angle|: how much K enlarges an error of the angular velocity
  /// (K-I-4.3.2, K-I-4.4.2). Without bound towards gimbal lock.
  template <typename T>
  static T condition(const Vector3T<T>& angles) {
    using std::abs;
    return T(1) / abs(volume<T>(angles));
  }

  /// Columns: the three axes of rotation (K-I-4.3.2, K-I-4.4.2).
  template <typename T>
  static Matrix3T<T> h_matrix(const Vector3T<T>& angles, Axes axes) {
    Matrix3T<T> r = Matrix3T<T>::Identity(), h;
    h.col(0) = r.col(i);
    turn<i>(r, angles[0]);
    h.col(1) = r.col(j);
    turn<j>(r, angles[1]);
    h.col(2) = r.col(k);
    if (axes == Axes::base) return h;
    turn<k>(r, angles[2]);
    return r.transpose() * h;
  }

  /// Empty in gimbal lock, to rounding (K-I-4.3.2, K-I-4.4.2).
  template <typename T>
  static std::optional<Matrix3T<T>> k_matrix(const Vector3T<T>& angles, Axes axes) {
    using std::abs;
    const T det = volume<T>(angles);
    if (abs(det) <= rounding_floor<T>()) return std::nullopt;
    // The middle axis is of length one and across both others.
    const Matrix3T<T> h = h_matrix<T>(angles, axes);
    Matrix3T<T> m;
    m << (h.col(1).cross(h.col(2)) / det).transpose(), h.col(1).transpose(),
        (h.col(0).cross(h.col(1)) / det).transpose();
    return m;
  }

 private:
  /// The quaternion as cosine and sine of the half sum of the outer angles, and of their half difference, each pair
  /// times an amplitude that the middle angle determines.
  template <typename T>
  static Vector4T<T> amplitudes(const Vector4T<T>& q) {
    const T last = T(parity) * q[1 + other];
    if constexpr (is_euler) {
      return {q[0], q[1 + i], q[1 + j], last};
    } else {
      return {q[0] + q[1 + j], q[1 + i] + last, q[0] - q[1 + j], q[1 + i] - last};
    }
  }
  /// Triple product of the three axes: the determinant of H.
  template <typename T>
  static T volume(const Vector3T<T>& angles) {
    using std::cos, std::sin;
    // e_i . (e_j x R_j e_i) and e_i . (e_j x R_j e_k)
    return is_euler ? T(-sin(angles[1])) : T(T(parity) * cos(angles[1]));
  }
  /// R <- R R_axis(angle): turns two columns.
  template <int axis, typename T>
  static void turn(Matrix3T<T>& r, const T& angle) {
    using std::cos, std::sin;
    constexpr int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const T c = cos(angle), s = sin(angle);
    const Vector3T<T> old = r.col(u);
    r.col(u) = c * old + s * r.col(v);
    r.col(v) = c * r.col(v) - s * old;
  }
};

/// Euler angles psi, Theta, Phi of R = Rz(psi) Rx(Theta) Rz(Phi) (C-9, K-I-4.3.1).
using EulerAngles = AngleSequence<2, 0, 2>;
/// Cardan angles alpha, beta, gamma of R = Rx(alpha) Ry(beta) Rz(gamma) (C-9, K-I-4.4.1).
using CardanAngles = AngleSequence<0, 1, 2>;
/// Yaw, pitch, roll of R = Rz(yaw) Ry(pitch) Rx(roll), as vehicles have them (ISO 8855).
using YawPitchRoll = AngleSequence<2, 1, 0>;

}  // namespace koppel
