// Displacements of a rigid body as rotations with dual numbers: dual matrices and dual quaternions of poses, the screw
// by which one pose goes over into another, and motions composed of motions.
#pragma once

#include <optional>

#include "spatial/interpolation.hpp"
#include "spatial/pose.hpp"
#include "spatial/pose_exponential.hpp"
#include "spatial/quaternion.hpp"
#include "spatial/relative_motion.hpp"
#include "spatial/screw.hpp"

namespace koppel {

/// The dual matrix R + eps skew(p) R of X_AB: a screw's coordinates in B, for B's origin, become those in A, for A's
/// origin (K-I-6.2.5). Orthogonal: its inverse is its transpose, the matrix of X_BA. Rotations about dual lines by dual
/// angles are such matrices (K-I-6.3).
template <typename T>
Matrix3T<Dual<T>> dual_rotation_of_pose(const PoseT<T>& x_ab) {
  return dual(x_ab.rotation, skew(x_ab.position) * x_ab.rotation);
}

/// The pose of an orthogonal dual matrix (K-I-6.2.5).
template <typename T>
PoseT<T> pose_of_dual_rotation(const Matrix3T<Dual<T>>& m) {
  const Matrix3T<T> r = real_part(m);
  return {r, axial(dual_part(m) * r.transpose())};
}

/// The same screw for the reference point at p [m], axes as before: the dual part becomes s' + s x p (K-I-6.2.5).
template <typename T>
Vector3T<Dual<T>> shift_reference(const Vector3T<Dual<T>>& s, const Vector3T<T>& p) {
  const Vector3T<T> real = real_part(s);
  return dual(real, dual_part(s) + real.cross(p));
}

/// The screw s of B in A: origin and axes of A. Length and direction, pitch and line stay the same (K-I-6.2.5).
template <typename T>
Vector3T<Dual<T>> transform_screw(const PoseT<T>& x_ab, const Vector3T<Dual<T>>& s) {
  const Vector3T<T> real = x_ab.rotation * real_part(s);
  return dual(real, x_ab.rotation * dual_part(s) + x_ab.position.cross(real));
}

/// A displacement as a turn about a line and an advance along it: the dual angle (angle + eps displacement) about the
/// axis (K-I-6.4).
template <typename T>
struct ScrewDisplacementT {
  MotionKind kind = MotionKind::rest;
  /// Of a translation, the parallel through the origin. Where nothing is displaced, any.
  LineT<T> axis;
  T angle = T(0);         ///< [rad], from an extraction in [0, pi]; zero in a translation
  T displacement = T(0);  ///< along the axis [m]
};

using ScrewDisplacement = ScrewDisplacementT<double>;

/// The screw displacement that takes A to B, in A (and the same numbers in B). At half a turn the axis' sense is free,
/// and the displacement's sign goes with it. The length [m] decides as in screw_of() what is a translation, what a
/// rotation; the angle may be as small as numbers get (K-I-6.4).
template <typename T>
ScrewDisplacementT<T> screw_displacement_of_pose(const PoseT<T>& x_ab, const T& length) {
  const Vector6T<T> log = pose_log<T>(x_ab);
  auto s = screw_of<T>(dual(log.template head<3>(), log.template tail<3>()), length);
  // The turn that is left out bends the way no more.
  if (s.kind == ScrewKind::free_vector) s = screw_of<T>(dual(Vector3T<T>::Zero(), x_ab.position), length);
  return {motion_kind(s.kind), s.axis, s.magnitude.real, s.magnitude.dual};
}

/// The pose X_AB to which the screw displacement takes A; angles of any size, kinds of any sort (K-I-6.4).
template <typename T>
PoseT<T> pose_of_screw_displacement(const ScrewDisplacementT<T>& s) {
  Vector6T<T> log;
  log << s.angle * s.axis.direction, s.angle * s.axis.moment + s.displacement * s.axis.direction;
  return pose_exp<T>(log);
}

/// The pose on the way from A to B at a fraction of their screw displacement: 0 gives A, 1 B, others continue the
/// motion. Points move on helices about one line, at a constant rate. Choosing another base frame changes nothing
/// (K-I-6.4).
template <typename T>
Interpolated<PoseT<T>> interpolated(const PoseT<T>& x_a, const PoseT<T>& x_b, const T& fraction) {
  const PoseT<T> x_ab = relative_pose<T>(x_a, x_b);
  const bool half_turn = quaternion_of_rotation<T>(x_ab.rotation)[0] <= rounding_floor<T>();
  return {x_a * pose_exp<T>(Vector6T<T>(fraction * pose_log<T>(x_ab))), half_turn};
}

/// The dual quaternion q + eps q' of X_AB: q that of the rotation, with w >= 0, and q' = p q / 2. Eight numbers, two
/// conditions: q.q = 1, q.q' = 0 (K-I-6.4).
template <typename T>
Vector4T<Dual<T>> dual_quaternion_of_pose(const PoseT<T>& x_ab) {
  const Vector4T<T> q = quaternion_of_rotation<T>(x_ab.rotation);
  Vector4T<T> p;
  p << T(0), T(0.5) * x_ab.position;
  return dual(q, quaternion_product<T>(p, q));
}

/// The pose of a dual quaternion, which need not meet the two conditions: the result is that of the normalised one. Its
/// real part must not be zero (K-I-6.4).
template <typename T>
PoseT<T> pose_of_dual_quaternion(const Vector4T<Dual<T>>& q) {
  const Vector4T<T> real = real_part(q), way = dual_part(q);
  const T w = real[0];
  const Vector3T<T> n = real.template tail<3>(), m = way.template tail<3>();
  // The vector of 2 q' conj(q); the scalar is what the second condition leaves over.
  return {rotation_of_quaternion<T>(real), (T(2) / real.squaredNorm()) * (w * m - way[0] * n - m.cross(n))};
}

/// q / |q| with the dual norm, which meets both conditions. Empty for a pure dual one (K-I-6.4).
template <typename T>
std::optional<Vector4T<Dual<T>>> normalised_dual_quaternion(const Vector4T<Dual<T>>& q) {
  const T scale = real_part(q).cwiseAbs().maxCoeff();
  if (!(scale > T(0))) return std::nullopt;
  const Vector4T<Dual<T>> scaled = q / Dual<T>(scale);
  return Vector4T<Dual<T>>(scaled / scaled.norm());
}

/// Motion of K_1 in K_0 in dual form, all for the origin and in the axes of K_0: the dual matrix of the pose, velocity
/// screw and acceleration screw (K-I-6.6).
template <typename T>
struct DualMotionT {
  Matrix3T<Dual<T>> rotation = Matrix3T<Dual<T>>::Identity();
  Vector3T<Dual<T>> velocity = Vector3T<Dual<T>>::Zero();
  Vector3T<Dual<T>> acceleration = Vector3T<Dual<T>>::Zero();

  /// Motion of K_2 in K_0 from that of K_1 in K_0 and of K_2 in K_1: alpha_02 = alpha_01 + alpha_12 + omega_01 x
  /// omega_12, all dual. The accelerations of Coriolis and of the guiding motion come out by themselves (K-I-6.6).
  DualMotionT operator*(const DualMotionT& next) const {
    const Vector3T<Dual<T>> relative = rotation * next.velocity;
    return {rotation * next.rotation, velocity + relative,
            acceleration + rotation * next.acceleration + velocity.cross(relative)};
  }
};

using DualMotion = DualMotionT<double>;

/// The dual form of a motion given for the moving origin: velocity and acceleration become those of the body's point at
/// the fixed one (K-I-6.6, K-I-6.5.1, K-I-6.5.2).
template <typename T>
DualMotionT<T> dual_motion(const RelativeMotionT<T>& motion) {
  const Vector3T<T>&p = motion.pose.position, &omega = motion.angular_velocity, &alpha = motion.angular_acceleration;
  const TwistT<T> twist{omega, motion.linear_velocity - omega.cross(p)};
  const Vector3T<T> a = motion.linear_acceleration - alpha.cross(p) - omega.cross(omega.cross(p));
  return {dual_rotation_of_pose(motion.pose), dual_vector(twist), acceleration_screw<T>(twist, alpha, a)};
}

/// And back: velocity and acceleration of the moving origin (K-I-6.6).
template <typename T>
RelativeMotionT<T> relative_motion_of_dual(const DualMotionT<T>& motion) {
  const PoseT<T> x_01 = pose_of_dual_rotation<T>(motion.rotation);
  const Vector3T<T>& p = x_01.position;
  const Vector3T<T> omega = real_part(motion.velocity), alpha = real_part(motion.acceleration);
  const Vector3T<T> a = acceleration_at_origin<T>(motion.velocity, motion.acceleration);
  return {x_01, omega, dual_part(motion.velocity) + omega.cross(p), alpha,
          a + alpha.cross(p) + omega.cross(omega.cross(p))};
}

}  // namespace koppel
