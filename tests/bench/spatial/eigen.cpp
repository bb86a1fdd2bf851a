// Eigen/Geometry. koppel's matrices are Eigen's, so there is nothing to compare in operations on them.
#include <Eigen/Geometry>
#include <unsupported/Eigen/MatrixFunctions>

#include "matrix_numbers.hpp"

namespace koppel::bench {

template <>
struct Numbers<Eigen::Quaterniond> {
  static constexpr std::size_t size = 4;
  static Eigen::Quaterniond read(const double* from) { return {from[0], from[1], from[2], from[3]}; }
  static void write(const Eigen::Quaterniond& q, double* to) {
    Eigen::Map<Vector4>{to} = Vector4(q.w(), q.x(), q.y(), q.z());
  }
};

template <>
struct Numbers<Eigen::AngleAxisd> {
  static constexpr std::size_t size = 4;
  static Eigen::AngleAxisd read(const double* from) { return {from[3], Vector3(from[0], from[1], from[2])}; }
  static void write(const Eigen::AngleAxisd& turn, double* to) { Eigen::Map<Vector4>{to} << turn.axis(), turn.angle(); }
};

template <>
struct Numbers<Eigen::Isometry3d> {
  static constexpr std::size_t size = 12;
  static Eigen::Isometry3d read(const double* from) {
    const Pose x = Numbers<Pose>::read(from);
    Eigen::Isometry3d isometry = Eigen::Isometry3d::Identity();
    isometry.linear() = x.rotation;
    isometry.translation() = x.position;
    return isometry;
  }
  static void write(const Eigen::Isometry3d& x, double* to) { Numbers<Pose>::write({x.linear(), x.translation()}, to); }
};

namespace {

using Eigen::AngleAxisd, Eigen::Isometry3d, Eigen::Quaterniond;

/// As Eigen's manual writes successive turns.
template <int i, int j, int k>
Quaterniond turns(const Vector3& angles) {
  return AngleAxisd(angles[0], Vector3::Unit(i)) * AngleAxisd(angles[1], Vector3::Unit(j)) *
         AngleAxisd(angles[2], Vector3::Unit(k));
}

template <int i, int j, int k>
void add_angles(Library& library, const std::string& name) {
  library.add<Matrix3>("matrix_to_" + name, [](const auto& r) -> Vector3 { return r.eulerAngles(i, j, k); });
  library.add<Vector3>(name + "_to_matrix",
                       [](const auto& x) -> Matrix3 { return turns<i, j, k>(x).toRotationMatrix(); });
  library.add<Vector3>(name + "_to_quaternion", [](const auto& x) { return turns<i, j, k>(x); });
}

/// Eigen has no rotation vectors; this is how they are commonly written with it.
AngleAxisd turn(const Vector3& phi) { return {phi.norm(), phi.normalized()}; }
Vector3 vector(const AngleAxisd& turn) { return turn.angle() * turn.axis(); }

}  // namespace

Library eigen_library() {
  Library library;
  library.add<Matrix3>("matrix_to_quaternion", [](const auto& r) { return Quaterniond(r); });
  library.add<Quaterniond>("quaternion_to_matrix", [](const auto& q) { return q.toRotationMatrix(); });
  library.add<Matrix3>("matrix_to_axis_angle", [](const auto& r) { return AngleAxisd(r); });
  library.add<AngleAxisd>("axis_angle_to_matrix", [](const auto& x) { return x.toRotationMatrix(); });
  library.add<Quaterniond>("quaternion_to_axis_angle", [](const auto& q) { return AngleAxisd(q); });
  library.add<AngleAxisd>("axis_angle_to_quaternion", [](const auto& x) { return Quaterniond(x); });
  library.add<Matrix3>("matrix_to_rotation_vector", [](const auto& r) { return vector(AngleAxisd(r)); });
  library.add<Vector3>("rotation_vector_to_matrix", [](const auto& phi) { return turn(phi).toRotationMatrix(); });
  library.add<Quaterniond>("quaternion_to_rotation_vector", [](const auto& q) { return vector(AngleAxisd(q)); });
  library.add<Vector3>("rotation_vector_to_quaternion", [](const auto& phi) { return Quaterniond(turn(phi)); });
  add_angles<2, 0, 2>(library, "euler_zxz");
  add_angles<0, 1, 2>(library, "cardan_xyz");
  add_angles<2, 1, 0>(library, "yaw_pitch_roll");

  library.add<Quaterniond, Quaterniond>("quaternion_product", [](const auto& a, const auto& b) { return a * b; });
  library.add<Isometry3d, Isometry3d>("pose_product", [](const auto& a, const auto& b) { return a * b; });
  library.add<Quaterniond>("quaternion_inverse", [](const auto& q) { return q.conjugate(); });
  library.add<Isometry3d>("pose_inverse", [](const auto& x) { return x.inverse(); });
  library.add<Quaterniond, Vector3>("quaternion_times_vector",
                                    [](const auto& q, const auto& v) -> Vector3 { return q * v; });
  library.add<Isometry3d, Vector3>("pose_times_point", [](const auto& x, const auto& p) -> Vector3 { return x * p; });
  library.add<Quaterniond, Quaterniond>("quaternion_interpolation",
                                        [](const auto& a, const auto& b) { return a.slerp(0.25, b); });

  // The exponential of any matrix, which knows nothing of rotations.
  library.add<Vector6>("pose_exp", [](const auto& x) {
    Eigen::Matrix4d m = Eigen::Matrix4d::Zero();
    m.topLeftCorner<3, 3>() = skew(x.template head<3>());
    m.topRightCorner<3, 1>() = x.template tail<3>();
    return Isometry3d(Eigen::Matrix4d(m.exp()));
  });
  return library;
}

}  // namespace koppel::bench
