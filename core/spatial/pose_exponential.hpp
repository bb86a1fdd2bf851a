// The exponential map of poses, its inverse, and the derivatives of both. Its argument [phi; rho] is a twist times a
// time: a body with the constant twist [phi; rho] / t reaches the pose after t.
#pragma once

#include "spatial/dual.hpp"
#include "spatial/pose.hpp"
#include "spatial/rotation_vector.hpp"

namespace koppel {

/// exp of [phi; rho], rotation vector [rad] and translation [m]; phi of any length (M-3.2.2).
template <typename T>
PoseT<T> pose_exp(const Vector6T<T>& x) {
  const Vector3T<T> phi = x.template head<3>(), rho = x.template tail<3>();
  const SincTerms<T> terms = sinc_terms<T>(phi.squaredNorm());
  // J_l rho without the matrix.
  const Vector3T<T> way = terms.sinc * rho + (terms.sinc_defect * phi.dot(rho)) * phi + terms.cosinc * phi.cross(rho);
  return {rotation_terms<T>(terms.cosine, terms.cosinc * phi, phi, terms.sinc * phi), way};
}

/// The shortest [phi; rho] with exp = X: |phi| in [0, pi], rho regular up to and at pi (M-3.2.2).
template <typename T>
Vector6T<T> pose_log(const PoseT<T>& x_ab) {
  const Vector3T<T> phi = rotation_vector_of_rotation<T>(x_ab.rotation);
  return (Vector6T<T>() << phi, left_jacobian_inverse<T>(phi) * x_ab.position).finished();
}

/// 6x6 matrix J_l with exp(x + d) = exp(J_l d) exp(x) to first order: from d(x)/dt to the twist at the base's origin in
/// its axes. The rotations' Jacobian on dual numbers (K-I-6.3).
template <typename T>
Matrix6T<T> pose_left_jacobian(const Vector6T<T>& x) {
  return real_form<T>(left_jacobian<Dual<T>>(dual(x.template head<3>(), x.template tail<3>())));
}

/// exp(x + d) = exp(x) exp(J_r d): from d(x)/dt to the twist at the body's origin in its axes (K-I-6.3).
template <typename T>
Matrix6T<T> pose_right_jacobian(const Vector6T<T>& x) {
  return pose_left_jacobian<T>(-x);
}

/// The inverse of J_l; as that of rotations it grows without bound towards full turns (K-I-6.3).
template <typename T>
Matrix6T<T> pose_left_jacobian_inverse(const Vector6T<T>& x) {
  return real_form<T>(left_jacobian_inverse<Dual<T>>(dual(x.template head<3>(), x.template tail<3>())));
}

/// The inverse of J_r.
template <typename T>
Matrix6T<T> pose_right_jacobian_inverse(const Vector6T<T>& x) {
  return pose_left_jacobian_inverse<T>(-x);
}

}  // namespace koppel
