// Screws: dual vectors a + eps a' in general. The real part is a direction with a size; the dual part is a moment and
// belongs to a reference point, the origin of the frame in which both are written. Velocities and forces of a rigid
// body are of this kind.
#pragma once

#include <limits>

#include "spatial/line.hpp"
#include "spatial/twist.hpp"
#include "spatial/vector.hpp"

namespace koppel {

/// What a dual vector is.
enum class ScrewKind {
  zero,
  free_vector,  ///< without a real part: a couple, a translation; it has a direction, but no line
  line,         ///< without pitch: a force along its line, a rotation about it
  screw,
};

/// The same for motions, finite and instantaneous.
enum class MotionKind { rest, translation, rotation, screw };

constexpr MotionKind motion_kind(ScrewKind kind) {
  switch (kind) {
    case ScrewKind::zero: return MotionKind::rest;
    case ScrewKind::free_vector: return MotionKind::translation;
    case ScrewKind::line: return MotionKind::rotation;
    case ScrewKind::screw: return MotionKind::screw;
  }
  return MotionKind::rest;
}

/// A dual vector taken apart: dual magnitude (a + eps h a) times oriented line, with pitch h (K-I-6.2.2). a is not
/// negative.
template <typename T>
struct ScrewT {
  ScrewKind kind = ScrewKind::zero;
  /// Of a free vector, which could stand anywhere, the parallel through the reference point. Of zero, any.
  LineT<T> axis;
  Dual<T> magnitude;  ///< of a free vector 0 + eps |a'|

  /// Dual over real part of the magnitude [m, of motions m/rad]: infinite for a free vector, zero for zero.
  T pitch() const {
    if (kind == ScrewKind::zero) return T(0);
    if (kind == ScrewKind::free_vector) return T(std::numeric_limits<double>::infinity());
    return magnitude.dual / magnitude.real;
  }
  /// The dual vector again.
  Vector3T<Dual<T>> dual() const { return axis.dual() * magnitude; }
};

using Screw = ScrewT<double>;

/// Takes a dual vector apart (K-I-6.2.2). The length [m] is one that is typical of what is described: a real part that,
/// over this length, is rounding beside the dual part counts as zero, and so does a pitch that is rounding beside this
/// length or the distance of the line. The parts must be finite; their size does not matter.
template <typename T>
ScrewT<T> screw_of(const Vector3T<Dual<T>>& v, const T& length) {
  const Vector3T<T> moment = dual_part(v);
  const auto size = polar<T>(real_part(v)), moment_size = polar<T>(moment);
  const T at_length = size ? T(size->length * length) : T(0), at_origin = moment_size ? moment_size->length : T(0);
  if (!moment_size && !size) return {};
  if (moment_size && !(at_length > rounding_floor<T>() * at_origin)) {
    return {ScrewKind::free_vector, {moment_size->direction, Vector3T<T>::Zero()}, Dual<T>(T(0), at_origin)};
  }
  // Across first, along second: no difference of large numbers.
  const Vector3T<T>& u = size->direction;
  const LineT<T> axis{u, Vector3T<T>(u.cross(moment).cross(u) / size->length)};
  const T along = u.dot(moment);
  using std::abs;
  if (abs(along) <= rounding_floor<T>() * (at_length < at_origin ? at_origin : at_length)) {
    return {ScrewKind::line, axis, Dual<T>(size->length, T(0))};
  }
  return {ScrewKind::screw, axis, Dual<T>(size->length, along)};
}

/// The three lines through the origin of B along its axes, as columns of dual vectors in A. components() by them are
/// the dual coordinates in B of a screw: real parts those of the direction, dual parts those of the moment about B's
/// origin (K-I-6.2.4). The basis times these is the screw again.
template <typename T>
Matrix3T<Dual<T>> dual_basis(const PoseT<T>& x_ab) {
  Matrix3T<Dual<T>> basis;
  for (int k = 0; k < 3; ++k) {
    const Vector3T<T> e = x_ab.rotation.col(k);
    basis.col(k) = dual(e, x_ab.position.cross(e));
  }
  return basis;
}

/// The velocity screw omega + eps v [rad/s; m/s], v that of the body's point at the reference point (K-I-6.5.1). Dual
/// vectors do not carry the name of their frame.
template <typename T, typename Frame>
Vector3T<Dual<T>> dual_vector(const TwistT<T, Frame>& twist) {
  return dual(twist.angular, twist.linear);
}

/// The forces as a screw: resultant + eps moment [N; N m] (K-I-6.2.2).
template <typename T, typename Frame>
Vector3T<Dual<T>> dual_vector(const WrenchT<T, Frame>& wrench) {
  return dual(wrench.force, wrench.moment);
}

/// The twist of a velocity screw; which frame it is in, the caller says (K-I-6.5.1).
template <typename Frame = Unnamed, typename T>
TwistT<T, Frame> twist_of_dual(const Vector3T<Dual<T>>& v) {
  return {real_part(v), dual_part(v)};
}

/// The wrench of a screw of forces; which frame it is in, the caller says.
template <typename Frame = Unnamed, typename T>
WrenchT<T, Frame> wrench_of_dual(const Vector3T<Dual<T>>& v) {
  return {dual_part(v), real_part(v)};
}

/// The acceleration screw alpha + eps (a + v x omega) [rad/s^2; m/s^2] (K-I-6.5.2), a the acceleration of the body's
/// point at the reference point. It is the rate of the velocity screw at a reference point that stays where it is, and
/// a dual vector; alpha + eps a is none.
template <typename T, typename Frame>
Vector3T<Dual<T>> acceleration_screw(const TwistT<T, Frame>& twist, const Vector3T<T>& alpha, const Vector3T<T>& a) {
  return dual(alpha, a + twist.linear.cross(twist.angular));
}

/// Acceleration of the body's point at the reference point [m/s^2], from both screws (K-I-6.5.2).
template <typename T>
Vector3T<T> acceleration_at_origin(const Vector3T<Dual<T>>& velocity, const Vector3T<Dual<T>>& acceleration) {
  return dual_part(acceleration) - dual_part(velocity).cross(real_part(velocity));
}

}  // namespace koppel
