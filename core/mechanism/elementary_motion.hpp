// How one elementary motion moves a frame and carries a motion: the innermost loops of kinematics, to be inlined into
// joint.cpp and kinematics.cpp.
#pragma once

#include <cmath>

#include "mechanism/joint.hpp"
#include "spatial/plain.hpp"
#include "spatial/quaternion.hpp"
#include "spatial/rotation.hpp"

namespace koppel {

/// A pose in registers.
struct PlainPose {
  PlainMatrix3 rotation;
  Plain3 position;

  PlainPose() = default;
  explicit PlainPose(const Pose& pose) : rotation(pose.rotation), position(pose.position) {}
  void store(Pose& pose) const {
    rotation.store(pose.rotation);
    position.store(pose.position);
  }
  /// This pose times another one.
  PlainPose times(const Pose& other) const {
    PlainPose result;
    result.rotation = rotation * PlainMatrix3(other.rotation);
    result.position = position + rotation * Plain3(other.position);
    return result;
  }
};

inline void store_column(const Plain3& angular, const Plain3& linear, const Plain3& point, Column& column) {
  angular.store(column.angular);
  linear.store(column.linear);
  point.store(column.point);
}

/// Both in one call where the C library has it; compilers find that out by themselves only sometimes.
inline void sine_and_cosine(double angle, double& sine, double& cosine) {
#ifdef __GLIBC__
  sincos(angle, &sine, &cosine);
#else
  sine = std::sin(angle);
  cosine = std::cos(angle);
#endif
}

/// R times the turn by an angle [rad] about an axis in its own frame. Most axes are z: there it is a turn in a plane.
inline PlainMatrix3 turned(const PlainMatrix3& r, const Plain3& axis, double angle) {
  double sine = 0.0, cosine = 0.0;
  sine_and_cosine(angle, sine, cosine);
  if (axis == Plain3(0.0, 0.0, 1.0)) return {cosine * r.x + sine * r.y, cosine * r.y - sine * r.x, r.z};
  return r * PlainMatrix3(rotation_about<double>(axis.vector(), cosine, sine));
}

inline void step_free_rotation(const ElementaryMotion& motion, const double* q, bool reversed, PlainPose& frame,
                               Column* columns) {
  Matrix3 turn = rotation_of_quaternion<double>(Vector4(q[0], q[1], q[2], q[3]));
  if (reversed) turn.transposeInPlace();
  const Plain3 point(motion.point);
  const PlainMatrix3 before = frame.rotation;
  const Plain3 centre = frame.position + before * point;
  frame.rotation = before * PlainMatrix3(turn);
  frame.position = centre - frame.rotation * point;
  // The rates are components in outlet axes: those after the turn, or before it when the joint is walked backwards.
  const PlainMatrix3& outlet = reversed ? before : frame.rotation;
  const double sign = reversed ? -1.0 : 1.0;
  store_column(sign * outlet.x, {}, centre, columns[0]);
  store_column(sign * outlet.y, {}, centre, columns[1]);
  store_column(sign * outlet.z, {}, centre, columns[2]);
}

/// Applies one elementary motion, or its inverse, to a frame and writes its columns.
inline void step_one(const ElementaryMotion& motion, const double* q, bool reversed, PlainPose& frame,
                     Column* columns) {
  if (motion.kind == ElementaryMotionKind::free_rotation) {
    return step_free_rotation(motion, q, reversed, frame, columns);
  }
  const double sign = reversed ? -1.0 : 1.0;
  const double value = sign * (q[0] - motion.zero);
  const Plain3 local(motion.axis), point(motion.point);
  const Plain3 axis = frame.rotation * local;
  if (motion.kind == ElementaryMotionKind::translation) {
    frame.position += value * axis;
    return store_column({}, sign * axis, frame.position, columns[0]);
  }
  const Plain3 advance = motion.pitch * axis;
  if (point.is_zero()) {
    frame.rotation = turned(frame.rotation, local, value);
    store_column(sign * axis, sign * advance, frame.position, columns[0]);
    frame.position += value * advance;
    return;
  }
  const Plain3 on_axis = frame.position + frame.rotation * point;
  frame.rotation = turned(frame.rotation, local, value);
  store_column(sign * axis, sign * advance, on_axis, columns[0]);
  frame.position = on_axis - frame.rotation * point + value * advance;
}

/// A FrameMotion in registers.
struct PlainMotion {
  Plain3 at, angular_velocity, velocity, angular_acceleration, acceleration;

  explicit PlainMotion(const FrameMotion& m)
      : at(m.at),
        angular_velocity(m.angular_velocity),
        velocity(m.velocity),
        angular_acceleration(m.angular_acceleration),
        acceleration(m.acceleration) {}
  void store(FrameMotion& m) const {
    at.store(m.at);
    angular_velocity.store(m.angular_velocity);
    velocity.store(m.velocity);
    angular_acceleration.store(m.angular_acceleration);
    acceleration.store(m.acceleration);
  }
  /// As FrameMotion::shift(), which often has nowhere to go.
  void shift(const Plain3& to) {
    if (at == to) return;
    const Plain3 d = to - at, slide = angular_velocity.cross(d);
    acceleration += angular_acceleration.cross(d) + angular_velocity.cross(slide);
    velocity += slide;
    at = to;
  }
};

/// Carries a motion over one elementary motion whose columns are given (K-II-2.1).
inline void step_motion_one(const ElementaryMotion& motion, const double* v, const double* a, const Column* columns,
                            PlainMotion& state) {
  state.shift(Plain3(columns[0].point));
  if (motion.kind != ElementaryMotionKind::rotation && motion.kind != ElementaryMotionKind::free_rotation) {
    const Plain3 linear(columns[0].linear), slide = v[0] * linear;
    state.acceleration += 2.0 * state.angular_velocity.cross(slide) + a[0] * linear;
    state.velocity += slide;
  }
  if (motion.kind == ElementaryMotionKind::translation) return;
  const Plain3 axis(columns[0].angular);
  Plain3 turn = v[0] * axis, turn_rate = a[0] * axis;
  if (motion.kind == ElementaryMotionKind::free_rotation) {
    for (int i = 1; i < 3; ++i) {
      turn += v[i] * Plain3(columns[i].angular);
      turn_rate += a[i] * Plain3(columns[i].angular);
    }
  }
  state.angular_acceleration += state.angular_velocity.cross(turn) + turn_rate;
  state.angular_velocity += turn;
}

}  // namespace koppel
