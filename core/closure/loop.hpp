// A loop as the sequence of its elementary motions, whoever modelled their joints: turns about axes, slides along axes
// and free turns about points, with constant transformations between them. What a loop can do is read off this
// sequence alone; joints and bodies no longer matter.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/id.hpp"
#include "mechanism/mechanism.hpp"
#include "spatial/pose.hpp"

namespace koppel {

/// An unknown, or known, coordinate of an elementary motion. Balls have four numbers in q and three rates.
enum class VariableKind { turn, slide, ball };

/// Its rates.
constexpr std::uint32_t freedoms_of(VariableKind kind) { return kind == VariableKind::ball ? 3 : 1; }

struct Variable {
  VariableKind kind = VariableKind::turn;
  std::uint32_t q = 0, v = 0;  ///< where it stands in the state
  JointId joint;
};

/// One motion on the way round a loop. Turns are about the z axis of the motion's frame, slides along it, balls about
/// its origin; where the coordinate is zero nothing has moved.
struct LoopMotion {
  std::uint32_t variable = 0;  ///< number of the Variable
  Pose to;                     ///< the motion's frame, in the frame that the motion before it has moved
  bool inverse = false;        ///< of a ball: the loop passes it from its outlet to its inlet
};

/// The product of all `to` and motions, once round, is the identity (K-II-3.1).
struct Loop {
  std::vector<LoopMotion> motions;
  std::vector<JointId> joints;  ///< in the order of the walk
};

/// An imaginary joint that lets a body move freely against another: three slides along the axes of a and a ball at the
/// origin of b. It makes their relative pose known to the loops, as auxiliary coordinates (K-II-4.3.2).
struct ImaginaryJoint {
  BodyId a, b;
};

/// All variables and independent loops of a mechanism whose loops are products of turns, slides and balls.
struct Loops {
  std::vector<Variable> variables;  ///< of all joints, in file order, then of the imaginary ones
  std::vector<Loop> loops;
  /// Imaginary joints are numbered on from those of the mechanism, as are their coordinates and rates from the state's.
  std::vector<ImaginaryJoint> imaginary;
};

/// How loops are chosen.
struct LoopChoice {
  std::optional<JointId> favoured;          ///< a joint that counts for nothing: loops go through it where they can
  std::optional<ImaginaryJoint> imaginary;  ///< likewise, and added to the mechanism
};

/// Independent loops of least size (K-II-4.2.1), counted by their freedoms, and of equal ones those that share least.
/// `obstacle` names what cannot be written so: a joint with a pitch or one that is no product of elementary motions, or
/// a constraint; the loops are empty then.
struct LoopsOrObstacle {
  Loops loops;
  std::string obstacle;
};
LoopsOrObstacle find_loops(const Mechanism& mechanism, const LoopChoice& choice = {});

}  // namespace koppel
