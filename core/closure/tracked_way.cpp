#include "closure/tracked_way.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace koppel {
namespace {

VariableKind kind_of(const Piece& piece) {
  switch (piece.kind) {
    case Piece::Kind::slide: return VariableKind::slide;
    case Piece::Kind::ball: return VariableKind::ball;
    case Piece::Kind::turn:
    case Piece::Kind::run: break;
  }
  return VariableKind::turn;
}

Piece::Kind kind_of(VariableKind kind) {
  switch (kind) {
    case VariableKind::slide: return Piece::Kind::slide;
    case VariableKind::ball: return Piece::Kind::ball;
    case VariableKind::turn: break;
  }
  return Piece::Kind::turn;
}

void pass(const Piece& piece, const TrackedPlaces& places, Pose& at) {
  if (piece.kind == Piece::Kind::run) {
    const Run& run = places.runs[piece.index];
    at = at * (piece.inverse ? run.backwards : run.way.end);
  } else {
    apply(kind_of(piece), places.variables[piece.index].at, piece.inverse, at);
  }
}

Twist turn_about(const Pose& frame, const Vector3& rate) { return {rate, frame.position.cross(rate)}; }

/// What a variable's piece does about the origin for 1 of one of its rates.
Twist screw_of(const Piece& piece, const Pose& frame, std::uint8_t rate = 0) {
  const Matrix3& axes = frame.rotation;
  switch (kind_of(piece)) {
    case VariableKind::ball: return turn_about(frame, (piece.inverse ? -1.0 : 1.0) * axes.col(rate));
    case VariableKind::slide: return {Vector3::Zero(), axes.col(2)};
    case VariableKind::turn: break;
  }
  return turn_about(frame, axes.col(2));
}

/// What one piece does, its frame being given; and how it changes by its own motion alone.
WayMotion motion_of(const Piece& piece, const TrackedPlaces& places, const Pose& frame) {
  const double sign = piece.inverse ? -1.0 : 1.0;
  if (piece.kind == Piece::Kind::run) {
    const WayMotion& motion = places.runs[piece.index].motion;
    return {transformed(frame, sign * motion.twist), transformed(frame, sign * motion.rate)};
  }
  const MovingPlace& place = places.variables[piece.index];
  if (piece.kind == Piece::Kind::ball) {
    return {turn_about(frame, sign * (frame.rotation * place.rate)),
            turn_about(frame, sign * (frame.rotation * place.acceleration))};
  }
  const Twist screw = screw_of(piece, frame);
  return {place.rate[0] * screw, place.acceleration[0] * screw};
}

/// The rate of a twist that is carried along with another.
Twist carried(const Twist& twist, const Twist& with) {
  return {with.angular.cross(twist.angular), with.angular.cross(twist.linear) + with.linear.cross(twist.angular)};
}

}  // namespace

Pose turning_round(Piece::Kind kind) {
  Pose result;
  if (kind != Piece::Kind::ball) result.rotation.diagonal() << 1.0, -1.0, -1.0;
  return result;
}

TrackedWay tracked(const Way& way) {
  TrackedWay result;
  Pose before;  // what the leg before leaves to be turned back
  for (const Leg& leg : way.legs) {
    const Piece::Kind kind = kind_of(leg.kind);
    const Pose turned = leg.inverse ? turning_round(kind) : Pose{};
    result.pieces.push_back({kind, leg.inverse && kind == Piece::Kind::ball, leg.variable, before * leg.to * turned});
    before = turned;
  }
  result.last = before * way.last;
  result.frames.resize(result.pieces.size());
  return result;
}

/// What stands before the first piece, and before its motion, is placed.
void TrackedPlaces::place_from(TrackedWay& way, std::size_t first) const {
  Pose at;
  for (std::size_t i = first; i < way.pieces.size(); ++i) {
    const Piece& piece = way.pieces[i];
    const bool behind = piece.kind == Piece::Kind::ball ? !piece.inverse : piece.inverse;
    if (i == 0) {
      at = piece.to;
    } else {
      at = i == first ? way.frames[i] : at * piece.to;
    }
    if (!behind) way.frames[i] = at;
    pass(piece, *this, at);
    if (behind) way.frames[i] = at;
  }
  way.end = at * way.last;
}

void TrackedPlaces::place_again(TrackedWay& way, std::uint32_t moved) const {
  for (std::size_t i = 0; i < way.pieces.size(); ++i) {
    if (way.pieces[i].kind != Piece::Kind::run && way.pieces[i].index == moved) return place_from(way, i);
  }
}

void TrackedPlaces::place(Run& run) const {
  place(run.way);
  run.backwards = run.way.end.inverse();
  if (!run.unknown) return;
  run.screws.clear();
  for (std::size_t i = 0; i < run.way.pieces.size(); ++i) {
    const Piece& piece = run.way.pieces[i];
    const std::uint32_t rates = freedoms_of(kind_of(piece));
    for (std::uint8_t k = 0; k < rates; ++k) {
      run.screws.push_back({piece.index, k, screw_of(piece, run.way.frames[i], k)});
    }
  }
}

WayMotion TrackedPlaces::motion(const TrackedWay& way) const {
  WayMotion sum;
  for (std::size_t i = 0; i < way.pieces.size(); ++i) {
    const WayMotion own = motion_of(way.pieces[i], *this, way.frames[i]);
    sum.rate = i == 0 ? own.rate : sum.rate + own.rate + carried(own.twist, sum.twist);
    sum.twist = sum.twist + own.twist;
  }
  return sum;
}

Twist screw(const TrackedWay& way, std::uint32_t variable) {
  for (std::size_t i = 0; i < way.pieces.size(); ++i) {
    const Piece& piece = way.pieces[i];
    if (piece.kind != Piece::Kind::run && piece.index == variable) return screw_of(piece, way.frames[i]);
  }
  return {};
}

void TrackedPlaces::take_errors(std::span<const double> errors, Run& run) const {
  run.turn_error = 0.0;
  double reach = 0.0, shift = 0.0;
  for (const Piece& piece : run.way.pieces) {
    reach += piece.to.position.norm();
    if (piece.kind == Piece::Kind::slide) {
      reach += std::abs(variables[piece.index].at[0]);
      shift = std::max(shift, errors[piece.index]);
    } else {
      run.turn_error = std::max(run.turn_error, errors[piece.index]);
    }
  }
  // Turns shift the end by as much as the run is long, at most.
  run.shift_error = std::max(shift, run.turn_error * reach);
}

}  // namespace koppel
