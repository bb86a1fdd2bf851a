// A way through a loop whose motions have rates and accelerations: how the frame at its end moves against its start
// (K-II-2.1). Constant transformations are merged beforehand.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "closure/loop_cut.hpp"

namespace koppel {

/// Where a variable stands and how it moves.
struct MovingPlace {
  Place<double> at{};              ///< as Place
  Vector3 rate = Vector3::Zero();  ///< of turns and slides the first component
  Vector3 acceleration = Vector3::Zero();
};

/// A pose and its motion, in the axes of the walk's start; velocity and acceleration are of the origin.
struct MovingPose {
  Pose pose;
  Vector3 angular_velocity = Vector3::Zero(), velocity = Vector3::Zero();
  Vector3 angular_acceleration = Vector3::Zero(), acceleration = Vector3::Zero();
};

class MovingWalk {
 public:
  /// The lower or the upper way of a cut, as CutWalk takes them.
  static MovingWalk lower(const Loop& loop, std::span<const Variable> variables, const LoopCut& cut);
  static MovingWalk upper(const Loop& loop, std::span<const Variable> variables, const LoopCut& cut);

  bool passes(std::uint32_t variable) const;
  MovingPose end(std::span<const MovingPlace> places) const;
  /// The pose alone, and how it changes with the rate of one scalar variable (zero if the walk does not pass it).
  struct Slope {
    Pose pose;
    Vector3 angular = Vector3::Zero(), linear = Vector3::Zero();
  };
  Slope slope(std::span<const MovingPlace> places, std::uint32_t variable) const;
  /// The most that an error of one of the other scalar variables [rad, m] changes a condition.
  double sensitivity(std::span<const MovingPlace> places, std::span<const double> errors, std::uint32_t except,
                     const ClosureCondition& condition) const;

 private:
  struct Leg {
    std::uint32_t variable = 0;
    VariableKind kind = VariableKind::turn;
    bool inverse = false;
    Pose to;
  };
  std::vector<Leg> legs_;
  Pose last_;
};

}  // namespace koppel
