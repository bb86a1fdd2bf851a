// Ways through loops as a tracker passes them: motions one by one, and runs of motions that several ways have in
// common, whose product is computed once; with rates and accelerations (K-II-2.1). Nothing is allocated once they are
// made.
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

/// A motion on a tracked way, or a run of them, and the constant transformation before it. Turns and slides are always
/// passed forwards: backwards they are what they are forwards in a frame whose z axis points the other way.
struct Piece {
  enum class Kind : std::uint8_t { turn, slide, ball, run };
  Kind kind = Kind::turn;
  bool inverse = false;     ///< a ball, or a run, is passed backwards
  std::uint32_t index = 0;  ///< variable, or run
  Pose to;
};

struct TrackedWay {
  std::vector<Piece> pieces;
  Pose last;
};
TrackedWay tracked(const Way& way);

/// A screw of a run, about the origin of its start and in its axes.
struct RunScrew {
  std::uint32_t variable = 0;
  std::uint8_t rate = 0;  ///< of a ball: about its x, y, z
  Vector3 angular, linear;
};

/// Consecutive motions; begins in the frame of the first and ends in that which the last has moved.
struct Run {
  std::vector<Piece> motions;
  bool unknown = false;  ///< of a block: its screws are wanted
  // Where it stands.
  MovingPose forwards, backwards;
  std::vector<RunScrew> screws;
  double turn_error = 0.0, shift_error = 0.0;  ///< of its end [rad, m]
};

struct TrackedPlaces {
  std::vector<MovingPlace> variables;
  std::vector<Run> runs;

  /// Takes over where a run's variables stand.
  void place_run(Run& run) const;
  /// And how they move.
  void move_run(Run& run) const;
  /// errors: of the variables [rad, m].
  void take_errors(std::span<const double> errors, Run& run) const;
};

/// A way, and the variables that its step solves for.
struct WayOfStep {
  TrackedWay* way = nullptr;
  std::span<const std::uint32_t> unknowns;
  int walks = 1;  ///< how often the step walks along it
};

/// Puts runs in place of motions that are passed together often enough. No run mixes what a step solves for with what
/// it is given. `unknown` is set of those that a step solves for.
std::vector<Run> share_runs(std::span<const WayOfStep> ways);

/// The end of a way in its start, and how it moves.
MovingPose moving_end(const TrackedWay& way, const TrackedPlaces& places);

/// The end of a way, and how it changes with the rate of one scalar variable (zero if the way does not pass it).
struct WaySlope {
  Pose pose;
  Vector3 angular = Vector3::Zero(), linear = Vector3::Zero();
};
WaySlope slope(const TrackedWay& way, const TrackedPlaces& places, std::uint32_t variable);

/// The end of a way. frames: of each piece the one whose axes its rates are about: of a turn, a slide or a ball behind
/// it, of a run before it; of what is passed backwards on the other side.
Pose end_with_frames(const TrackedWay& way, const TrackedPlaces& places, std::vector<Pose>& frames);

}  // namespace koppel
