// Oriented lines in space: unit direction and moment. Lines and points, and two lines: angle, distance, common normal.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "spatial/dual.hpp"
#include "spatial/pose.hpp"
#include "spatial/vector.hpp"

namespace koppel {

/// An oriented line: unit direction, and moment r x direction [m] about the origin with r any point of it (Pluecker
/// coordinates; K-I-6.2.1).
template <typename T>
struct LineT {
  Vector3T<T> direction = Vector3T<T>::UnitZ();
  Vector3T<T> moment = Vector3T<T>::Zero();

  /// The foot of the perpendicular from the origin [m] (K-I-6.2.1).
  Vector3T<T> nearest_to_origin() const { return direction.cross(moment); }
  /// The same line, the other way.
  LineT operator-() const { return {-direction, -moment}; }
  /// The line as dual unit vector direction + eps moment (K-I-6.2.1).
  Vector3T<Dual<T>> dual() const { return koppel::dual(direction, moment); }
  /// The line of a dual unit vector; nothing is normalised.
  static LineT of_dual(const Vector3T<Dual<T>>& l) { return {real_part(l), dual_part(l)}; }
};

using Line = LineT<double>;

/// The line through a point [m] along a direction of any length (K-I-6.2.1). Empty if the direction is zero or not
/// finite.
template <typename T>
std::optional<LineT<T>> line_through(const Vector3T<T>& point, const Vector3T<T>& direction) {
  const auto u = normalised<T>(direction);
  if (!u) return std::nullopt;
  return LineT<T>{*u, point.cross(*u)};
}

/// The line through two points [m], oriented from p to q (K-I-6.2.1). Empty if they are the same.
template <typename T>
std::optional<LineT<T>> line_through_points(const Vector3T<T>& p, const Vector3T<T>& q) {
  return line_through<T>(p, Vector3T<T>(q - p));
}

/// The line of B in A (K-I-6.2.1).
template <typename T>
LineT<T> transformed(const PoseT<T>& x_ab, const LineT<T>& line_b) {
  const Vector3T<T> direction = x_ab.rotation * line_b.direction;
  return {direction, x_ab.rotation * line_b.moment + x_ab.position.cross(direction)};
}

/// The point of the line nearest to p [m].
template <typename T>
Vector3T<T> foot_point(const LineT<T>& line, const Vector3T<T>& p) {
  return line.nearest_to_origin() + line.direction.dot(p) * line.direction;
}

/// Distance of the point p from the line [m].
template <typename T>
T distance(const LineT<T>& line, const Vector3T<T>& p) {
  const auto moment = polar<T>(line.direction.cross(Vector3T<T>(p - line.nearest_to_origin())));
  return moment ? moment->length : T(0);
}

/// What counts as parallel, and what as meeting.
template <typename T>
struct IncidenceToleranceT {
  T angle = rounding_floor<T>();  ///< [rad]; directions closer to each other, or to opposite ones, are parallel
  T length = T(0);                ///< [m]; what is closer meets, and what is closer than the positions are rounded
};

using IncidenceTolerance = IncidenceToleranceT<double>;

/// How two lines lie; parallel and coincident lines may run opposite ways, which the angle tells.
enum class LineRelation { skew, intersecting, parallel, coincident };

/// Two lines, and what is between them (K-I-6.2.3b, K-I-6.2.3c): e1.e2 = cos(b + eps d), e1 x e2 = sin(b + eps d) e_n
/// with the dual angle b + eps d and the line e_n of the common normal.
template <typename T>
struct LinePairT {
  LineRelation relation = LineRelation::coincident;
  T angle = T(0);  ///< b from line 1 to line 2 about the normal [rad], in [0, pi]
  /// d from line 1 to line 2 along the normal [m]: of either sign, but not negative for parallel lines. Like the angle
  /// it is what has been measured, also where the relation takes it for zero.
  T distance = T(0);
  /// Through both feet, along e1 x e2; of parallel lines, which have many, the one through the point of line 1 nearest
  /// to the origin, and from line 1 to line 2. Coincident lines have none.
  std::optional<LineT<T>> normal;
  Vector3T<T> foot_1 = Vector3T<T>::Zero();  ///< the point of line 1 on the normal [m]: where intersecting lines meet
  Vector3T<T> foot_2 = Vector3T<T>::Zero();  ///< the point of line 2 on the normal [m]

  /// b + eps d (K-I-6.2.3b).
  Dual<T> dual_angle() const { return {angle, distance}; }
};

using LinePair = LinePairT<double>;

/// How two lines lie (K-I-6.2.3b, K-I-6.2.3c). The angle is exact to rounding at every angle. The feet of nearly
/// parallel lines can be as far off as the lines are from each other, over sin b, and are uncertain by rounding at that
/// size. The lines must be finite.
template <typename T>
LinePairT<T> line_pair(const LineT<T>& line_1, const LineT<T>& line_2, const IncidenceToleranceT<T>& tolerance = {}) {
  using std::abs, std::atan2, std::max;
  const Vector3T<T>&e1 = line_1.direction, &e2 = line_2.direction;
  const Vector3T<T> p1 = line_1.nearest_to_origin(), p2 = line_2.nearest_to_origin(), apart = p2 - p1;
  const T reach = max<T>(p1.cwiseAbs().maxCoeff(), p2.cwiseAbs().maxCoeff());
  const auto across = polar<T>(cross_of_units<T>(e1, e2));
  const T sine = across ? across->length : T(0);
  LinePairT<T> pair;
  pair.angle = atan2(sine, e1.dot(e2));
  if (across && sine > tolerance.angle) {
    const Vector3T<T>& n = across->direction;
    const T along_1 = apart.cross(e2).dot(n) / sine, along_2 = apart.cross(e1).dot(n) / sine;
    pair.foot_1 = p1 + along_1 * e1;
    pair.foot_2 = p2 + along_2 * e2;
    pair.distance = apart.dot(n);
    pair.normal = LineT<T>{n, pair.foot_1.cross(n)};
    const T rounding = rounding_floor<T>() * max<T>(reach, max<T>(abs(along_1), abs(along_2)));
    const bool meet = abs(pair.distance) <= max<T>(tolerance.length, rounding);
    pair.relation = meet ? LineRelation::intersecting : LineRelation::skew;
    return pair;
  }
  pair.foot_1 = p1;
  pair.foot_2 = foot_point<T>(line_2, p1);
  const auto normal = polar<T>(pair.foot_2 - pair.foot_1);
  pair.distance = normal ? normal->length : T(0);
  if (!normal || pair.distance <= max<T>(tolerance.length, rounding_floor<T>() * reach)) return pair;
  pair.relation = LineRelation::parallel;
  pair.normal = LineT<T>{normal->direction, p1.cross(normal->direction)};
  return pair;
}

}  // namespace koppel
