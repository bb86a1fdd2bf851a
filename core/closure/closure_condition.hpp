// The five elementary closure conditions: numbers of two joint elements that only depend on how the elements lie to
// each other (K-II-3.4.1). Taken along one half of a loop that is cut at two joints, and along the other, they must be
// equal.
#pragma once

#include <cstdint>
#include <span>

#include "closure/cut_joint.hpp"
#include "spatial/pose.hpp"

namespace koppel {

enum class ClosureType : std::uint8_t {
  point_point = 1,  ///< squared distance [m^2] (3.32)
  point_plane,      ///< distance [m] of a point from a plane (3.33)
  point_line,       ///< squared distance [m^2] of a point from a line (3.34)
  angle,            ///< cosine of the angle of two directions (3.35)
  line_line         ///< distance of two lines [m] times the sine of their angle (3.36)
};

/// A condition between the frames of two cut joints a and b. The plane, line or direction is an axis of its frame.
struct ClosureCondition {
  ClosureType type = ClosureType::point_point;
  std::uint8_t axis_a = 2, axis_b = 2;  ///< 0 x, 1 y, 2 z
  bool at_a = false;                    ///< of point_plane and point_line: the plane or line is a's, the point b's
};

/// The conditions of a pair of joints, in the order of the table of K-II-3.4.2a; either may be `a`. Empty: no pair of
/// the table, and none of those that have a freedom of their own between them (S-S, S-E, E-E).
std::span<const ClosureCondition> pair_conditions(CutShape a, CutShape b);

/// Whether those conditions are only right up to a mirror image, so that some of their solutions do not close the loop
/// (K-II-3.4.2a).
bool up_to_mirror(CutShape a, CutShape b);

/// The conditions of one joint between its two frames (K-II-3.3): 6 less its freedoms, all of them zero, cosines of
/// right angles and distances.
std::span<const ClosureCondition> joint_conditions(CutShape shape);

/// What a condition's value is measured in: 1, a length or its square, for a mechanism of this length [m].
double size_of(const ClosureCondition& condition, double length);

/// The value of a condition, from the pose of a's frame in b's.
template <typename T>
T value(const ClosureCondition& condition, const PoseT<T>& a_in_b) {
  const Vector3T<T>& r = a_in_b.position;
  const Matrix3T<T>& m = a_in_b.rotation;
  switch (condition.type) {
    case ClosureType::point_point: return r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
    case ClosureType::point_plane:
      if (!condition.at_a) return r[condition.axis_b];
      return -(m(0, condition.axis_a) * r[0] + m(1, condition.axis_a) * r[1] + m(2, condition.axis_a) * r[2]);
    case ClosureType::point_line: {
      if (!condition.at_a) return r[0] * r[0] + r[1] * r[1];
      const T x = m(0, 0) * r[0] + m(1, 0) * r[1] + m(2, 0) * r[2];
      const T y = m(0, 1) * r[0] + m(1, 1) * r[1] + m(2, 1) * r[2];
      return x * x + y * y;
    }
    case ClosureType::angle: return m(condition.axis_b, condition.axis_a);
    case ClosureType::line_line: return m(0, 2) * r[1] - m(1, 2) * r[0];
  }
  return T(0);
}

/// a x b, also of complex vectors (Eigen's conjugates them).
template <typename T>
Vector3T<T> cross(const Vector3T<T>& a, const Vector3T<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <typename T>
T dot(const Vector3T<T>& a, const Vector3T<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// How a value changes with the motion of frame a, in b's axes: by its turning, and by the velocity of its origin.
template <typename T>
struct ConditionSlope {
  Vector3T<T> angular = Vector3T<T>::Zero(), linear = Vector3T<T>::Zero();

  T along(const Vector3T<T>& turning, const Vector3T<T>& velocity) const {
    return dot<T>(angular, turning) + dot<T>(linear, velocity);
  }
};

template <typename T>
ConditionSlope<T> slope(const ClosureCondition& condition, const PoseT<T>& a_in_b) {
  const Vector3T<T>& r = a_in_b.position;
  const Matrix3T<T>& m = a_in_b.rotation;
  const auto axis = [](std::uint8_t k) { return Vector3T<T>(Vector3T<T>::Unit(k)); };
  ConditionSlope<T> result;
  switch (condition.type) {
    case ClosureType::point_point: result.linear = T(2) * r; break;
    case ClosureType::point_plane:
      if (condition.at_a) {
        // The component of -r along an axis that turns with a.
        const Vector3T<T> normal = m.col(condition.axis_a);
        result = {cross<T>(r, normal), -normal};
      } else {
        result.linear = axis(condition.axis_b);
      }
      break;
    case ClosureType::point_line:
      if (condition.at_a) {
        const Vector3T<T> x = m.col(0), y = m.col(1);
        const Vector3T<T> across = T(2) * (dot<T>(x, r) * x + dot<T>(y, r) * y);
        result = {cross<T>(across, r), across};
      } else {
        result.linear = {T(2) * r[0], T(2) * r[1], T(0)};
      }
      break;
    case ClosureType::angle: result.angular = cross<T>(m.col(condition.axis_a), axis(condition.axis_b)); break;
    case ClosureType::line_line: {
      const Vector3T<T> u = m.col(2), z = axis(2);
      result = {cross<T>(u, cross<T>(r, z)), cross<T>(z, u)};
      break;
    }
  }
  return result;
}

/// How the value changes when frame a turns by `angular` and moves by `linear` (velocity of its origin), in b's axes.
template <typename T>
T change(const ClosureCondition& condition, const PoseT<T>& a_in_b, const Vector3T<T>& angular,
         const Vector3T<T>& linear) {
  return slope(condition, a_in_b).along(angular, linear);
}

/// What the value's second time derivative has beyond change() with the angular acceleration and the acceleration of
/// the origin: the terms quadratic in the velocities.
template <typename T>
T quadratic_change(const ClosureCondition& condition, const PoseT<T>& a_in_b, const Vector3T<T>& angular,
                   const Vector3T<T>& linear) {
  const Vector3T<T>& r = a_in_b.position;
  const Matrix3T<T>& m = a_in_b.rotation;
  const auto turned = [&](std::uint8_t axis) { return cross<T>(angular, m.col(axis)); };
  const auto twice = [&](std::uint8_t axis) { return cross<T>(angular, turned(axis)); };
  // Of the component of r along an axis of a.
  const auto component = [&](std::uint8_t axis) {
    return dot<T>(twice(axis), r) + T(2) * dot<T>(turned(axis), linear);
  };
  switch (condition.type) {
    case ClosureType::point_point: return T(2) * dot<T>(linear, linear);
    case ClosureType::point_plane: return condition.at_a ? T(-component(condition.axis_a)) : T(0);
    case ClosureType::point_line: {
      if (!condition.at_a) return T(2) * (linear[0] * linear[0] + linear[1] * linear[1]);
      const T x = dot<T>(m.col(0), r), y = dot<T>(m.col(1), r);
      const T dx = dot<T>(turned(0), r) + dot<T>(m.col(0), linear),
              dy = dot<T>(turned(1), r) + dot<T>(m.col(1), linear);
      return T(2) * (dx * dx + dy * dy + x * component(0) + y * component(1));
    }
    case ClosureType::angle: return twice(condition.axis_a)[condition.axis_b];
    case ClosureType::line_line: {
      const Vector3T<T> du = turned(2), ddu = twice(2);
      return ddu[0] * r[1] - ddu[1] * r[0] + T(2) * (du[0] * linear[1] - du[1] * linear[0]);
    }
  }
  return T(0);
}

}  // namespace koppel
