// Denavit-Hartenberg tables of whole chains: from the joints' axes to parameters and back.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "spatial/denavit_hartenberg.hpp"

namespace koppel {

/// A frame on an axis: z along it, origin at its point nearest to the origin of the base, x as near as it can be to
/// that of the base, or to its y if the axis lies along x. All in a common frame.
template <typename T>
PoseT<T> frame_on_axis(const PoseT<T>& base, const LineT<T>& axis) {
  using std::abs;
  const Vector3T<T>& z = axis.direction;
  const Vector3T<T> guide = base.rotation.col(abs(z.dot(base.rotation.col(0))) < T(0.9) ? 0 : 1);
  const Vector3T<T> y = z.cross(guide).normalized();
  PoseT<T> x;
  x.rotation << y.cross(z), y, z;
  x.position = foot_point(axis, base.position);
  return x;
}

/// The steps of a chain of joints, at home (K-II-2.3): base * row 1 * ... * row n * end is the pose of the end frame in
/// the base frame. Coordinates are added to angle or offset of their row.
template <typename T>
struct DenavitHartenbergTableT {
  DenavitHartenbergConvention convention = DenavitHartenbergConvention::classic;
  PoseT<T> base;  ///< of the frame on the first axis, in the base frame; as of frame_on_axis()
  std::vector<DenavitHartenbergT<T>> rows;  ///< one for each joint
  std::vector<LineRelation> relations;      ///< of each axis to the next one, and of the last to z of the end frame
  PoseT<T> end;                             ///< of the end frame, in the last row's frame
};

/// The classic table of a chain of joint axes (K-II-2.3), with base and end frame, all in a common frame; tolerance and
/// accuracy as in denavit_hartenberg_step(). The last row leads to the z axis of the end frame; where this is the last
/// joint's axis, it leads to the end frame itself. Any parallel will do as the axis of a prismatic joint.
template <typename T>
DenavitHartenbergTableT<T> denavit_hartenberg_table(
    std::span<const LineT<T>> axes, const PoseT<T>& base, const PoseT<T>& end,
    IncidenceToleranceT<T> tolerance = denavit_hartenberg_tolerance<T>()) {
  using std::atan2, std::max;
  DenavitHartenbergTableT<T> table;
  table.end = relative_pose(base, end);
  if (axes.empty()) return table;
  T size = max<T>(base.position.cwiseAbs().maxCoeff(), end.position.cwiseAbs().maxCoeff());
  for (const auto& axis : axes) size = max<T>(size, axis.moment.cwiseAbs().maxCoeff());
  tolerance.length = max<T>(tolerance.length, positions_floor<T>(size));
  const Vector3T<T> end_z = end.rotation.col(2);
  table.base = relative_pose(base, frame_on_axis(base, axes.front()));
  // The very products that frames() makes: every step corrects what rounding has left of those before.
  PoseT<T> frame = base * table.base;
  for (std::size_t k = 1; k <= axes.size(); ++k) {
    const LineT<T> next = k < axes.size() ? axes[k] : LineT<T>{end_z, end.position.cross(end_z)};
    auto step = denavit_hartenberg_step(frame, next, tolerance);
    if (k == axes.size() && step.relation == LineRelation::coincident && step.parameters.twist == T(0)) {
      const PoseT<T> rest = relative_pose(frame, end);
      step.parameters.angle = atan2(rest.rotation(1, 0), rest.rotation(0, 0));
      step.parameters.offset = rest.position.z();
      step.frame = frame * classic_transform(step.parameters);
    }
    table.rows.push_back(step.parameters);
    table.relations.push_back(step.relation);
    frame = step.frame;
  }
  table.end = relative_pose(frame, end);
  return table;
}

/// The same chain in the modified convention (K-II-2.3): length and twist move to the next row, the last ones to the
/// end. Frame k is on axis k, at the normal to the next axis. A modified table stays as it is.
template <typename T>
DenavitHartenbergTableT<T> modified_of_classic(DenavitHartenbergTableT<T> table) {
  if (table.convention == DenavitHartenbergConvention::modified) return table;
  table.convention = DenavitHartenbergConvention::modified;
  DenavitHartenbergT<T> link;
  for (auto& row : table.rows) {
    std::swap(row.length, link.length);
    std::swap(row.twist, link.twist);
  }
  table.end = modified_transform(link) * table.end;
  return table;
}

/// And back: length and twist move to the row before, the first ones to the base; the last row gets none, and the end
/// keeps what it has. A classic table stays as it is.
template <typename T>
DenavitHartenbergTableT<T> classic_of_modified(DenavitHartenbergTableT<T> table) {
  if (table.convention == DenavitHartenbergConvention::classic) return table;
  table.convention = DenavitHartenbergConvention::classic;
  DenavitHartenbergT<T> link;
  for (std::size_t k = table.rows.size(); k-- > 0;) {
    std::swap(table.rows[k].length, link.length);
    std::swap(table.rows[k].twist, link.twist);
  }
  table.base = table.base * modified_transform(link);
  return table;
}

/// The frames of a table (K-II-2.3), one more than it has rows, for a base frame in whatever frame they are wanted in:
/// the first is on the first axis, and row k leads from frame k-1 to frame k.
template <typename T>
std::vector<PoseT<T>> frames(const DenavitHartenbergTableT<T>& table, const PoseT<T>& base = {}) {
  std::vector<PoseT<T>> all{base * table.base};
  all.reserve(table.rows.size() + 1);
  for (const auto& row : table.rows) {
    all.push_back(all.back() * denavit_hartenberg_transform(row, table.convention));
  }
  return all;
}

}  // namespace koppel
