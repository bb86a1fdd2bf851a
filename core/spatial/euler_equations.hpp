// Euler's equations: how a rigid body turns under a moment, or under none.
#pragma once

#include <optional>

#include <Eigen/Cholesky>

#include "spatial/vector.hpp"

namespace koppel {

/// d(omega)/dt [rad/s^2] of a rigid body with the inertia tensor theta [kg m^2] under the moment [N m], both about the
/// centre of mass (or about a point that never moves), all in body axes, in which theta is constant: theta^-1 (moment -
/// omega x theta omega). With the rates of any coordinates of the rotation at this omega these are the equations of the
/// free body. Empty if theta is not positive definite to rounding, as that of a rod, or if the result is not finite
/// (K-I-4.0b).
template <typename T>
std::optional<Vector3T<T>> euler_equations(const Matrix3T<T>& theta, const Vector3T<T>& omega,
                                           const Vector3T<T>& moment) {
  const Eigen::LDLT<Matrix3T<T>> factors(theta);
  const Vector3T<T> pivots = factors.vectorD();
  if (!(pivots.minCoeff() > rounding_floor<T>() * pivots.maxCoeff())) return std::nullopt;
  const Vector3T<T> alpha = factors.solve(moment - omega.cross(theta * omega));
  if (!is_finite<T>(alpha)) return std::nullopt;
  return alpha;
}

}  // namespace koppel
