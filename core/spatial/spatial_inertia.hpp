// Mass properties of rigid bodies: spatial inertia, momentum and kinetic energy.
#pragma once

#include <span>

#include "spatial/tensor.hpp"
#include "spatial/twist.hpp"

namespace koppel {

/// Inertia tensor [kg m^2] of a mass [kg] in a point, about a point from which it lies at d [m]: m (|d|^2 I - d d^T),
/// what Steiner's theorem adds.
template <typename T>
Matrix3T<T> steiner(const T& mass, const Vector3T<T>& d) {
  return -mass * (skew(d) * skew(d));
}

/// Momentum of a body [angular; linear]: angular momentum [N m s] about the origin of Frame and linear momentum [N s],
/// in the axes of Frame. It changes frame as a wrench does.
template <typename T, typename Frame = Unnamed>
struct MomentumT {
  Vector3T<T> angular = Vector3T<T>::Zero();
  Vector3T<T> linear = Vector3T<T>::Zero();

  MomentumT operator+(const MomentumT& o) const { return {angular + o.angular, linear + o.linear}; }
  MomentumT operator-(const MomentumT& o) const { return {angular - o.angular, linear - o.linear}; }
  MomentumT operator-() const { return {-angular, -linear}; }
  Vector6T<T> vector() const { return (Vector6T<T>() << angular, linear).finished(); }
};

/// Mass properties of a rigid body as seen from Frame, which need not be fixed to it: mass [kg], centre of mass [m]
/// from the origin of Frame, and inertia tensor [kg m^2] about the centre of mass, all in the axes of Frame. The
/// default is no body.
template <typename T, typename Frame = Unnamed>
struct SpatialInertiaT {
  T mass = T(0);
  Vector3T<T> centre = Vector3T<T>::Zero();
  Matrix3T<T> about_centre = Matrix3T<T>::Zero();

  /// Inertia tensor [kg m^2] about the origin of Frame.
  Matrix3T<T> about_origin() const { return about_centre + steiner<T>(mass, centre); }

  /// The 6x6 matrix that maps twists [angular; linear] on momenta [angular; linear], symmetric.
  Matrix6T<T> matrix() const {
    const Matrix3T<T> first_moment = skew(Vector3T<T>(mass * centre));
    Matrix6T<T> m;
    m << about_origin(), first_moment, -first_moment, mass * Matrix3T<T>::Identity();
    return m;
  }

  /// Of two bodies taken as one. Of two without mass the centre is halfway between theirs.
  SpatialInertiaT operator+(const SpatialInertiaT& o) const {
    const T total = mass + o.mass, part = total == T(0) ? T(0.5) : T(o.mass / total);
    const Vector3T<T> apart = o.centre - centre;
    return {total, centre + part * apart, about_centre + o.about_centre + steiner<T>(mass * part, apart)};
  }
};

using Momentum = MomentumT<double>;
using SpatialInertia = SpatialInertiaT<double>;

/// The momentum of B in A: about the origin and in the axes of A.
template <typename To = Unnamed, typename T, typename From>
MomentumT<T, To> transformed(const PoseT<T>& x_ab, const MomentumT<T, From>& momentum) {
  const Vector3T<T> linear = x_ab.rotation * momentum.linear;
  return {x_ab.rotation * momentum.angular + x_ab.position.cross(linear), linear};
}

/// The spatial inertia of B in A: the same body, seen from A.
template <typename To = Unnamed, typename T, typename From>
SpatialInertiaT<T, To> transformed(const PoseT<T>& x_ab, const SpatialInertiaT<T, From>& inertia) {
  return {inertia.mass, x_ab * inertia.centre, tensor_in<T>(x_ab.rotation, inertia.about_centre)};
}

/// Momentum of a body that moves with the twist, at the same origin and in the same axes. Angular about the origin: M
/// v.
template <typename T, typename Frame>
MomentumT<T, Frame> momentum(const SpatialInertiaT<T, Frame>& inertia, const TwistT<T, Frame>& twist) {
  const Vector3T<T> linear = inertia.mass * velocity_at(twist, inertia.centre);
  return {inertia.about_centre * twist.angular + inertia.centre.cross(linear), linear};
}

/// Kinetic energy [J] of a body that moves with the twist: v^T M v / 2.
template <typename T, typename Frame>
T kinetic_energy(const SpatialInertiaT<T, Frame>& inertia, const TwistT<T, Frame>& twist) {
  const T translation = inertia.mass * velocity_at(twist, inertia.centre).squaredNorm();
  const T rotation = twist.angular.dot(inertia.about_centre * twist.angular);
  return T(0.5) * (translation + rotation);
}

/// A mass [kg] in a point [m].
template <typename T>
struct PointMassT {
  T mass = T(0);
  Vector3T<T> position = Vector3T<T>::Zero();
};

using PointMass = PointMassT<double>;

/// Of point masses that make up a rigid body. The moments are taken about the centre of mass from the start, and the
/// centre from the first point: a far origin costs no digits. Without mass the centre is that first point.
template <typename T>
SpatialInertiaT<T> inertia_from_points(std::span<const PointMassT<T>> points) {
  SpatialInertiaT<T> body;
  if (points.empty()) return body;
  const Vector3T<T> start = points.front().position;
  Vector3T<T> moment = Vector3T<T>::Zero();
  for (const PointMassT<T>& point : points) {
    body.mass += point.mass;
    moment += point.mass * (point.position - start);
  }
  const Vector3T<T> offset = body.mass == T(0) ? Vector3T<T>(Vector3T<T>::Zero()) : Vector3T<T>(moment / body.mass);
  body.centre = start + offset;
  for (const PointMassT<T>& point : points) {
    body.about_centre += steiner<T>(point.mass, point.position - start - offset);
  }
  return body;
}

/// From the tensor [kg m^2] about the origin instead of that about the centre of mass [m]. Loses the digits by which
/// the first is the greater.
template <typename T>
SpatialInertiaT<T> inertia_from_tensor_about_origin(const T& mass, const Vector3T<T>& centre,
                                                    const Matrix3T<T>& about_origin) {
  return {mass, centre, about_origin - steiner<T>(mass, centre)};
}

/// From the principal moments [kg m^2] about the centre of mass [m], and the principal axes as columns of a rotation.
template <typename T>
SpatialInertiaT<T> inertia_from_principal_moments(const T& mass, const Vector3T<T>& centre, const Vector3T<T>& moments,
                                                  const Matrix3T<T>& axes) {
  return {mass, centre, axes * moments.asDiagonal() * axes.transpose()};
}

}  // namespace koppel
