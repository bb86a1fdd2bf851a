// Oriented planes: unit normal and offset. Distances, angles, and what planes and lines have in common.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "spatial/line.hpp"

namespace koppel {

/// The points x with normal . x = offset [m]; the side that the unit normal points to is the positive one.
template <typename T>
struct PlaneT {
  Vector3T<T> normal = Vector3T<T>::UnitZ();
  T offset = T(0);

  /// The foot of the perpendicular from the origin [m].
  Vector3T<T> nearest_to_origin() const { return offset * normal; }
  /// The same plane with its sides exchanged.
  PlaneT operator-() const { return {-normal, -offset}; }
};

using Plane = PlaneT<double>;

/// The plane through a point [m] across a normal of any length. Empty if the normal is zero or not finite.
template <typename T>
std::optional<PlaneT<T>> plane_through(const Vector3T<T>& point, const Vector3T<T>& normal) {
  const auto n = normalised<T>(normal);
  if (!n) return std::nullopt;
  return PlaneT<T>{*n, n->dot(point)};
}

/// The plane through three points [m]; from its positive side, p, q, r run counterclockwise. Empty if they are in line,
/// or if one lies so near to the line of the others that the rounding of the coordinates decides.
template <typename T>
std::optional<PlaneT<T>> plane_through_points(const Vector3T<T>& p, const Vector3T<T>& q, const Vector3T<T>& r) {
  using std::max;
  const std::array<Vector3T<T>, 3> corner{p, q, r};
  std::array<std::optional<Polar<T>>, 3> edge;  // from every corner to the next one
  T size(0);
  std::size_t longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    edge[k] = polar<T>(corner[(k + 1) % 3] - corner[k]);
    if (!edge[k]) return std::nullopt;
    if (edge[k]->length > edge[longest]->length) longest = k;
    size = max<T>(size, corner[k].cwiseAbs().maxCoeff());
  }
  // The two short edges make the angle that says most, and the corner between them has the height of the triangle.
  const Polar<T>&a = *edge[(longest + 1) % 3], &b = *edge[(longest + 2) % 3];
  const auto normal = polar<T>(cross_of_units<T>(a.direction, b.direction));
  if (!normal) return std::nullopt;
  const T height = (a.length / edge[longest]->length) * b.length * normal->length;
  if (!(height > rounding_floor<T>() * size)) return std::nullopt;
  return PlaneT<T>{normal->direction, normal->direction.dot(corner[(longest + 2) % 3])};
}

/// The plane of B in A.
template <typename T>
PlaneT<T> transformed(const PoseT<T>& x_ab, const PlaneT<T>& plane_b) {
  const Vector3T<T> normal = x_ab.rotation * plane_b.normal;
  return {normal, plane_b.offset + normal.dot(x_ab.position)};
}

/// Height of the point p over the plane [m], negative on the other side.
template <typename T>
T signed_distance(const PlaneT<T>& plane, const Vector3T<T>& p) {
  return plane.normal.dot(p) - plane.offset;
}

/// The point of the plane nearest to p [m].
template <typename T>
Vector3T<T> foot_point(const PlaneT<T>& plane, const Vector3T<T>& p) {
  return p - signed_distance(plane, p) * plane.normal;
}

/// The angle at which a line rises from a plane [rad], in [-pi/2, pi/2]: positive if it runs to the positive side.
template <typename T>
T inclination(const PlaneT<T>& plane, const LineT<T>& line) {
  using std::atan2;
  const auto across = polar<T>(cross_of_units<T>(plane.normal, line.direction));
  return atan2(plane.normal.dot(line.direction), across ? across->length : T(0));
}

/// The angle between the normals of two planes [rad], in [0, pi].
template <typename T>
T dihedral_angle(const PlaneT<T>& plane_1, const PlaneT<T>& plane_2) {
  using std::atan2;
  const auto across = polar<T>(cross_of_units<T>(plane_1.normal, plane_2.normal));
  return atan2(across ? across->length : T(0), plane_1.normal.dot(plane_2.normal));
}

/// What planes and lines have in common.
enum class Intersection { none, point, line, plane };

/// A line and a plane. Parallel: none, or the whole line.
template <typename T>
struct LinePlaneIntersectionT {
  Intersection kind = Intersection::none;
  /// In the plane [m]; if the line is parallel to it, the line's point nearest to the origin.
  Vector3T<T> point = Vector3T<T>::Zero();
  T distance = T(0);  ///< height over the plane of the line's point nearest to the origin [m]
};

/// Where a line meets a plane. The point is uncertain by rounding over the sine of the inclination. The tolerance says
/// which angles count as zero, and how far from the plane a parallel line lies in it.
template <typename T>
LinePlaneIntersectionT<T> intersection(const PlaneT<T>& plane, const LineT<T>& line,
                                       const IncidenceToleranceT<T>& tolerance = {}) {
  using std::abs, std::max;
  const Vector3T<T> near = line.nearest_to_origin();
  const T height = signed_distance(plane, near), sine = plane.normal.dot(line.direction);
  if (abs(sine) > tolerance.angle) {
    return {Intersection::point, near - (height / sine) * line.direction, height};
  }
  const T rounding = rounding_floor<T>() * max<T>(abs(plane.offset), near.cwiseAbs().maxCoeff());
  const bool inside = abs(height) <= max<T>(tolerance.length, rounding);
  return {inside ? Intersection::line : Intersection::none, near, height};
}

/// Two planes. Parallel: none, or the whole plane.
template <typename T>
struct PlanePairT {
  Intersection kind = Intersection::none;
  std::optional<LineT<T>> line;  ///< where they cross, along normal 1 x normal 2
  T distance = T(0);             ///< of plane 2 from plane 1 along normal 1 [m] if they do not cross, else zero
};

/// The line in which two planes cross. Its moment is uncertain by rounding over the sine of their angle.
template <typename T>
PlanePairT<T> intersection(const PlaneT<T>& plane_1, const PlaneT<T>& plane_2,
                           const IncidenceToleranceT<T>& tolerance = {}) {
  using std::abs, std::max;
  // With normals that are nearly the same or opposite, the differences come first.
  const T sense = plane_1.normal.dot(plane_2.normal) < T(0) ? T(-1) : T(1);
  const T apart = plane_2.offset - sense * plane_1.offset;
  const auto across = polar<T>(cross_of_units<T>(plane_1.normal, plane_2.normal));
  if (across && across->length > tolerance.angle) {
    const Vector3T<T> tilt = plane_2.normal - sense * plane_1.normal;
    return {Intersection::line,
            LineT<T>{across->direction, (apart * plane_1.normal - plane_1.offset * tilt) / across->length}, T(0)};
  }
  const T rounding = rounding_floor<T>() * max<T>(abs(plane_1.offset), abs(plane_2.offset));
  const bool same = abs(apart) <= max<T>(tolerance.length, rounding);
  return {same ? Intersection::plane : Intersection::none, std::nullopt, sense * apart};
}

/// Three planes. A point is the rule; a line if they are the leaves of a book; none if two are parallel, or if they
/// make a prism.
template <typename T>
struct PlaneTripleT {
  Intersection kind = Intersection::none;
  std::optional<Vector3T<T>> point;  ///< [m]
  std::optional<LineT<T>> line;
};

/// What three planes have in common. The point comes from the two planes that cross at the largest angle, and is
/// uncertain by rounding over the sine of that angle and the sine at which their line meets the third plane.
template <typename T>
PlaneTripleT<T> intersection(const PlaneT<T>& a, const PlaneT<T>& b, const PlaneT<T>& c,
                             const IncidenceToleranceT<T>& tolerance = {}) {
  using std::abs, std::max;
  const std::array<const PlaneT<T>*, 3> planes{&a, &b, &c};
  T sine(-1);
  std::size_t last = 0;  // the plane that the two others leave over
  for (std::size_t k = 0; k < 3; ++k) {
    const auto across = polar<T>(cross_of_units<T>(planes[(k + 1) % 3]->normal, planes[(k + 2) % 3]->normal));
    const T sine_k = across ? across->length : T(0);
    if (sine_k > sine) {
      sine = sine_k;
      last = k;
    }
  }
  const PlaneT<T>&first = *planes[(last + 1) % 3], &second = *planes[(last + 2) % 3], &third = *planes[last];
  const auto pair = intersection(first, second, tolerance);
  if (pair.kind == Intersection::line) {
    // The line of two planes is less certain than they are.
    const T uncertainty = rounding_floor<T>() / sine;
    const T length = uncertainty * max<T>(abs(first.offset), abs(second.offset));
    const auto meeting =
        intersection<T>(third, *pair.line, {max<T>(tolerance.angle, uncertainty), max<T>(tolerance.length, length)});
    if (meeting.kind == Intersection::point) return {Intersection::point, meeting.point, std::nullopt};
    if (meeting.kind == Intersection::line) return {Intersection::line, std::nullopt, pair.line};
    return {};
  }
  const bool same =
      pair.kind == Intersection::plane && intersection(third, first, tolerance).kind == Intersection::plane;
  return {same ? Intersection::plane : Intersection::none, std::nullopt, std::nullopt};
}

}  // namespace koppel
