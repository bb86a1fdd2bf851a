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

MovingPose moving_end(const Way& way, std::span<const MovingPlace> places) {
  MovingPose at;
  for (const Leg& leg : way.legs) {
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
        const Vector3 acceleration = sign * (axes * place.acceleration);
        // turn() takes the axes as carried along before the ball. Behind it they are carried by it as well, which
        // changes nothing: the rate is its own axis.
        turn(rate, acceleration, at);
        break;
      }
    }
  }
  carry(way.last, at);
  return at;
}

WaySlope slope(const Way& way, std::span<const MovingPlace> places, std::uint32_t variable) {
  WaySlope result;
  Vector3 point = Vector3::Zero();
  for (const Leg& leg : way.legs) {
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
  result.pose = result.pose * way.last;
  result.linear += result.angular.cross(result.pose.position - point);
  return result;
}

}  // namespace koppel
