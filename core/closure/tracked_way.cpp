#include "closure/tracked_way.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace koppel {
namespace {

/// Half a turn about x: what turns the z axis of a frame round.
Pose turned_round(Pose frame) {
  frame.rotation.rightCols<2>() *= -1.0;
  return frame;
}
Pose turned_round_before(Pose frame) {
  frame.rotation.bottomRows<2>() *= -1.0;
  frame.position.tail<2>() *= -1.0;
  return frame;
}

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

/// What turns about an axis, or slides along it, does about the origin.
Twist turn_about(const Pose& frame, const Vector3& rate) { return {rate, frame.position.cross(rate)}; }
Twist slide_along(const Vector3& rate) { return {Vector3::Zero(), rate}; }

/// What one piece does, its frame being given; and how it changes by its own motion alone.
WayMotion motion_of(const Piece& piece, const TrackedPlaces& places, const Pose& frame) {
  const double sign = piece.inverse ? -1.0 : 1.0;
  if (piece.kind == Piece::Kind::run) {
    const WayMotion& motion = places.runs[piece.index].motion;
    return {transformed(frame, sign * motion.twist), transformed(frame, sign * motion.rate)};
  }
  const MovingPlace& place = places.variables[piece.index];
  switch (kind_of(piece)) {
    case VariableKind::slide: {
      const Vector3 axis = frame.rotation.col(2);
      return {slide_along(place.rate[0] * axis), slide_along(place.acceleration[0] * axis)};
    }
    case VariableKind::ball: {
      const Vector3 rate = sign * (frame.rotation * place.rate);
      return {turn_about(frame, rate), turn_about(frame, sign * (frame.rotation * place.acceleration))};
    }
    case VariableKind::turn: break;
  }
  const Vector3 axis = frame.rotation.col(2), moment = frame.position.cross(axis);
  return {{place.rate[0] * axis, place.rate[0] * moment},
          {place.acceleration[0] * axis, place.acceleration[0] * moment}};
}

/// The rate of a twist that is carried along with another.
Twist carried(const Twist& twist, const Twist& with) {
  return {with.angular.cross(twist.angular), with.angular.cross(twist.linear) + with.linear.cross(twist.angular)};
}

}  // namespace

TrackedWay tracked(const Way& way) {
  TrackedWay result;
  bool turned = false;
  for (const Leg& leg : way.legs) {
    Pose to = turned ? turned_round_before(leg.to) : leg.to;
    turned = leg.inverse && leg.kind != VariableKind::ball;
    if (turned) to = turned_round(to);
    result.pieces.push_back({kind_of(leg.kind), leg.inverse && !turned, leg.variable, to});
  }
  result.last = turned ? turned_round_before(way.last) : way.last;
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
    const Pose& frame = run.way.frames[i];
    if (piece.kind == Piece::Kind::ball) {
      const double sign = piece.inverse ? -1.0 : 1.0;
      for (std::uint8_t k = 0; k < 3; ++k) {
        run.screws.push_back({piece.index, k, turn_about(frame, sign * frame.rotation.col(k))});
      }
    } else {
      const Vector3 axis = frame.rotation.col(2);
      run.screws.push_back(
          {piece.index, 0, piece.kind == Piece::Kind::turn ? turn_about(frame, axis) : slide_along(axis)});
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
    if (piece.kind == Piece::Kind::run || piece.index != variable) continue;
    const Vector3 axis = way.frames[i].rotation.col(2);
    return piece.kind == Piece::Kind::turn ? turn_about(way.frames[i], axis) : slide_along(axis);
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
