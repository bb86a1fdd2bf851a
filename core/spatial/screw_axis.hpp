// The line about which a body turns at a moment, and along which it slides; and the two surfaces that this line leaves
// behind in the fixed and in the moving body.
#pragma once

#include <span>
#include <vector>

#include "spatial/pose.hpp"
#include "spatial/screw.hpp"
#include "spatial/twist.hpp"

namespace koppel {

/// The instantaneous screw axis of a velocity state (K-I-3.3.2c): where its points go along it, with pitch times rate.
template <typename T>
struct ScrewAxisT {
  MotionKind kind = MotionKind::rest;
  /// Along omega. Of a translation, whose axis is infinitely far, the parallel to v through the origin. At rest, any.
  LineT<T> line;
  T pitch = T(0);  ///< advance per angle [m/rad]; infinite for a translation, zero for a rotation and at rest
  T rate = T(0);   ///< |omega| [rad/s]; for a translation |v| [m/s]

  /// The point of the line nearest to the origin, which is the reference point of the twist [m].
  Vector3T<T> point() const { return line.nearest_to_origin(); }
};

using ScrewAxis = ScrewAxisT<double>;

/// The screw axis of a twist, in its frame (K-I-3.3.2c, K-I-6.5.1): the line and the pitch of the velocity screw. The
/// length [m] is one that is typical of the mechanism; screw_of() tells how it decides between the kinds.
template <typename T, typename Frame>
ScrewAxisT<T> screw_axis(const TwistT<T, Frame>& twist, const T& length) {
  const auto s = screw_of<T>(dual_vector(twist), length);
  return {motion_kind(s.kind), s.axis, s.pitch(),
          s.kind == ScrewKind::free_vector ? s.magnitude.dual : s.magnitude.real};
}

/// The same axis in another frame, A: line and nearest point move, nothing else does.
template <typename T>
ScrewAxisT<T> transformed(const PoseT<T>& x_ab, const ScrewAxisT<T>& axis) {
  ScrewAxisT<T> result = axis;
  result.line = transformed<T>(x_ab, axis.line);
  if (axis.kind == MotionKind::translation) result.line.moment.setZero();
  return result;
}

/// A moment of the motion of K_1 in K_0: where it is, and its twist, at the origin and in the axes of K_0.
template <typename T>
struct MotionSampleT {
  PoseT<T> x_01;
  TwistT<T> twist;
};

using MotionSample = MotionSampleT<double>;

/// Motion of body B in body A from the motions of both in K_0: from here axis and axodes of any two bodies.
template <typename T>
MotionSampleT<T> relative_sample(const MotionSampleT<T>& a, const MotionSampleT<T>& b) {
  const TwistT<T> at_a = shifted(b.twist - a.twist, a.x_01.position);
  return {relative_pose<T>(a.x_01, b.x_01),
          {a.x_01.rotation.transpose() * at_a.angular, a.x_01.rotation.transpose() * at_a.linear}};
}

/// Two ruled surfaces that touch along the screw axis at every moment, and roll on each other while they slide along
/// it. One axis for every sample; where its kind is translation or rest, the surfaces break.
template <typename T>
struct AxodesT {
  std::vector<ScrewAxisT<T>> fixed;   ///< in K_0
  std::vector<ScrewAxisT<T>> moving;  ///< in K_1
};

/// The axodes of a sampled motion (K-II-1.2.1c). The length [m] as in screw_axis().
template <typename T>
AxodesT<T> axodes(std::span<const MotionSampleT<T>> samples, const T& length) {
  AxodesT<T> surfaces;
  surfaces.fixed.reserve(samples.size());
  surfaces.moving.reserve(samples.size());
  for (const auto& sample : samples) {
    const auto axis = screw_axis<T>(sample.twist, length);
    surfaces.fixed.push_back(axis);
    surfaces.moving.push_back(transformed<T>(sample.x_01.inverse(), axis));
  }
  return surfaces;
}

}  // namespace koppel
