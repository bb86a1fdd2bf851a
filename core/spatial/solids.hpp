// Mass properties of homogeneous solids, about their centre and in axes of symmetry.
#pragma once

#include "spatial/spatial_inertia.hpp"

namespace koppel {

/// Cuboid of the mass [kg] with edges [m] along x, y, z.
template <typename T>
SpatialInertiaT<T> solid_box(const T& mass, const Vector3T<T>& edges) {
  const Vector3T<T> square = edges.cwiseAbs2();
  const Vector3T<T> moments(square.y() + square.z(), square.z() + square.x(), square.x() + square.y());
  return {mass, Vector3T<T>::Zero(), Matrix3T<T>((mass / T(12) * moments).asDiagonal())};
}

/// Cylinder of the mass [kg], of radius and height [m], its axis along z.
template <typename T>
SpatialInertiaT<T> solid_cylinder(const T& mass, const T& radius, const T& height) {
  const T across = mass * (T(3) * radius * radius + height * height) / T(12);
  const Vector3T<T> moments(across, across, mass * radius * radius / T(2));
  return {mass, Vector3T<T>::Zero(), Matrix3T<T>(moments.asDiagonal())};
}

/// Sphere of the mass [kg] and the radius [m].
template <typename T>
SpatialInertiaT<T> solid_sphere(const T& mass, const T& radius) {
  return {mass, Vector3T<T>::Zero(), T(2) / T(5) * mass * radius * radius * Matrix3T<T>::Identity()};
}

/// Rod without thickness, of the mass [kg] and the length [m], along z.
template <typename T>
SpatialInertiaT<T> thin_rod(const T& mass, const T& length) {
  return solid_cylinder<T>(mass, T(0), length);
}

}  // namespace koppel
