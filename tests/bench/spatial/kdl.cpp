// Orocos KDL. Its Euler angles ZYX are yaw, pitch and roll; it has no other sequence of these tables.
#include <kdl/frames.hpp>
#include <kdl/rotational_interpolation_sa.hpp>

#include "batch.hpp"

namespace koppel::bench {

template <>
struct Numbers<KDL::Vector> {
  static constexpr std::size_t size = 3;
  static KDL::Vector read(const double* from) { return {from[0], from[1], from[2]}; }
  static void write(const KDL::Vector& v, double* to) {
    for (int i = 0; i < 3; ++i) to[i] = v(i);
  }
};

template <>
struct Numbers<KDL::Rotation> {
  static constexpr std::size_t size = 9;
  static KDL::Rotation read(const double* from) {
    using Vectors = Numbers<KDL::Vector>;
    return {Vectors::read(from), Vectors::read(from + 3), Vectors::read(from + 6)};
  }
  static void write(const KDL::Rotation& r, double* to) {
    for (int i = 0; i < 9; ++i) to[i] = r(i % 3, i / 3);
  }
};

template <>
struct Numbers<KDL::Frame> {
  static constexpr std::size_t size = 12;
  static KDL::Frame read(const double* from) {
    return {Numbers<KDL::Rotation>::read(from), Numbers<KDL::Vector>::read(from + 9)};
  }
  static void write(const KDL::Frame& x, double* to) {
    Numbers<KDL::Rotation>::write(x.M, to);
    Numbers<KDL::Vector>::write(x.p, to + 9);
  }
};

template <>
struct Numbers<KDL::Twist> {
  static constexpr std::size_t size = 6;
  static KDL::Twist read(const double* from) {
    return {Numbers<KDL::Vector>::read(from + 3), Numbers<KDL::Vector>::read(from)};
  }
  static void write(const KDL::Twist& t, double* to) {
    Numbers<KDL::Vector>::write(t.rot, to);
    Numbers<KDL::Vector>::write(t.vel, to + 3);
  }
};

namespace {

/// Unit axis and angle, which KDL has no type for.
struct Turn {
  KDL::Vector axis;
  double angle = 0;
};

}  // namespace

template <>
struct Numbers<Turn> {
  static constexpr std::size_t size = 4;
  static Turn read(const double* from) { return {Numbers<KDL::Vector>::read(from), from[3]}; }
  static void write(const Turn& turn, double* to) {
    Numbers<KDL::Vector>::write(turn.axis, to);
    to[3] = turn.angle;
  }
};

Library kdl_library() {
  using KDL::Frame, KDL::Rotation, KDL::Twist, KDL::Vector;
  using Quaternion = std::array<double, 4>;
  using Angles = std::array<double, 3>;
  Library library;
  library.add<Rotation>("matrix_to_quaternion", [](const auto& r) {
    Quaternion q;
    r.GetQuaternion(q[1], q[2], q[3], q[0]);
    return q;
  });
  library.add<Quaternion>("quaternion_to_matrix",
                          [](const auto& q) { return Rotation::Quaternion(q[1], q[2], q[3], q[0]); });
  library.add<Rotation>("matrix_to_axis_angle", [](const auto& r) {
    Turn turn;
    turn.angle = r.GetRotAngle(turn.axis);
    return turn;
  });
  library.add<Turn>("axis_angle_to_matrix", [](const auto& x) { return Rotation::Rot2(x.axis, x.angle); });
  library.add<Rotation>("matrix_to_rotation_vector", [](const auto& r) { return r.GetRot(); });
  library.add<Vector>("rotation_vector_to_matrix", [](const auto& phi) { return KDL::Rot(phi); });
  library.add<Rotation>("matrix_to_yaw_pitch_roll", [](const auto& r) {
    Angles x;
    r.GetEulerZYX(x[0], x[1], x[2]);
    return x;
  });
  library.add<Angles>("yaw_pitch_roll_to_matrix", [](const auto& x) { return Rotation::EulerZYX(x[0], x[1], x[2]); });

  library.add<Rotation, Rotation>("matrix_product", [](const auto& a, const auto& b) { return a * b; });
  library.add<Frame, Frame>("pose_product", [](const auto& a, const auto& b) { return a * b; });
  library.add<Rotation>("matrix_inverse", [](const auto& r) { return r.Inverse(); });
  library.add<Frame>("pose_inverse", [](const auto& x) { return x.Inverse(); });
  library.add<Rotation, Vector>("matrix_times_vector", [](const auto& r, const auto& v) { return r * v; });
  library.add<Frame, Vector>("pose_times_point", [](const auto& x, const auto& p) { return x * p; });
  library.add<Frame, Twist>("pose_times_twist", [](const auto& x, const auto& t) { return x * t; });
  library.add<Rotation, Rotation>("matrix_interpolation", [](const auto& a, const auto& b) {
    KDL::RotationalInterpolation_SingleAxis between;
    between.SetStartEnd(a, b);
    return between.Pos(0.25 * between.Angle());
  });
  return library;
}

}  // namespace koppel::bench
