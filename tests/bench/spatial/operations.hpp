// The operations that are measured: koppel's functions in the precision T. In double they are what is timed, in long
// double what all libraries are compared with.
#pragma once

#include <string>
#include <tuple>

#include "spatial/angle_sequence.hpp"
#include "spatial/axis_angle.hpp"
#include "spatial/direction_cosines.hpp"
#include "spatial/displacement.hpp"
#include "spatial/euler_parameters.hpp"
#include "spatial/interpolation.hpp"
#include "spatial/pose_exponential.hpp"
#include "spatial/rodrigues_parameters.hpp"
#include "spatial/rotation_vector.hpp"
#include "spatial/twist.hpp"

namespace koppel::bench {

template <typename C>
inline constexpr const char* name_of = nullptr;
template <>
inline constexpr const char* name_of<DirectionCosines> = "matrix";
template <>
inline constexpr const char* name_of<AxisAngle> = "axis_angle";
template <>
inline constexpr const char* name_of<RotationVector> = "rotation_vector";
template <>
inline constexpr const char* name_of<EulerParameters> = "quaternion";
template <>
inline constexpr const char* name_of<RodriguesParameters> = "rodrigues";
template <>
inline constexpr const char* name_of<EulerAngles> = "euler_zxz";
template <>
inline constexpr const char* name_of<CardanAngles> = "cardan_xyz";
template <>
inline constexpr const char* name_of<YawPitchRoll> = "yaw_pitch_roll";

/// Rotation matrices are given and taken as such, all other coordinates as columns.
template <typename C, typename T>
using Coordinates = std::conditional_t<std::is_same_v<C, DirectionCosines>, Matrix3T<T>, Eigen::Matrix<T, C::size, 1>>;

template <typename From_, typename To_, typename T>
struct Conversion {
  using From = From_;
  using To = To_;
  Coordinates<To, T> operator()(const Coordinates<From, T>& x) const {
    if constexpr (std::is_same_v<To, DirectionCosines>) {
      return rotation<From, T>(x);
    } else if constexpr (std::is_same_v<From, DirectionCosines>) {
      return extracted<To, T>(x).coordinates;
    } else {
      return converted<To, From, T>(x).coordinates;
    }
  }
};

template <typename From, typename To, typename T, typename Table>
void list_conversion(Table& table) {
  if constexpr (!std::is_same_v<From, To>) {
    table.template add<Coordinates<From, T>>(std::string(name_of<From>) + "_to_" + name_of<To>,
                                             Conversion<From, To, T>{});
  }
}

template <typename From, typename T, typename Table>
void list_conversions(Table& table) {
  list_conversion<From, DirectionCosines, T>(table);
  list_conversion<From, AxisAngle, T>(table);
  list_conversion<From, RotationVector, T>(table);
  list_conversion<From, EulerParameters, T>(table);
  list_conversion<From, RodriguesParameters, T>(table);
  list_conversion<From, EulerAngles, T>(table);
  list_conversion<From, CardanAngles, T>(table);
}

/// table.add<Inputs...>(name, function) for each; function(const Inputs&...).
template <typename T, typename Table>
void list_operations(Table& table) {
  using Vector3 = Vector3T<T>;
  using Vector6 = Vector6T<T>;
  using Quaternion = Vector4T<T>;
  using DualQuaternion = Vector4T<Dual<T>>;
  using Matrix3 = Matrix3T<T>;
  using Pose = PoseT<T>;
  using Twist = TwistT<T>;

  list_conversions<DirectionCosines, T>(table);
  list_conversions<AxisAngle, T>(table);
  list_conversions<RotationVector, T>(table);
  list_conversions<EulerParameters, T>(table);
  list_conversions<RodriguesParameters, T>(table);
  list_conversions<EulerAngles, T>(table);
  list_conversions<CardanAngles, T>(table);
  list_conversion<DirectionCosines, YawPitchRoll, T>(table);
  list_conversion<YawPitchRoll, DirectionCosines, T>(table);

  table.template add<Matrix3, Matrix3>("matrix_product", [](const auto& a, const auto& b) -> Matrix3 { return a * b; });
  table.template add<Quaternion, Quaternion>("quaternion_product",
                                             [](const auto& a, const auto& b) { return quaternion_product<T>(a, b); });
  table.template add<DualQuaternion, DualQuaternion>(
      "dual_quaternion_product", [](const auto& a, const auto& b) { return quaternion_product<Dual<T>>(a, b); });
  table.template add<Pose, Pose>("pose_product", [](const auto& a, const auto& b) { return a * b; });

  table.template add<Matrix3>("matrix_inverse", [](const auto& r) -> Matrix3 { return r.transpose(); });
  table.template add<Quaternion>("quaternion_inverse", [](const auto& q) { return conjugate<T>(q); });
  table.template add<Pose>("pose_inverse", [](const auto& x) { return x.inverse(); });

  table.template add<Matrix3, Vector3>("matrix_times_vector",
                                       [](const auto& r, const auto& v) -> Vector3 { return r * v; });
  table.template add<Quaternion, Vector3>("quaternion_times_vector",
                                          [](const auto& q, const auto& v) { return rotated<T>(q, v); });
  table.template add<Pose, Vector3>("pose_times_point", [](const auto& x, const auto& p) { return x * p; });
  table.template add<Pose, Twist>("pose_times_twist", [](const auto& x, const auto& t) { return transformed(x, t); });
  table.template add<Pose>("pose_adjoint", [](const auto& x) { return adjoint<T>(x); });

  table.template add<Quaternion, Quaternion>(
      "quaternion_interpolation", [](const auto& a, const auto& b) { return interpolated<T>(a, b, T(0.25)).value; });
  table.template add<Matrix3, Matrix3>(
      "matrix_interpolation", [](const auto& a, const auto& b) { return interpolated<T>(a, b, T(0.25)).value; });

  table.template add<Pose, Pose>("pose_interpolation",
                                 [](const auto& a, const auto& b) { return interpolated<T>(a, b, T(0.25)).value; });
  table.template add<Pose>("pose_to_dual_quaternion", [](const auto& x) { return dual_quaternion_of_pose<T>(x); });
  table.template add<DualQuaternion>("dual_quaternion_to_pose",
                                     [](const auto& q) { return pose_of_dual_quaternion<T>(q); });

  // Exponential and logarithm of rotations are the conversions of rotation vectors.
  table.template add<Vector3>("left_jacobian", [](const auto& phi) { return left_jacobian<T>(phi); });
  table.template add<Vector3>("left_jacobian_inverse", [](const auto& phi) { return left_jacobian_inverse<T>(phi); });
  table.template add<Vector6>("pose_exp", [](const auto& x) { return pose_exp<T>(x); });
  table.template add<Pose>("pose_log", [](const auto& x) { return pose_log<T>(x); });
  table.template add<Vector6>("pose_left_jacobian", [](const auto& x) { return pose_left_jacobian<T>(x); });
  table.template add<Vector6>("pose_left_jacobian_inverse",
                              [](const auto& x) { return pose_left_jacobian_inverse<T>(x); });
}

}  // namespace koppel::bench
