// Principal moments and axes of inertia tensors, and whether mass properties can be those of a rigid body. For plain
// numbers: principal axes have no derivative where two moments are equal.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Eigenvalues>

#include "spatial/spatial_inertia.hpp"
#include "spatial/vector.hpp"

namespace koppel {

/// Principal moments [kg m^2], ascending, and principal axes as columns of a rotation.
template <typename T>
struct PrincipalInertiaT {
  Vector3T<T> moments;
  Matrix3T<T> axes;
};

using PrincipalInertia = PrincipalInertiaT<double>;

/// Principal moments and axes of a symmetric tensor [kg m^2] (the lower half is read), of any size. Where moments are
/// equal the axes are some of those possible. Empty if an entry is not finite.
template <typename T>
std::optional<PrincipalInertiaT<T>> principal_inertia(const Matrix3T<T>& tensor) {
  if (!tensor.allFinite()) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Matrix3T<T>> solver(tensor);
  if (solver.info() != Eigen::Success) return std::nullopt;
  PrincipalInertiaT<T> principal{solver.eigenvalues(), solver.eigenvectors()};
  principal.axes.col(2) = principal.axes.col(0).cross(principal.axes.col(1));
  return principal;
}

/// What is wrong with mass properties.
enum class InertiaFault {
  none,
  not_finite,
  negative_mass,
  inertia_without_mass,
  not_symmetric,
  not_positive_semidefinite,  ///< a principal moment is negative
  triangle_inequality,  ///< a principal moment exceeds the sum of the others: mass would have to be negative somewhere
};

/// The verdict, and how clear it is: the least of the principal second moments of the mass (half the sum of two
/// principal moments less the third) as part of the greatest principal moment. From 0 (the body is flat, or a rod or a
/// point) to 1/2 (all principal moments are equal); negative by what is missing. Where the tensor is not symmetric,
/// minus the greatest difference as part of the greatest entry; where the fault comes before the tensor, -1.
template <typename T>
struct InertiaValidityT {
  InertiaFault fault = InertiaFault::none;
  T margin = T(0);

  bool is_valid() const { return fault == InertiaFault::none; }
};

using InertiaValidity = InertiaValidityT<double>;

/// Whether a rigid body can have these mass properties: the mass is not negative, and the tensors of inertia and of
/// second moments, tr(I)/2 E - I, are positive semidefinite. Independent of frame and units. Missing margin up to the
/// slack is taken for rounding: give more where the numbers come from a file with few digits.
template <typename T, typename Frame>
InertiaValidityT<T> validity(const SpatialInertiaT<T, Frame>& inertia, const T& slack = T(8) * rounding_floor<T>()) {
  using std::isfinite;
  const Matrix3T<T>& tensor = inertia.about_centre;
  if (!isfinite(inertia.mass) || !is_finite<T>(inertia.centre) || !tensor.allFinite()) {
    return {InertiaFault::not_finite, T(-1)};
  }
  if (inertia.mass < T(0)) return {InertiaFault::negative_mass, T(-1)};
  const T size = tensor.cwiseAbs().maxCoeff();
  if (size == T(0)) return {};
  if (inertia.mass == T(0)) return {InertiaFault::inertia_without_mass, T(-1)};
  const T asymmetry = (tensor - tensor.transpose()).cwiseAbs().maxCoeff() / size;
  if (asymmetry > slack) return {InertiaFault::not_symmetric, -asymmetry};

  const auto principal = principal_inertia<T>(tensor);
  if (!principal) return {InertiaFault::not_finite, T(-1)};
  const Vector3T<T>& moments = principal->moments;
  const T greatest = moments.cwiseAbs().maxCoeff();
  const T margin = (moments[0] + moments[1] - moments[2]) / (T(2) * greatest);
  if (moments[0] < -slack * greatest) return {InertiaFault::not_positive_semidefinite, margin};
  if (margin < -slack) return {InertiaFault::triangle_inequality, margin};
  return {InertiaFault::none, margin};
}

}  // namespace koppel
