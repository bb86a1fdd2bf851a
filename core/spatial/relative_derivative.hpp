// Derivatives of one vector in two frames A (base) and B (body), of which B turns in A with the angular velocity omega.
#pragma once

#include "spatial/types.hpp"

namespace koppel {

/// The derivative of s taken in A, from that taken in B: omega x s more. All three and omega [rad/s] in the axes of any
/// one frame. omega itself has the same derivative in both (K-I-5.1a, K-I-5.1d).
template <typename T>
Vector3T<T> derivative_in_base(const Vector3T<T>& s, const Vector3T<T>& derivative_in_body, const Vector3T<T>& omega) {
  return derivative_in_body + omega.cross(s);
}

/// The derivative of s taken in B, from that taken in A: omega x s less (K-I-5.1a, K-I-5.1d).
template <typename T>
Vector3T<T> derivative_in_body(const Vector3T<T>& s, const Vector3T<T>& derivative_in_base, const Vector3T<T>& omega) {
  return derivative_in_base - omega.cross(s);
}

/// Rates of the coordinates of s in A, from its coordinates in B and their rates; omega_b in B's axes. The rates of the
/// coordinates in a frame are the coordinates, in that frame, of the derivative taken in it; those of two frames belong
/// to two different vectors (K-I-5.1b). Hence s is found from its derivative in A by integrating these rates from the
/// initial coordinates in A, and only these (K-I-5.1c).
template <typename T>
Vector3T<T> base_coordinate_rates(const Matrix3T<T>& r_ab, const Vector3T<T>& s_b, const Vector3T<T>& s_b_rates,
                                  const Vector3T<T>& omega_b) {
  return r_ab * derivative_in_base<T>(s_b, s_b_rates, omega_b);
}

/// Rates of the coordinates of s in B, from its coordinates in A and their rates; omega_a in A's axes (K-I-5.1b,
/// K-I-5.1c).
template <typename T>
Vector3T<T> body_coordinate_rates(const Matrix3T<T>& r_ab, const Vector3T<T>& s_a, const Vector3T<T>& s_a_rates,
                                  const Vector3T<T>& omega_a) {
  return r_ab.transpose() * derivative_in_body<T>(s_a, s_a_rates, omega_a);
}

}  // namespace koppel
