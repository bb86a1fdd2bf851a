// Denavit-Hartenberg parameters: four numbers for the step from one joint axis to the next, from parameters to frames
// and from axes to parameters; in the classic and in the modified convention.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "spatial/line.hpp"
#include "spatial/pose.hpp"

namespace koppel {

/// Denavit-Hartenberg parameters (K-II-2.3). Classic: from frame j to j+1, with x_{j+1} on the common normal of z_j and
/// z_{j+1}. Modified (Craig): length and twist belong to the joint before, angle and offset to this one.
template <typename T>
struct DenavitHartenbergT {
  T angle = T(0);   ///< theta, from x_j to x_{j+1} about z_j [rad]: the coordinate of a revolute joint
  T offset = T(0);  ///< s, from x_j to x_{j+1} along z_j [m]: the coordinate of a prismatic joint
  T length = T(0);  ///< d, from z_j to z_{j+1} along x_{j+1} [m]; not negative where it is chosen here
  T twist = T(0);   ///< delta, from z_j to z_{j+1} about x_{j+1} [rad]
};

using DenavitHartenberg = DenavitHartenbergT<double>;

/// Rz(angle) Tz(offset) Tx(length) Rx(twist): the pose of frame j+1 in frame j, classic convention (K-II-2.3).
template <typename T>
PoseT<T> classic_transform(const DenavitHartenbergT<T>& p) {
  using std::cos, std::sin;
  const T c = cos(p.angle), s = sin(p.angle), cd = cos(p.twist), sd = sin(p.twist);
  PoseT<T> x;
  x.rotation << c, -s * cd, s * sd,  //
      s, c * cd, -c * sd,            //
      T(0), sd, cd;
  x.position << p.length * c, p.length * s, p.offset;
  return x;
}

/// Rx(twist) Tx(length) Rz(angle) Tz(offset): the pose of frame j in frame j-1, modified convention (K-II-2.3).
template <typename T>
PoseT<T> modified_transform(const DenavitHartenbergT<T>& p) {
  using std::cos, std::sin;
  const T c = cos(p.angle), s = sin(p.angle), cd = cos(p.twist), sd = sin(p.twist);
  PoseT<T> x;
  x.rotation << c, -s, T(0),  //
      s * cd, c * cd, -sd,    //
      s * sd, c * sd, cd;
  x.position << p.length, -sd * p.offset, cd * p.offset;
  return x;
}

enum class DenavitHartenbergConvention { classic, modified };

/// The step in either convention (K-II-2.3).
template <typename T>
PoseT<T> denavit_hartenberg_transform(const DenavitHartenbergT<T>& p, DenavitHartenbergConvention convention) {
  return convention == DenavitHartenbergConvention::classic ? classic_transform(p) : modified_transform(p);
}

/// Joints whose coordinate is one of the parameters.
enum class DenavitHartenbergJoint { revolute, prismatic };

/// A step taken apart into what the joint moves and what the link keeps (K-II-2.3): the step is variable * fixed in the
/// classic, fixed * variable in the modified convention.
template <typename T>
struct DenavitHartenbergPartsT {
  PoseT<T> variable;  ///< Rz(angle) of a revolute, Tz(offset) of a prismatic joint
  PoseT<T> fixed;     ///< the step with that parameter zero
};

/// The parts of a step (K-II-2.3, E-W23). Fixed are, in the classic convention, Rx(twist) with (length, 0, offset) for
/// a revolute, Rz(angle) Rx(twist) with (length cos angle, length sin angle, 0) for a prismatic joint.
template <typename T>
DenavitHartenbergPartsT<T> denavit_hartenberg_parts(
    const DenavitHartenbergT<T>& p, DenavitHartenbergJoint joint,
    DenavitHartenbergConvention convention = DenavitHartenbergConvention::classic) {
  DenavitHartenbergT<T> variable, fixed = p;
  if (joint == DenavitHartenbergJoint::revolute) {
    std::swap(variable.angle, fixed.angle);
  } else {
    std::swap(variable.offset, fixed.offset);
  }
  return {denavit_hartenberg_transform(variable, convention), denavit_hartenberg_transform(fixed, convention)};
}

/// Which axes count as parallel when parameters are chosen. The foot of the normal of axes at a small angle is
/// uncertain by rounding over the angle; taken for parallel, they are wrong by the angle. At the root of rounding,
/// 1.5e-8 rad for double, both are equally bad.
template <typename T>
IncidenceToleranceT<T> denavit_hartenberg_tolerance() {
  using std::sqrt;
  return {sqrt(epsilon<T>()), T(0)};
}

/// Positions that have been through products of poses are rounded more than once: closer than this, axes meet.
template <typename T>
T positions_floor(const T& size) {
  return T(16) * rounding_floor<T>() * size;
}

/// The step to the next axis: its parameters, the frame that they lead to, and how the axes lie, which tells what has
/// been chosen (K-II-2.3). Skew: nothing. Intersecting: x along z_j x z_{j+1}, twist in [0, pi], length zero. Parallel:
/// the normal through O_j, offset zero, twist 0 or pi. Coincident: x kept, angle, offset and length zero, twist 0 or
/// pi.
template <typename T>
struct DenavitHartenbergStepT {
  DenavitHartenbergT<T> parameters;
  PoseT<T> frame;
  LineRelation relation = LineRelation::coincident;
};

/// The classic step from frame j, whose z axis is joint axis j, to joint axis j+1 (K-II-2.3); frame and axis in a
/// common frame. The z axis of the new frame is axis j+1 to rounding at the distance of both origins, which are far
/// away for nearly parallel axes; it differs by what the tolerance lets pass. Axes closer than 1e-14 of their distance
/// from the common origin always meet.
template <typename T>
DenavitHartenbergStepT<T> denavit_hartenberg_step(
    const PoseT<T>& frame, const LineT<T>& next_axis,
    const IncidenceToleranceT<T>& tolerance = denavit_hartenberg_tolerance<T>()) {
  using std::atan2, std::max;
  const T size = max<T>(frame.position.cwiseAbs().maxCoeff(), next_axis.moment.cwiseAbs().maxCoeff());
  const Vector3T<T> moment = next_axis.moment - frame.position.cross(next_axis.direction);
  const LineT<T> next{frame.rotation.transpose() * next_axis.direction, frame.rotation.transpose() * moment};
  const auto pair = line_pair<T>({}, next, {tolerance.angle, max<T>(tolerance.length, positions_floor<T>(size))});
  const bool skew = pair.relation == LineRelation::skew, parallel = pair.relation == LineRelation::parallel;
  // So that the length is not negative; where it is zero, the twist is not negative instead.
  const T sign = skew && pair.distance < T(0) ? T(-1) : T(1);
  const Vector3T<T> x = pair.normal ? Vector3T<T>(sign * pair.normal->direction) : Vector3T<T>::UnitX();
  DenavitHartenbergStepT<T> step;
  DenavitHartenbergT<T>& p = step.parameters;
  step.relation = pair.relation;
  p.angle = atan2(x.y(), x.x());
  if (skew || parallel) p.length = sign * pair.distance;
  if (skew || pair.relation == LineRelation::intersecting) {
    p.offset = pair.foot_1.z();
    p.twist = sign * pair.angle;
  } else {
    p.twist = next.direction.z() < T(0) ? atan2(T(0), T(-1)) : T(0);
  }
  step.frame = frame * classic_transform(p);
  return step;
}

}  // namespace koppel
