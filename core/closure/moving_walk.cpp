#include "closure/moving_walk.hpp"

#include <limits>

namespace koppel {
namespace {

constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon();  // what turns less stands still

Standstill standstill(const Pose& pose) {
  const bool turns = (pose.rotation - Matrix3::Identity()).cwiseAbs().maxCoeff() > rounding;
  return {pose, turns, !pose.position.isZero(0.0)};
}

/// Carries a moving frame over a constant transformation.
void carry(const Standstill& to, MovingPose& at) {
  if (to.moves) {
    const Vector3 d = at.pose.rotation * to.pose.position;
    const Vector3 swept = at.angular_velocity.cross(d);
    at.pose.position += d;
    at.velocity += swept;
    at.acceleration += at.angular_acceleration.cross(d) + at.angular_velocity.cross(swept);
  }
  if (to.turns) at.pose.rotation = (at.pose.rotation * to.pose.rotation).eval();
}

/// Turns with a rate about an axis that the frame carries along.
void turn(const Vector3& rate, const Vector3& acceleration, MovingPose& at) {
  at.angular_acceleration += acceleration + at.angular_velocity.cross(rate);
  at.angular_velocity += rate;
}

void slide(const Vector3& axis, double d, double rate, double acceleration, MovingPose& at) {
  const Vector3 swept = at.angular_velocity.cross(axis);
  at.pose.position += d * axis;
  at.velocity += rate * axis + d * swept;
  at.acceleration += acceleration * axis + 2.0 * rate * swept +
                     d * (at.angular_acceleration.cross(axis) + at.angular_velocity.cross(swept));
}

}  // namespace

MovingWay::MovingWay(const Way& way) {
  Pose constant;
  for (const Leg& leg : way.legs) {
    constant = constant * leg.to;
    MovingLeg& moving = legs_.emplace_back();
    moving.variable = leg.variable;
    moving.kind = leg.kind;
    moving.inverse = leg.inverse;
    if (leg.kind == VariableKind::slide) {
      moving.axis = (leg.inverse ? -1.0 : 1.0) * constant.rotation.col(2);
      moving.to = standstill({Matrix3::Identity(), constant.position});
      constant.position.setZero();
    } else {
      moving.to = standstill(constant);
      constant = Pose{};
    }
  }
  last_ = standstill(constant * way.last);
}

MovingPose MovingWay::end(std::span<const MovingPlace> places) const {
  MovingPose at;
  for (const MovingLeg& leg : legs_) {
    const MovingPlace& place = places[leg.variable];
    const double sign = leg.inverse ? -1.0 : 1.0;
    const Vector3 along = at.pose.rotation * leg.axis;
    carry(leg.to, at);
    switch (leg.kind) {
      case VariableKind::turn: {
        const Vector3 axis = sign * at.pose.rotation.col(2);
        apply(leg.kind, place.at, leg.inverse, at.pose);
        turn(place.rate[0] * axis, place.acceleration[0] * axis, at);
        break;
      }
      case VariableKind::slide: slide(along, place.at[0], place.rate[0], place.acceleration[0], at); break;
      case VariableKind::ball: {
        // Rates are in the axes of the ball's far side: behind it, or, passed backwards, before it.
        const Matrix3 before = at.pose.rotation;
        apply(leg.kind, place.at, leg.inverse, at.pose);
        const Matrix3& axes = leg.inverse ? before : at.pose.rotation;
        // turn() takes the axes as carried along before the ball. Behind it they are carried by it as well, which
        // changes nothing: the rate is its own axis.
        turn(sign * (axes * place.rate), sign * (axes * place.acceleration), at);
        break;
      }
    }
  }
  carry(last_, at);
  return at;
}

WaySlope slope(const MovingWay& way, std::span<const MovingPlace> places, std::uint32_t variable) {
  WaySlope result;
  Vector3 point = Vector3::Zero();
  result.pose = way.walk(places, [&](const WayColumn<double>& c) {
    if (c.variable != variable) return;
    result.angular = c.angular;
    result.linear = c.along;
    point = c.point;
  });
  result.linear += result.angular.cross(result.pose.position - point);
  return result;
}

}  // namespace koppel
