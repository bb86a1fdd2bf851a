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

/// How the value changes when frame a turns by `angular` and moves by `linear` (velocity of its origin), in b's axes.
template <typename T>
T change(const ClosureCondition& condition, const PoseT<T>& a_in_b, const Vector3T<T>& angular,
         const Vector3T<T>& linear) {
  const Vector3T<T>& r = a_in_b.position;
  const Matrix3T<T>& m = a_in_b.rotation;
  const auto dot = [](const Vector3T<T>& x, const Vector3T<T>& y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; };
  // b seen from a moves with the velocity -(linear + angular x -r) at its origin.
  const Vector3T<T> of_b = cross<T>(angular, r) - linear;
  switch (condition.type) {
    case ClosureType::point_point: return T(2) * dot(r, linear);
    case ClosureType::point_plane:
      if (!condition.at_a) return linear[condition.axis_b];
      return dot(Vector3T<T>(m.col(condition.axis_a)), of_b);
    case ClosureType::point_line: {
      if (!condition.at_a) return T(2) * (r[0] * linear[0] + r[1] * linear[1]);
      const Vector3T<T> x = m.col(0), y = m.col(1);
      return T(-2) * (dot(x, r) * dot(x, of_b) + dot(y, r) * dot(y, of_b));
    }
    case ClosureType::angle: {
      const Vector3T<T> turned = cross<T>(angular, m.col(condition.axis_a));
      return turned[condition.axis_b];
    }
    case ClosureType::line_line: {
      const Vector3T<T> u = m.col(2), turned = cross<T>(angular, u);
      return turned[0] * r[1] - turned[1] * r[0] + u[0] * linear[1] - u[1] * linear[0];
    }
  }
  return T(0);
}

/// What the value's second time derivative has beyond change() with the angular acceleration and the acceleration of
/// the origin: the terms quadratic in the velocities.
template <typename T>
T quadratic_change(const ClosureCondition& condition, const PoseT<T>& a_in_b, const Vector3T<T>& angular,
                   const Vector3T<T>& linear) {
  const Vector3T<T>& r = a_in_b.position;
  const Matrix3T<T>& m = a_in_b.rotation;
  const auto dot = [](const Vector3T<T>& x, const Vector3T<T>& y) { return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]; };
  const auto turned = [&](std::uint8_t axis) { return cross<T>(angular, m.col(axis)); };
  const auto twice = [&](std::uint8_t axis) { return cross<T>(angular, turned(axis)); };
  // Of the component of r along an axis of a.
  const auto component = [&](std::uint8_t axis) { return dot(twice(axis), r) + T(2) * dot(turned(axis), linear); };
  switch (condition.type) {
    case ClosureType::point_point: return T(2) * dot(linear, linear);
    case ClosureType::point_plane: return condition.at_a ? T(-component(condition.axis_a)) : T(0);
    case ClosureType::point_line: {
      if (!condition.at_a) return T(2) * (linear[0] * linear[0] + linear[1] * linear[1]);
      const T x = dot(m.col(0), r), y = dot(m.col(1), r);
      const T dx = dot(turned(0), r) + dot(m.col(0), linear), dy = dot(turned(1), r) + dot(m.col(1), linear);
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
