// The frame that three points define: z along the first edge, the third point in the half plane x > 0.
#pragma once

#include <algorithm>
#include <cmath>

#include "spatial/line.hpp"

namespace koppel {

/// How three points lie. Only the last two kinds define no frame.
enum class PointsKind {
  regular,
  nearly_collinear,  ///< sine below 1e-6: the frame is usable, but its turn about z is six digits less certain
  collinear,         ///< or so near to it that the rounding of the coordinates decides
  coincident,        ///< the second or the third point is the first, to the rounding of the coordinates
};

/// A frame found for three points.
template <typename T>
struct FrameFromPointsT {
  PointsKind kind = PointsKind::coincident;
  Matrix3T<T> rotation = Matrix3T<T>::Identity();  ///< from the frame to that of the points; identity if there is none
  T sine = T(0);  ///< of the angle between the edges from the first point, as measured; zero for coincident points

  bool has_frame() const { return kind == PointsKind::regular || kind == PointsKind::nearly_collinear; }
};

using FrameFromPoints = FrameFromPointsT<double>;

/// Axes from three points [m] (K-I-2.1.4): z from p to q, y across z and r - p, so that r lies in the x-z plane, on the
/// side of positive x. Orthonormal to rounding, however thin the triangle is. Points that are equal or in line to the
/// rounding of their coordinates define no frame.
template <typename T>
FrameFromPointsT<T> frame_from_points(const Vector3T<T>& p, const Vector3T<T>& q, const Vector3T<T>& r) {
  using std::max, std::min;
  FrameFromPointsT<T> frame;
  const T size = max<T>(p.cwiseAbs().maxCoeff(), max<T>(q.cwiseAbs().maxCoeff(), r.cwiseAbs().maxCoeff()));
  const auto z = polar<T>(q - p), edge = polar<T>(r - p);
  if (!z || !edge) return frame;
  // The coordinates are rounded at their size; seen over the shorter edge, this is how far directions are uncertain.
  const T shorter = min<T>(z->length, edge->length), uncertainty = rounding_floor<T>() * size;
  if (!(shorter > uncertainty)) return frame;
  const auto y = polar<T>(cross_of_units<T>(z->direction, edge->direction));
  frame.kind = PointsKind::collinear;
  if (!y) return frame;
  frame.sine = y->length;
  if (!(frame.sine > max<T>(rounding_floor<T>(), uncertainty / shorter))) return frame;
  frame.kind = frame.sine < T(1e-6) ? PointsKind::nearly_collinear : PointsKind::regular;
  frame.rotation << y->direction.cross(z->direction), y->direction, z->direction;
  return frame;
}

}  // namespace koppel
