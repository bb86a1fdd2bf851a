// Motion of a frame relative to another one, up to accelerations: the fields of a body's points, composition and
// inverse.
#pragma once

#include "spatial/path.hpp"
#include "spatial/pose.hpp"
#include "spatial/rotation_rates.hpp"

namespace koppel {

/// Motion of B in A, all in A's axes: angular velocity [rad/s] and acceleration [rad/s^2], velocity [m/s] and
/// acceleration [m/s^2] of B's origin. The default is rest (C-5).
template <typename T>
struct RelativeMotionT {
  PoseT<T> pose;  ///< X_AB
  Vector3T<T> angular_velocity = Vector3T<T>::Zero();
  Vector3T<T> linear_velocity = Vector3T<T>::Zero();
  Vector3T<T> angular_acceleration = Vector3T<T>::Zero();
  Vector3T<T> linear_acceleration = Vector3T<T>::Zero();
};

using RelativeMotion = RelativeMotionT<double>;

/// The motion at the time t [s] of a pose X_AB(t), exact to rounding. The pose is any function from a Dual<Dual<T>> to
/// a PoseT<Dual<Dual<T>>> (K-I-3.2.2, K-I-3.2.3).
template <typename T, typename PoseOfTime>
RelativeMotionT<T> relative_motion(const PoseOfTime& pose_of_time, const T& t) {
  using Time = Dual<Dual<T>>;
  const PoseT<Time> x = pose_of_time(differentiable_time<T>(t));
  const auto value = [](const Time& number) { return number.real.real; };
  const auto rate = [](const Time& number) { return number.real.dual; };
  const auto second_rate = [](const Time& number) { return number.dual.dual; };
  const Matrix3T<T> r = x.rotation.unaryExpr(value);
  return {{r, x.position.unaryExpr(value)},
          angular_velocity<T>(r, x.rotation.unaryExpr(rate)),
          x.position.unaryExpr(rate),
          angular_acceleration<T>(r, x.rotation.unaryExpr(second_rate)),
          x.position.unaryExpr(second_rate)};
}

/// Velocity [m/s] in A, in A's axes, of the point fixed in B at p_b [m]: v + omega x rho, rho = R p_b (K-I-3.3.2a).
template <typename T>
Vector3T<T> velocity_at(const RelativeMotionT<T>& motion, const Vector3T<T>& p_b) {
  return motion.linear_velocity + motion.angular_velocity.cross(motion.pose.rotation * p_b);
}

/// Acceleration [m/s^2] in A, in A's axes, of the point fixed in B at p_b [m]: a + alpha x rho + omega x (omega x rho)
/// (K-I-3.3.3).
template <typename T>
Vector3T<T> acceleration_at(const RelativeMotionT<T>& motion, const Vector3T<T>& p_b) {
  const Vector3T<T> rho = motion.pose.rotation * p_b;
  const Vector3T<T>& omega = motion.angular_velocity;
  return motion.linear_acceleration + motion.angular_acceleration.cross(rho) + omega.cross(omega.cross(rho));
}

/// Motion of C in A, composed of those of B in A and of C in B, and what its accelerations are made of; all in A's
/// axes. For C's origin the guiding parts are those of the point of B that it is passing (K-I-5.2).
template <typename T>
struct ComposedMotionT {
  RelativeMotionT<T> motion;             ///< of C in A
  Vector3T<T> guiding_velocity;          ///< v_AB + omega_AB x r_BC [m/s]
  Vector3T<T> relative_velocity;         ///< v_BC [m/s]
  Vector3T<T> euler_acceleration;        ///< alpha_AB x r_BC [m/s^2]
  Vector3T<T> centripetal_acceleration;  ///< omega_AB x (omega_AB x r_BC) [m/s^2]
  Vector3T<T> guiding_acceleration;      ///< a_AB + Euler + centripetal [m/s^2]
  Vector3T<T> relative_acceleration;     ///< a_BC [m/s^2]
  Vector3T<T> coriolis_acceleration;     ///< 2 omega_AB x v_BC [m/s^2]
  Vector3T<T> gyroscopic;                ///< omega_AB x omega_BC, part of the angular acceleration [rad/s^2]
};

using ComposedMotion = ComposedMotionT<double>;

/// Motion of C in A from that of B in A and that of C in B, the latter in B's axes. The velocity of C's origin is
/// guiding + relative, its acceleration guiding + relative + Coriolis; the angular acceleration is alpha_AB + alpha_BC
/// + gyroscopic (K-I-5.2).
template <typename T>
ComposedMotionT<T> composed(const RelativeMotionT<T>& ab, const RelativeMotionT<T>& bc) {
  const Matrix3T<T>& r_ab = ab.pose.rotation;
  const Vector3T<T>& omega = ab.angular_velocity;
  const Vector3T<T> r = r_ab * bc.pose.position, omega_bc = r_ab * bc.angular_velocity;
  ComposedMotionT<T> c;
  c.guiding_velocity = ab.linear_velocity + omega.cross(r);
  c.relative_velocity = r_ab * bc.linear_velocity;
  c.euler_acceleration = ab.angular_acceleration.cross(r);
  c.centripetal_acceleration = omega.cross(omega.cross(r));
  c.guiding_acceleration = ab.linear_acceleration + c.euler_acceleration + c.centripetal_acceleration;
  c.relative_acceleration = r_ab * bc.linear_acceleration;
  c.coriolis_acceleration = T(2) * omega.cross(c.relative_velocity);
  c.gyroscopic = omega.cross(omega_bc);
  c.motion = {ab.pose * bc.pose, omega + omega_bc, c.guiding_velocity + c.relative_velocity,
              ab.angular_acceleration + r_ab * bc.angular_acceleration + c.gyroscopic,
              c.guiding_acceleration + c.relative_acceleration + c.coriolis_acceleration};
  return c;
}

/// Motion of A in B, in B's axes, from that of B in A: composed with it, either way, it gives rest (K-I-5.2).
template <typename T>
RelativeMotionT<T> inverse(const RelativeMotionT<T>& ab) {
  const PoseT<T> x_ba = ab.pose.inverse();
  const Matrix3T<T>& r_ba = x_ba.rotation;
  const Vector3T<T>&omega = ab.angular_velocity, &p = ab.pose.position;
  // As seen from B, in A's axes.
  const Vector3T<T> velocity = ab.linear_velocity - omega.cross(p);
  const Vector3T<T> acceleration = ab.linear_acceleration - ab.angular_acceleration.cross(p) -
                                   omega.cross(ab.linear_velocity) - omega.cross(velocity);
  return {x_ba, -(r_ba * omega), -(r_ba * velocity), -(r_ba * ab.angular_acceleration), -(r_ba * acceleration)};
}

}  // namespace koppel
