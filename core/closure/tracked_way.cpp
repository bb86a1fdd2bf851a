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

/// Carries a moving frame over a constant transformation.
void carry(const Pose& to, MovingPose& at) {
  const Vector3 d = at.pose.rotation * to.position;
  const Vector3 swept = at.angular_velocity.cross(d);
  at.pose.position += d;
  at.velocity += swept;
  at.acceleration += at.angular_acceleration.cross(d) + at.angular_velocity.cross(swept);
  at.pose.rotation = (at.pose.rotation * to.rotation).eval();
}

/// Turns with a rate about an axis that the frame carries along.
void turn(const Vector3& rate, const Vector3& acceleration, MovingPose& at) {
  at.angular_acceleration += acceleration + at.angular_velocity.cross(rate);
  at.angular_velocity += rate;
}

void slide(double d, double rate, double acceleration, MovingPose& at) {
  const Vector3 z = at.pose.rotation.col(2), swept = at.angular_velocity.cross(z);
  at.pose.position += d * z;
  at.velocity += rate * z + d * swept;
  at.acceleration +=
      acceleration * z + 2.0 * rate * swept + d * (at.angular_acceleration.cross(z) + at.angular_velocity.cross(swept));
}

/// Carries a moving frame over a moving transformation.
void carry(const MovingPose& to, MovingPose& at) {
  const Matrix3& r = at.pose.rotation;
  const Vector3 d = r * to.pose.position, velocity = r * to.velocity;
  const Vector3 rate = r * to.angular_velocity, acceleration = r * to.angular_acceleration;
  const Vector3 swept = at.angular_velocity.cross(d);
  at.pose.position += d;
  at.velocity += swept + velocity;
  at.acceleration +=
      at.angular_acceleration.cross(d) + at.angular_velocity.cross(swept + 2.0 * velocity) + r * to.acceleration;
  turn(rate, acceleration, at);
  at.pose.rotation = (r * to.pose.rotation).eval();
}

MovingPose inverse(const MovingPose& x) {
  MovingPose result;
  result.pose = x.pose.inverse();
  const Matrix3& r = result.pose.rotation;
  const Vector3& w = x.angular_velocity;
  // How the start moves, seen from the end: of a point that rests in the start, in axes that turn with the end.
  const Vector3 p = -x.pose.position, relative = -x.velocity - w.cross(p);
  const Vector3 relative_acceleration =
      -x.acceleration - x.angular_acceleration.cross(p) - w.cross(w.cross(p)) - 2.0 * w.cross(relative);
  result.angular_velocity = -(r * w);
  result.velocity = r * relative;
  result.angular_acceleration = -(r * x.angular_acceleration);
  result.acceleration = r * relative_acceleration;
  return result;
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
    at = at * (piece.inverse ? run.backwards : run.forwards).pose;
  } else {
    apply(kind_of(piece), places.variables[piece.index].at, piece.inverse, at);
  }
}

void pass(const Piece& piece, const TrackedPlaces& places, MovingPose& at) {
  if (piece.kind == Piece::Kind::run) {
    const Run& run = places.runs[piece.index];
    carry(piece.inverse ? run.backwards : run.forwards, at);
    return;
  }
  const MovingPlace& place = places.variables[piece.index];
  switch (kind_of(piece)) {
    case VariableKind::turn: {
      const Vector3 axis = at.pose.rotation.col(2);
      apply(VariableKind::turn, place.at, false, at.pose);
      turn(place.rate[0] * axis, place.acceleration[0] * axis, at);
      break;
    }
    case VariableKind::slide: slide(place.at[0], place.rate[0], place.acceleration[0], at); break;
    case VariableKind::ball: {
      // Rates are in the axes of the ball's far side: behind it, or, passed backwards, before it.
      const Matrix3 before = at.pose.rotation;
      apply(VariableKind::ball, place.at, piece.inverse, at.pose);
      const Matrix3& axes = piece.inverse ? before : at.pose.rotation;
      const double sign = piece.inverse ? -1.0 : 1.0;
      // turn() takes the axes as carried along before the ball. Behind it they are carried by it as well, which
      // changes nothing: the rate is its own axis.
      turn(sign * (axes * place.rate), sign * (axes * place.acceleration), at);
      break;
    }
  }
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
  return result;
}

void TrackedPlaces::place_run(Run& run) const {
  Pose at;
  run.screws.clear();
  for (const Piece& piece : run.motions) {
    at = at * piece.to;
    const Matrix3 before = at.rotation;
    pass(piece, *this, at);
    if (!run.unknown) continue;
    const Vector3& p = at.position;
    if (piece.kind == Piece::Kind::ball) {
      const Matrix3 axes = piece.inverse ? Matrix3(-before) : at.rotation;
      for (std::uint8_t k = 0; k < 3; ++k) {
        run.screws.push_back({piece.index, k, axes.col(k), p.cross(axes.col(k))});
      }
    } else if (piece.kind == Piece::Kind::turn) {
      run.screws.push_back({piece.index, 0, at.rotation.col(2), p.cross(at.rotation.col(2))});
    } else {
      run.screws.push_back({piece.index, 0, Vector3::Zero(), at.rotation.col(2)});
    }
  }
  run.forwards.pose = at;
  run.backwards.pose = at.inverse();
}

void TrackedPlaces::move_run(Run& run) const {
  run.forwards = MovingPose{};
  for (const Piece& piece : run.motions) {
    carry(piece.to, run.forwards);
    pass(piece, *this, run.forwards);
  }
  run.backwards = inverse(run.forwards);
}

void TrackedPlaces::take_errors(std::span<const double> errors, Run& run) const {
  run.turn_error = 0.0;
  double reach = 0.0, shift = 0.0;
  for (const Piece& piece : run.motions) {
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

MovingPose moving_end(const TrackedWay& way, const TrackedPlaces& places) {
  MovingPose at;
  for (const Piece& piece : way.pieces) {
    carry(piece.to, at);
    pass(piece, places, at);
  }
  carry(way.last, at);
  return at;
}

WaySlope slope(const TrackedWay& way, const TrackedPlaces& places, std::uint32_t variable) {
  WaySlope result;
  Vector3 point = Vector3::Zero();
  for (const Piece& piece : way.pieces) {
    result.pose = result.pose * piece.to;
    pass(piece, places, result.pose);
    if (piece.kind == Piece::Kind::run || piece.index != variable) continue;
    if (piece.kind == Piece::Kind::turn) {
      result.angular = result.pose.rotation.col(2);
      point = result.pose.position;
    } else {
      result.linear = result.pose.rotation.col(2);
    }
  }
  result.pose = result.pose * way.last;
  result.linear += result.angular.cross(result.pose.position - point);
  return result;
}

Pose end_with_frames(const TrackedWay& way, const TrackedPlaces& places, std::vector<Pose>& frames) {
  frames.clear();
  Pose at;
  for (const Piece& piece : way.pieces) {
    at = at * piece.to;
    // Rates of a ball are about axes of its far side.
    const bool before = piece.kind == Piece::Kind::run ? !piece.inverse : piece.inverse;
    if (before) frames.push_back(at);
    pass(piece, places, at);
    if (!before) frames.push_back(at);
  }
  return at * way.last;
}

}  // namespace koppel
