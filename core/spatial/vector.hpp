// Vectors: length, direction, angle, components, and unit vectors across a given one.
#pragma once

#include <cmath>
#include <optional>

#include "spatial/types.hpp"

namespace koppel {

/// A vector as length and direction.
template <typename T>
struct Polar {
  T length;
  Vector3T<T> direction;  ///< of length one
};

/// Whether all three components are finite.
template <typename T>
bool is_finite(const Vector3T<T>& v) {
  using std::isfinite;
  return isfinite(v.x()) && isfinite(v.y()) && isfinite(v.z());
}

/// Length and direction of v, whatever its size: neither 1e-300 nor 1e300 loses digits. Empty for the zero vector,
/// which has no direction, and for one that is not finite (K-I-2.1.1).
template <typename T>
std::optional<Polar<T>> polar(const Vector3T<T>& v) {
  if (!is_finite<T>(v)) return std::nullopt;
  const T scale = v.cwiseAbs().maxCoeff();
  if (!(scale > T(0))) return std::nullopt;
  const Vector3T<T> scaled = v / scale;
  const T norm = scaled.norm();
  return Polar<T>{scale * norm, scaled / norm};
}

/// v / |v|. Empty where polar() is.
template <typename T>
std::optional<Vector3T<T>> normalised(const Vector3T<T>& v) {
  const auto p = polar<T>(v);
  if (!p) return std::nullopt;
  return p->direction;
}

/// a x b of two unit vectors. Where they are nearly parallel or nearly opposite, the small result still has all its
/// digits, and is orthogonal to both: the difference of the two is taken first, and is exact.
template <typename T>
Vector3T<T> cross_of_units(const Vector3T<T>& a, const Vector3T<T>& b) {
  const Vector3T<T> apart = a.dot(b) < T(0) ? Vector3T<T>(b + a) : Vector3T<T>(b - a);
  return a.cross(apart);
}

/// Angle between two vectors [rad], in [0, pi], exact to rounding at 0 and at pi as well. Empty if one of them has no
/// direction (K-I-2.1.1, M-2.7).
template <typename T>
std::optional<T> angle_between(const Vector3T<T>& a, const Vector3T<T>& b) {
  using std::atan2;
  const auto u = normalised<T>(a), w = normalised<T>(b);
  if (!u || !w) return std::nullopt;
  const auto across = polar<T>(u->cross(*w));
  return atan2(across ? across->length : T(0), u->dot(*w));
}

/// Components of s along the columns of an orthonormal basis: its orthogonal projections. basis * components(s, basis)
/// is s again (K-I-2.1.2).
template <typename T>
Vector3T<T> components(const Vector3T<T>& s, const Matrix3T<T>& basis) {
  return basis.transpose() * s;
}

/// Two unit vectors that complete the unit vector n to a right-handed frame (t1, t2, n); t1 = normalised(e x n) with e
/// the axis that n has least of.
template <typename T>
Eigen::Matrix<T, 3, 2> tangents(const Vector3T<T>& n) {
  Eigen::Index least = 0;
  n.cwiseAbs().minCoeff(&least);
  Eigen::Matrix<T, 3, 2> t;
  t.col(0) = Vector3T<T>::Unit(least).cross(n).normalized();
  t.col(1) = n.cross(t.col(0));
  return t;
}

}  // namespace koppel
