// Motion of a point along its path: velocity, acceleration, and their natural (Frenet) components.
#pragma once

#include <limits>

#include "spatial/dual.hpp"
#include "spatial/pose.hpp"
#include "spatial/vector.hpp"

namespace koppel {

/// Where a point is and how it moves: position r [m], velocity dr/dt [m/s] and acceleration d2r/dt2 [m/s^2], seen from
/// one fixed frame and in its axes. The velocity is tangential to the path (K-I-3.1.1, K-I-3.1.2).
template <typename T>
struct PointMotionT {
  Vector3T<T> position = Vector3T<T>::Zero();
  Vector3T<T> velocity = Vector3T<T>::Zero();
  Vector3T<T> acceleration = Vector3T<T>::Zero();
};

using PointMotion = PointMotionT<double>;

/// The time t [s] as a number that knows that its rate is one: what is computed from it carries its first and second
/// derivative, x in .real.real, dx/dt in .real.dual, d2x/dt2 in .dual.dual (K-I-6.1.2).
template <typename T>
Dual<Dual<T>> differentiable_time(const T& t) {
  return {{t, T(1)}, {T(1), T(0)}};
}

/// Motion at the time t [s] of a point on the path r(t) [m], exact to rounding. The path is any function from a
/// Dual<Dual<T>> to a Vector3T<Dual<Dual<T>>> (K-I-3.1.1, K-I-3.1.2, K-I-3.1.3).
template <typename T, typename Path>
PointMotionT<T> point_motion(const Path& path, const T& t) {
  const Vector3T<Dual<Dual<T>>> r = path(differentiable_time<T>(t));
  return {r.unaryExpr([](const Dual<Dual<T>>& x) { return x.real.real; }),
          r.unaryExpr([](const Dual<Dual<T>>& x) { return x.real.dual; }),
          r.unaryExpr([](const Dual<Dual<T>>& x) { return x.dual.dual; })};
}

/// The same motion seen from A, in which B lies fixed: the same path, in other coordinates (K-I-3.1.1).
template <typename T>
PointMotionT<T> transformed(const PoseT<T>& x_ab, const PointMotionT<T>& motion) {
  return {x_ab * motion.position, x_ab.rotation * motion.velocity, x_ab.rotation * motion.acceleration};
}

/// What a path looks like at a point of it.
enum class PathKind {
  not_finite,  ///< velocity or acceleration is no number; nothing else is given
  at_rest,     ///< no velocity, hence no tangent; nothing else is given
  straight,    ///< no curvature; neither normal nor binormal
  curved,
};

/// Natural components of a motion. What the kind does not have is zero.
template <typename T>
struct NaturalComponentsT {
  PathKind kind = PathKind::at_rest;
  T speed = T(0);                              ///< ds/dt [m/s]
  Vector3T<T> tangent = Vector3T<T>::Zero();   ///< direction of the velocity
  Vector3T<T> normal = Vector3T<T>::Zero();    ///< principal normal, towards the centre of curvature
  Vector3T<T> binormal = Vector3T<T>::Zero();  ///< tangent x normal
  T tangential_acceleration = T(0);            ///< d(speed)/dt [m/s^2]
  T normal_acceleration = T(0);                ///< speed^2 / radius [m/s^2]
  T curvature = T(0);                          ///< [1/m]
  T radius = T(0);                             ///< of curvature [m]; infinite where straight
};

using NaturalComponents = NaturalComponentsT<double>;

/// Natural components of a motion with velocity v [m/s] and acceleration a [m/s^2] in a fixed frame, in its axes.
/// Straight is decided by the sine of the angle between the two, whatever their sizes: below rounding_floor() nothing
/// is left of the normal. Above it normal, binormal and curvature are good to rounding over the sine, and the three
/// directions are orthonormal to rounding. At rest means exactly at rest: v alone has no scale (K-I-3.1.2, K-I-3.1.3).
template <typename T>
NaturalComponentsT<T> natural_components(const Vector3T<T>& v, const Vector3T<T>& a) {
  if (!is_finite<T>(v) || !is_finite<T>(a)) return {.kind = PathKind::not_finite};
  NaturalComponentsT<T> natural;
  const auto along = polar<T>(v);
  if (!along) return natural;
  natural.kind = PathKind::straight;
  natural.speed = along->length;
  natural.tangent = along->direction;
  natural.radius = T(std::numeric_limits<double>::infinity());
  const auto whole = polar<T>(a);
  if (!whole) return natural;
  natural.tangential_acceleration = whole->length * natural.tangent.dot(whole->direction);
  const Vector3T<T> across = natural.tangent.cross(whole->direction);
  const T sine = across.norm();
  if (!(sine > rounding_floor<T>())) return natural;
  natural.kind = PathKind::curved;
  // Normal before binormal: the product with the tangent takes out what rounding has left along it.
  natural.normal = across.cross(natural.tangent).normalized();
  natural.binormal = natural.tangent.cross(natural.normal);
  natural.normal_acceleration = whole->length * sine;
  natural.curvature = natural.normal_acceleration / natural.speed / natural.speed;
  natural.radius = natural.speed * (natural.speed / natural.normal_acceleration);
  return natural;
}

template <typename T>
NaturalComponentsT<T> natural_components(const PointMotionT<T>& motion) {
  return natural_components<T>(motion.velocity, motion.acceleration);
}

}  // namespace koppel
