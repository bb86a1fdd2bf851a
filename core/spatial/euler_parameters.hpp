// Euler parameters: the unit quaternion w x y z of a rotation. Four numbers with one constraint, singular nowhere; q
// and -q are the same rotation (K-I-4.5.2).
#pragma once

#include "spatial/rotation_coordinates.hpp"

namespace koppel {

struct EulerParameters {
  static constexpr int size = 4;

  /// The argument itself, not a copy.
  template <typename T>
  static const Vector4T<T>& quaternion(const Vector4T<T>& q) {
    return q;
  }

  template <typename T>
  static Extracted<T, 4> of_quaternion(const Vector4T<T>& q) {
    return {q};
  }

  template <typename T>
  static Vector4T<T> twin(const Vector4T<T>& q) {
    return -q;
  }

  /// |q|^2 - 1. Its rate 2 q . dq/dt is the first row that H leaves out.
  template <typename T>
  static Eigen::Matrix<T, 1, 1> constraints(const Vector4T<T>& q) {
    return Eigen::Matrix<T, 1, 1>(q.squaredNorm() - T(1));
  }

  /// omega = 2 dq/dt conj(q) in base axes, 2 conj(q) dq/dt in body axes (K-I-4.5.5).
  template <typename T>
  static Eigen::Matrix<T, 3, 4> h_matrix(const Vector4T<T>& q, Axes axes) {
    const Vector4T<T> c = conjugate<T>(q);
    return T(2) * (axes == Axes::base ? right_factor<T>(c) : left_factor<T>(c)).template bottomRows<3>();
  }

  /// dq/dt = 1/2 omega q in base axes, 1/2 q omega in body axes (K-I-4.5.5). Never empty.
  template <typename T>
  static std::optional<Eigen::Matrix<T, 4, 3>> k_matrix(const Vector4T<T>& q, Axes axes) {
    return T(0.5) * (axes == Axes::base ? right_factor<T>(q) : left_factor<T>(q)).template rightCols<3>();
  }
};

}  // namespace koppel
