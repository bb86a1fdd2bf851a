// The nine direction cosines as coordinates: the entries of the rotation matrix, column by column, with six constraints
// (K-I-4.1.1). Singular nowhere.
#pragma once

#include "spatial/rotation_coordinates.hpp"

namespace koppel {

struct DirectionCosines {
  static constexpr int size = 9;
  template <typename T>
  using Column = Eigen::Matrix<T, 9, 1>;

  template <typename T>
  static Matrix3T<T> rotation(const Column<T>& x) {
    return x.reshaped(3, 3);
  }

  template <typename T>
  static Vector4T<T> quaternion(const Column<T>& x) {
    return quaternion_of_rotation<T>(rotation<T>(x));
  }

  template <typename T>
  static Extracted<T, 9> of_quaternion(const Vector4T<T>& q) {
    return {rotation_of_quaternion<T>(q).reshaped()};
  }

  /// Entries 11, 22, 33, 12, 13, 23 of R R^T - 1 (K-I-4.1.1).
  template <typename T>
  static Vector6T<T> constraints(const Column<T>& x) {
    const Matrix3T<T> r = rotation<T>(x), m = r * r.transpose() - Matrix3T<T>::Identity();
    return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)};
  }

  /// omega is the axial vector of R' R^T in base axes, of R^T R' in body axes (K-I-3.2.2, K-I-4.1.2).
  template <typename T>
  static Eigen::Matrix<T, 3, 9> h_matrix(const Column<T>& x, Axes axes) {
    const Matrix3T<T> r = rotation<T>(x);
    Eigen::Matrix<T, 3, 9> h;
    // A rate along base axis i in column j: sum over columns c of c x c' / 2, brought to the axes.
    for (int j = 0; j < 3; ++j) {
      const Vector3T<T> c = T(0.5) * r.col(j);
      h.template middleCols<3>(3 * j) = axes == Axes::base ? skew(c) : Matrix3T<T>(r.transpose() * skew(c));
    }
    return h;
  }

  /// R' = skew(omega) R in base axes, R skew(omega) in body axes: the Poisson equations. Never empty (K-I-4.1.2).
  template <typename T>
  static std::optional<Eigen::Matrix<T, 9, 3>> k_matrix(const Column<T>& x, Axes axes) {
    const Matrix3T<T> r = rotation<T>(x);
    Eigen::Matrix<T, 9, 3> k;
    for (int j = 0; j < 3; ++j) {
      const Matrix3T<T> across = -skew(r.col(j));
      k.template middleRows<3>(3 * j) = axes == Axes::base ? across : Matrix3T<T>(across * r);
    }
    return k;
  }
};

}  // namespace koppel
