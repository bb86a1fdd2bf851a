// The freedoms of a mechanism where it stands, and why counting them gives what it gives: planar and spherical loops,
// singular positions, freedoms that belong to one body alone, reactions that statics does not determine.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "closure/work.hpp"
#include "mechanism/state.hpp"
#include "spatial/screw_axis.hpp"

namespace koppel {

/// What the joints of a loop let its bodies do (K-II-1.1.2): planar, all move in parallel planes; spherical, all turn
/// about one point.
enum class LoopKind { spatial, planar, spherical };

/// A loop's kind, wherever it lies in the world.
struct LoopFreedoms {
  LoopKind kind = LoopKind::spatial;
  /// How many conditions close it: the dimension of the group of motions that its joints make. Six; three of planar and
  /// spherical loops; four of spatial ones whose axes are all parallel; fewer where nothing turns or all is on one
  /// axis.
  int conditions = 6;
  Vector3 normal = Vector3::Zero();  ///< of the planes, in the world; zero unless planar
  Vector3 centre = Vector3::Zero();  ///< in the world [m]; zero unless spherical
};

/// A joint that can be under load although nothing loads the mechanism: along which axes of its inlet frame, x y z.
struct IndeterminateReaction {
  JointId joint;
  std::array<bool, 3> moment{}, force{};
};

/// A body that can move while all others rest, held between two of them or more: a link that spins between two balls.
struct IsolatedFreedom {
  BodyId body;
  ScrewAxis axis;  ///< in the world
};

struct Freedoms {
  std::vector<LoopFreedoms> loops;    ///< as the mechanism's relations, without constraints
  std::int32_t mobility_by_kind = 0;  ///< Gruebler, with the conditions that each loop needs (K-II-1.3.2)
  std::int32_t mobility_here = 0;     ///< by rank where the mechanism stands
  std::int32_t mobility_nearby =
      0;  ///< by rank at closed positions near by, if there are any: fewer, if this is singular
  std::uint32_t redundant_here = 0;  ///< equations that follow from the others
  std::uint32_t redundant_nearby = 0;
  /// The rank grants freedoms, but no closed position was found near by: the mechanism gives way without moving.
  bool shaky = false;
  std::vector<IsolatedFreedom> isolated;
  std::vector<IndeterminateReaction> indeterminate;
  std::vector<ScrewAxis> axes;  ///< of all bodies' velocities against the ground, if the state has velocities
};

/// At a closed state (is_closed()), inputs taken for free. False: a plugin failed.
bool find_freedoms(Work& work, const State& state, Freedoms& freedoms);

}  // namespace koppel
