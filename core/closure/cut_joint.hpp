// Where a loop is cut: runs of neighbouring motions recognised as one of the joints of the field, whoever modelled
// them - two turns with crossing axes are a Cardan joint, three are a ball, parallel turns and slides across them a
// plane - and the few elements that stay fixed in each: a point, a line, a plane, directions.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "closure/loop.hpp"

namespace koppel {

/// The joints at which loops are cut (K-II-1.2, K-II-3.4.2a).
enum class CutShape {
  turn,           ///< R: a point and a direction
  slide,          ///< P: three directions
  cylinder,       ///< C: a line
  cross,          ///< T: two turns with crossing axes: a point
  ball,           ///< S: a point
  plane,          ///< E: a plane
  turning_plane,  ///< E with one freedom less: two parallel turns, or a turn and a slide across it: a normal
  sliding_plane   ///< two slides: a normal
};

/// A run of motions as one joint. Its elements are those of two frames, one on either side: the z axis is the axis or
/// normal, the origin the point. In the frames of the closed joint the elements coincide.
struct CutJoint {
  CutShape shape = CutShape::turn;
  std::size_t first = 0, count = 0;  ///< motions, cyclic
  int freedoms = 0;
  Pose before;  ///< in the frame that the motion before the run has moved
  Pose after;   ///< in the frame that the last motion of the run has moved
};

/// The joint that `count` motions of the loop make, from number `first` on; nothing if they make none. `length` [m] is
/// the mechanism's: axes count as crossing or parallel to half the digits. `doubtful`, if given, is set where that is
/// more than rounding: the joint is then nearly what it is taken for, or nearly another one.
std::optional<CutJoint> cut_joint(const Loop& loop, std::span<const Variable> variables, std::size_t first,
                                  std::size_t count, double length, bool* doubtful = nullptr);

}  // namespace koppel
