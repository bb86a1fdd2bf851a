// Ways through loops as a tracker passes them: motions one by one, and runs of motions that several ways have in
// common, whose product is computed once; with rates and accelerations (K-II-2.1). Nothing is allocated once they are
// made.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "closure/loop_cut.hpp"
#include "spatial/twist.hpp"

namespace koppel {

/// Where a variable stands and how it moves.
struct MovingPlace {
  Place<double> at{};              ///< as Place
  Vector3 rate = Vector3::Zero();  ///< of turns and slides the first component
  Vector3 acceleration = Vector3::Zero();
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

/// Half a turn about x: between two of them a turn or a slide does forwards what it does backwards without. Of a ball
/// nothing.
Pose turning_round(Piece::Kind kind);

struct TrackedWay {
  std::vector<Piece> pieces;
  Pose last;
  // Where it stands, in the frame of its start.
  /// Of each piece the frame whose axes its rates are about: of a turn, a slide or a run before it, of a ball behind
  /// it; of a ball or a run that is passed backwards on the other side.
  std::vector<Pose> frames;
  Pose end;
};
TrackedWay tracked(const Way& way);

/// How the end of a way moves: its twist about the origin of the start, in the axes of the start, and its derivative.
struct WayMotion {
  Twist twist, rate;

  /// Of the end's origin, which stands at p.
  Vector3 velocity(const Vector3& p) const { return velocity_at(twist, p); }
  Vector3 acceleration(const Vector3& p) const { return velocity_at(rate, p) + twist.angular.cross(velocity(p)); }
};

/// What a run does per rad/s or m/s of one of its rates.
struct RunScrew {
  std::uint32_t variable = 0;
  std::uint8_t rate = 0;  ///< of a ball: about its x, y, z
  Twist twist;            ///< about the origin of the run's start
};

/// Consecutive motions; begins in the frame of the first and ends in that which the last has moved.
struct Run {
  TrackedWay way;
  bool unknown = false;  ///< of a block: its screws are wanted
  // Where it stands and how it moves.
  Pose backwards;  ///< its start in its end
  WayMotion motion;
  std::vector<RunScrew> screws;
  double turn_error = 0.0, shift_error = 0.0;  ///< of its end [rad, m]
};

/// Where all variables and runs stand.
struct TrackedPlaces {
  std::vector<MovingPlace> variables;
  std::vector<Run> runs;

  /// Takes over where the way's variables and runs stand.
  void place(TrackedWay& way) const { place_from(way, 0); }
  /// Again after one turn or slide has moved.
  void place_again(TrackedWay& way, std::uint32_t moved) const;
  void place(Run& run) const;
  /// How the end of a way moves that is placed.
  WayMotion motion(const TrackedWay& way) const;
  void move(Run& run) const { run.motion = motion(run.way); }
  /// errors: of the variables [rad, m].
  void take_errors(std::span<const double> errors, Run& run) const;

 private:
  void place_from(TrackedWay& way, std::size_t first) const;
};

/// The end's twist for the rate 1 of one turn or slide, about the origin of the start; zero if the way does not pass
/// it.
Twist screw(const TrackedWay& way, std::uint32_t variable);

/// A way, and the variables that its step solves for.
struct WayOfStep {
  TrackedWay* way = nullptr;
  std::span<const std::uint32_t> unknowns;
  int walks = 1;  ///< how often the step walks along it
};

/// Puts runs in place of motions that are passed together often enough. No run mixes what a step solves for with what
/// it is given. `unknown` is set of those that a step solves for.
std::vector<Run> share_runs(std::span<const WayOfStep> ways);

}  // namespace koppel
