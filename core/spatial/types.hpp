// Fixed-size vectors and matrices, templated on the scalar, and the skew operator.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace koppel {

template <typename T>
using Vector3T = Eigen::Matrix<T, 3, 1>;
template <typename T>
using Vector4T = Eigen::Matrix<T, 4, 1>;
template <typename T>
using Vector6T = Eigen::Matrix<T, 6, 1>;
template <typename T>
using Matrix3T = Eigen::Matrix<T, 3, 3>;

using Vector3 = Vector3T<double>;
using Vector4 = Vector4T<double>;
using Vector6 = Vector6T<double>;
using Matrix3 = Matrix3T<double>;

/// The matrix of the cross product: skew(a) b = a x b (C-7).
template <typename Derived>
Matrix3T<typename Derived::Scalar> skew(const Eigen::MatrixBase<Derived>& a) {
  using T = typename Derived::Scalar;
  Matrix3T<T> m;
  m << T(0), -a.z(), a.y(), a.z(), T(0), -a.x(), -a.y(), a.x(), T(0);
  return m;
}

}  // namespace koppel
