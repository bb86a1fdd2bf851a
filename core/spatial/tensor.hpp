// Second-order tensors: dyads, contractions, projectors, and the coordinates of vectors and tensors in another frame.
// As coordinates in one orthonormal frame they are simply matrices.
#pragma once

#include "spatial/types.hpp"

namespace koppel {

/// The dyadic product D = a o b: coordinates a_k b_l, of rank one. As a map, dyad(a, b) r = a (b . r): it pulls a
/// vector out of a scalar product (K-I-2.2.1, K-I-2.2.3, K-I-2.2.5).
template <typename T>
Matrix3T<T> dyad(const Vector3T<T>& a, const Vector3T<T>& b) {
  return a * b.transpose();
}

/// The contraction of two vectors a . b, of a tensor with a vector D . r, and of a vector with a tensor r . D: orders m
/// and n give m + n - 2 (K-I-2.2.2).
///
/// What is written of vectors and tensors, and what of their coordinates in any one orthonormal frame (K-I-2.2.5):
///
///     lambda = a . b    contraction(a, b)
///     s = Q . r         contraction(q, r)
///     v = a x b         contraction(skew(a), b), the same as a.cross(b)
///     D = a o b         dyad(a, b)
template <typename T>
T contraction(const Vector3T<T>& a, const Vector3T<T>& b) {
  return a.dot(b);
}

template <typename T>
Vector3T<T> contraction(const Matrix3T<T>& d, const Vector3T<T>& r) {
  return d * r;
}

template <typename T>
Vector3T<T> contraction(const Vector3T<T>& r, const Matrix3T<T>& d) {
  return d.transpose() * r;
}

/// The map of a vector on its part along the unit vector u (K-I-2.2.3).
template <typename T>
Matrix3T<T> projector_along(const Vector3T<T>& u) {
  return dyad<T>(u, u);
}

/// The map of a vector on its part across the unit vector u, -skew(u) skew(u) (K-I-2.2.3).
template <typename T>
Matrix3T<T> projector_across(const Vector3T<T>& u) {
  return -(skew(u) * skew(u));
}

/// The vector v after a turn by R: another vector, in the same frame. The numbers are those of vector_in(), the meaning
/// is not (K-I-3.2.1).
template <typename T>
Vector3T<T> rotated(const Matrix3T<T>& r, const Vector3T<T>& v) {
  return r * v;
}

/// Coordinates in A of the vector that has the coordinates s_b in B: the same vector, in another frame. The numbers are
/// those of rotated(), the meaning is not (K-I-3.2.1).
template <typename T>
Vector3T<T> vector_in(const Matrix3T<T>& r_ab, const Vector3T<T>& s_b) {
  return r_ab * s_b;
}

/// Coordinates in A of the tensor that has the coordinates D_B in B: R_AB D_B R_AB^T (K-I-2.2.4).
template <typename T>
Matrix3T<T> tensor_in(const Matrix3T<T>& r_ab, const Matrix3T<T>& d_b) {
  return r_ab * d_b * r_ab.transpose();
}

}  // namespace koppel
