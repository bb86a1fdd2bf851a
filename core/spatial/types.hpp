// Fixed-size vectors and matrices, templated on the scalar, and the skew operator.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace koppel {

// In this room small functions in inner loops are declared inline although templates need it not: GCC then inlines
// larger ones, and results of three or four numbers stay in registers. On their way through memory they cost more than
// they do.

template <typename T>
using Vector3T = Eigen::Matrix<T, 3, 1>;
template <typename T>
using Vector4T = Eigen::Matrix<T, 4, 1>;
template <typename T>
using Vector6T = Eigen::Matrix<T, 6, 1>;
template <typename T>
using Matrix3T = Eigen::Matrix<T, 3, 3>;
template <typename T>
using Matrix6T = Eigen::Matrix<T, 6, 6>;

using Vector3 = Vector3T<double>;
using Vector4 = Vector4T<double>;
using Vector6 = Vector6T<double>;
using Matrix3 = Matrix3T<double>;
using Matrix6 = Matrix6T<double>;

/// The distance from 1 to the next number of the type, 2^-52 for double; for a number with derivatives that of its
/// values.
template <typename T>
T epsilon() {
  return Eigen::NumTraits<T>::epsilon();
}

/// A constant in the precision of the scalar.
template <typename T>
T constant(long double value) {
  if constexpr (requires { T{value}; }) {
    return T{value};
  } else {
    return T(static_cast<double>(value));
  }
}

/// Below this part of the whole, nothing is left of a quantity but rounding: what depends on it is undetermined.
template <typename T>
T rounding_floor() {
  return T(4) * epsilon<T>();
}

/// The matrix of the cross product: skew(a) b = a x b (C-7, K-I-2.2.3).
template <typename Derived>
Matrix3T<typename Derived::Scalar> skew(const Eigen::MatrixBase<Derived>& a) {
  using T = typename Derived::Scalar;
  Matrix3T<T> m;
  m << T(0), -a.z(), a.y(), a.z(), T(0), -a.x(), -a.y(), a.x(), T(0);
  return m;
}

/// The vector of the skew part of a matrix: axial(skew(a)) = a; the symmetric part does not count (K-I-3.2.2).
template <typename Derived>
Vector3T<typename Derived::Scalar> axial(const Eigen::MatrixBase<Derived>& m) {
  using T = typename Derived::Scalar;
  return T(0.5) * Vector3T<T>(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1));
}

}  // namespace koppel
