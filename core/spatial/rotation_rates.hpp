// Rates of a rotation matrix R_AB, and the angular velocity and acceleration of B in A: each from the other.
#pragma once

#include "spatial/types.hpp"

namespace koppel {

/// Angular velocity [rad/s] of B in A, in A's axes, from R_AB and its rate [1/s]: the vector of dR/dt R^T. That is skew
/// as long as R is orthogonal; a symmetric part, by which R would cease to be so, does not count (K-I-3.2.2).
template <typename T>
Vector3T<T> angular_velocity(const Matrix3T<T>& r_ab, const Matrix3T<T>& rate) {
  return axial(rate * r_ab.transpose());
}

/// Angular acceleration [rad/s^2] of B in A, in A's axes, from R_AB and its second rate [1/s^2]: the vector of
/// d2R/dt2 R^T + dR/dt dR/dt^T. The second term is symmetric and does not count, hence no first rate is asked for
/// (K-I-3.2.3).
template <typename T>
Vector3T<T> angular_acceleration(const Matrix3T<T>& r_ab, const Matrix3T<T>& second_rate) {
  return axial(second_rate * r_ab.transpose());
}

/// dR_AB/dt [1/s] from the angular velocity [rad/s] of B in A, in A's axes: Poisson's equation skew(omega) R
/// (K-I-4.1.2).
template <typename T>
Matrix3T<T> rotation_rate(const Matrix3T<T>& r_ab, const Vector3T<T>& omega) {
  return skew(omega) * r_ab;
}

/// The same from the components of the angular velocity in B's axes: R skew(omega_B) (K-I-4.1.2).
template <typename T>
Matrix3T<T> rotation_rate_in_body_axes(const Matrix3T<T>& r_ab, const Vector3T<T>& omega_b) {
  return r_ab * skew(omega_b);
}

/// d2R_AB/dt2 [1/s^2] from angular velocity [rad/s] and acceleration [rad/s^2] of B in A, in A's axes:
/// (skew(alpha) + skew(omega)^2) R, so that a vector rho fixed in B has the second derivative
/// alpha x rho + omega x (omega x rho) (K-I-3.2.3, K-I-4.1.2).
template <typename T>
Matrix3T<T> rotation_second_rate(const Matrix3T<T>& r_ab, const Vector3T<T>& omega, const Vector3T<T>& alpha) {
  return skew(alpha) * r_ab + skew(omega) * rotation_rate<T>(r_ab, omega);
}

}  // namespace koppel
