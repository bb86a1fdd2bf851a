#include "closure/moving_walk.hpp"

#include <algorithm>
#include <cmath>

namespace koppel {
namespace {

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

}  // namespace

MovingWalk MovingWalk::lower(const Loop& loop, std::span<const Variable> variables, const LoopCut& cut) {
  MovingWalk walk;
  const CutJoint& start = cut.b ? *cut.b : cut.a;
  const std::size_t n = loop.motions.size(), first = start.first + start.count;
  const std::size_t count = (cut.a.first + 2 * n - first) % n;
  Pose constant = start.after.inverse();
  for (std::size_t i = 0; i < count; ++i) {
    const LoopMotion& motion = loop.motions[(first + i) % n];
    const VariableKind kind = variables[motion.variable].kind;
    walk.legs_.push_back({motion.variable, kind, kind == VariableKind::ball && motion.inverse, constant * motion.to});
    constant = Pose{};
  }
  walk.last_ = constant * cut.a.before;
  return walk;
}

MovingWalk MovingWalk::upper(const Loop& loop, std::span<const Variable> variables, const LoopCut& cut) {
  MovingWalk walk;
  if (!cut.b) return walk;
  const std::size_t n = loop.motions.size(), first = cut.a.first + cut.a.count;
  const std::size_t count = (cut.b->first + 2 * n - first) % n;
  Pose constant = cut.b->before.inverse();
  for (std::size_t i = count; i-- > 0;) {
    const LoopMotion& motion = loop.motions[(first + i) % n];
    const VariableKind kind = variables[motion.variable].kind;
    const bool inverse = (kind == VariableKind::ball && motion.inverse) != true;
    walk.legs_.push_back({motion.variable, kind, inverse, constant});
    constant = motion.to.inverse();
  }
  walk.last_ = constant * cut.a.after;
  return walk;
}

bool MovingWalk::passes(std::uint32_t variable) const {
  return std::any_of(legs_.begin(), legs_.end(), [variable](const Leg& leg) { return leg.variable == variable; });
}

MovingPose MovingWalk::end(std::span<const MovingPlace> places) const {
  MovingPose at;
  for (const Leg& leg : legs_) {
    const MovingPlace& place = places[leg.variable];
    const double sign = leg.inverse ? -1.0 : 1.0;
    carry(leg.to, at);
    switch (leg.kind) {
      case VariableKind::turn: {
        const Vector3 axis = sign * at.pose.rotation.col(2);
        apply(leg.kind, place.at, leg.inverse, at.pose);
        turn(place.rate[0] * axis, place.acceleration[0] * axis, at);
        break;
      }
      case VariableKind::slide:
        slide(sign * place.at[0], sign * place.rate[0], sign * place.acceleration[0], at);
        break;
      case VariableKind::ball: {
        // Rates are in the axes of the ball's far side: behind it, or, passed backwards, before it.
        const Matrix3 before = at.pose.rotation;
        apply(leg.kind, place.at, leg.inverse, at.pose);
        const Matrix3& axes = leg.inverse ? before : at.pose.rotation;
        const Vector3 rate = sign * (axes * place.rate);
        Vector3 acceleration = sign * (axes * place.acceleration);
        // turn() takes the axes as carried along before the ball. Behind it they are carried by it as well, which
        // changes nothing: the rate is its own axis.
        turn(rate, acceleration, at);
        break;
      }
    }
  }
  carry(last_, at);
  return at;
}

MovingWalk::Slope MovingWalk::slope(std::span<const MovingPlace> places, std::uint32_t variable) const {
  Slope result;
  Vector3 point = Vector3::Zero();
  for (const Leg& leg : legs_) {
    result.pose = result.pose * leg.to;
    apply(leg.kind, places[leg.variable].at, leg.inverse, result.pose);
    if (leg.variable != variable) continue;
    const Vector3 axis = (leg.inverse ? -1.0 : 1.0) * result.pose.rotation.col(2);
    if (leg.kind == VariableKind::turn) {
      result.angular = axis;
      point = result.pose.position;
    } else {
      result.linear = axis;
    }
  }
  result.pose = result.pose * last_;
  result.linear += result.angular.cross(result.pose.position - point);
  return result;
}

double MovingWalk::sensitivity(std::span<const MovingPlace> places, std::span<const double> errors,
                               std::uint32_t except, const ClosureCondition& condition) const {
  // The end is needed for every leg: a second pass after it.
  const Pose end = slope(places, except).pose;
  double most = 0.0;
  Pose at;
  for (const Leg& leg : legs_) {
    at = at * leg.to;
    apply(leg.kind, places[leg.variable].at, leg.inverse, at);
    if (leg.variable == except || errors[leg.variable] == 0.0 || leg.kind == VariableKind::ball) continue;
    const Vector3 axis = at.rotation.col(2);
    const bool turns = leg.kind == VariableKind::turn;
    const Vector3 angular = turns ? axis : Vector3::Zero();
    const Vector3 linear = turns ? Vector3(axis.cross(end.position - at.position)) : axis;
    most = std::max(most, std::abs(change(condition, end, angular, linear)) * errors[leg.variable]);
  }
  return most;
}

}  // namespace koppel
