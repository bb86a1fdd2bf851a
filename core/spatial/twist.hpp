// Twists and wrenches: the velocity state of a body, and the forces on it, at the origin of a frame and in its axes.
#pragma once

#include "spatial/pose.hpp"

namespace koppel {

/// The frame of a twist or wrench that nobody has named. Whoever names frames (any empty type will do) has the compiler
/// refuse sums over different reference points or axes (K-I-6.2.3a).
struct Unnamed {};

/// Velocity state of a body [angular; linear] (C-6, K-I-3.3.2b): angular velocity [rad/s], and velocity [m/s] of the
/// point of the body, imagined extended, that is passing the origin of Frame; both in the axes of Frame.
template <typename T, typename Frame = Unnamed>
struct TwistT {
  Vector3T<T> angular = Vector3T<T>::Zero();
  Vector3T<T> linear = Vector3T<T>::Zero();

  TwistT operator+(const TwistT& o) const { return {angular + o.angular, linear + o.linear}; }
  TwistT operator-(const TwistT& o) const { return {angular - o.angular, linear - o.linear}; }
  TwistT operator-() const { return {-angular, -linear}; }
  friend TwistT operator*(const T& factor, const TwistT& t) { return {factor * t.angular, factor * t.linear}; }
  Vector6T<T> vector() const { return (Vector6T<T>() << angular, linear).finished(); }
};

/// Forces on a body [moment; force]: moment [N m] about the origin of Frame and resultant force [N], in the axes of
/// Frame.
template <typename T, typename Frame = Unnamed>
struct WrenchT {
  Vector3T<T> moment = Vector3T<T>::Zero();
  Vector3T<T> force = Vector3T<T>::Zero();

  WrenchT operator+(const WrenchT& o) const { return {moment + o.moment, force + o.force}; }
  WrenchT operator-(const WrenchT& o) const { return {moment - o.moment, force - o.force}; }
  WrenchT operator-() const { return {-moment, -force}; }
  friend WrenchT operator*(const T& factor, const WrenchT& w) { return {factor * w.moment, factor * w.force}; }
  Vector6T<T> vector() const { return (Vector6T<T>() << moment, force).finished(); }
};

using Twist = TwistT<double>;
using Wrench = WrenchT<double>;

/// Velocity of the body's point at p [m], both in Frame: v + omega x p (K-I-3.3.2a).
template <typename T, typename Frame>
Vector3T<T> velocity_at(const TwistT<T, Frame>& twist, const Vector3T<T>& p) {
  return twist.linear + twist.angular.cross(p);
}

/// The same velocity state for the reference point at p [m], axes as before (K-I-3.3.2b).
template <typename To = Unnamed, typename T, typename From>
TwistT<T, To> shifted(const TwistT<T, From>& twist, const Vector3T<T>& p) {
  return {twist.angular, velocity_at(twist, p)};
}

/// The same forces with their moment about the point at p [m], axes as before.
template <typename To = Unnamed, typename T, typename From>
WrenchT<T, To> shifted(const WrenchT<T, From>& wrench, const Vector3T<T>& p) {
  return {wrench.moment - p.cross(wrench.force), wrench.force};
}

/// The twist of B in A: origin and axes of A (K-I-6.2.5).
template <typename To = Unnamed, typename T, typename From>
TwistT<T, To> transformed(const PoseT<T>& x_ab, const TwistT<T, From>& twist) {
  const Vector3T<T> angular = x_ab.rotation * twist.angular;
  return {angular, x_ab.rotation * twist.linear + x_ab.position.cross(angular)};
}

/// The wrench of B in A: its moment about A's origin, axes of A (K-I-6.2.5).
template <typename To = Unnamed, typename T, typename From>
WrenchT<T, To> transformed(const PoseT<T>& x_ab, const WrenchT<T, From>& wrench) {
  const Vector3T<T> force = x_ab.rotation * wrench.force;
  return {x_ab.rotation * wrench.moment + x_ab.position.cross(force), force};
}

/// Power [W] of forces on a body that moves: the same in every frame that both are written in.
template <typename T, typename Frame>
T power(const WrenchT<T, Frame>& wrench, const TwistT<T, Frame>& twist) {
  return wrench.moment.dot(twist.angular) + wrench.force.dot(twist.linear);
}

/// The 6x6 matrix of X_AB on twists [angular; linear]: [[R, 0], [skew(p) R, R]] (K-I-6.2.5). Its inverse transpose acts
/// on wrenches.
template <typename T>
Matrix6T<T> adjoint(const PoseT<T>& x_ab) {
  Matrix6T<T> m;
  for (int k = 0; k < 3; ++k) {
    const Vector3T<T> axis = x_ab.rotation.col(k);
    m.col(k) << axis, x_ab.position.cross(axis);
    m.col(3 + k) << Vector3T<T>::Zero(), axis;
  }
  return m;
}

/// The 6x6 matrix of the Lie bracket: bracket(a) b is the rate of twist b carried along with a.
template <typename T, typename Frame>
Matrix6T<T> bracket(const TwistT<T, Frame>& a) {
  Matrix6T<T> m = Matrix6T<T>::Zero();
  m.template topLeftCorner<3, 3>() = skew(a.angular);
  m.template bottomRightCorner<3, 3>() = skew(a.angular);
  m.template bottomLeftCorner<3, 3>() = skew(a.linear);
  return m;
}

}  // namespace koppel
