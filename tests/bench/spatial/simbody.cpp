// Simbody's Rotation, Quaternion, Transform.
#include <SimTKcommon/Orientation.h>
#include <SimTKcommon/internal/SpatialAlgebra.h>

#include "batch.hpp"

namespace koppel::bench {

template <int n>
struct Numbers<SimTK::Vec<n>> {
  static constexpr std::size_t size = n;
  static SimTK::Vec<n> read(const double* from) { return SimTK::Vec<n>::getAs(from); }
  static void write(const SimTK::Vec<n>& v, double* to) { SimTK::Vec<n>::updAs(to) = v; }
};

template <>
struct Numbers<SimTK::Rotation> {
  static constexpr std::size_t size = 9;
  static SimTK::Rotation read(const double* from) {
    SimTK::Mat33 m;
    for (int i = 0; i < 9; ++i) m(i % 3, i / 3) = from[i];
    return {m, true};  // trusted to be a rotation
  }
  static void write(const SimTK::Rotation& r, double* to) {
    for (int i = 0; i < 9; ++i) to[i] = r.asMat33()(i % 3, i / 3);
  }
};

template <>
struct Numbers<SimTK::Quaternion> {
  static constexpr std::size_t size = 4;
  static SimTK::Quaternion read(const double* from) { return {SimTK::Vec4::getAs(from), true}; }
  static void write(const SimTK::Quaternion& q, double* to) { Numbers<SimTK::Vec4>::write(q.asVec4(), to); }
};

template <>
struct Numbers<SimTK::Transform> {
  static constexpr std::size_t size = 12;
  static SimTK::Transform read(const double* from) {
    return {Numbers<SimTK::Rotation>::read(from), SimTK::Vec3::getAs(from + 9)};
  }
  static void write(const SimTK::Transform& x, double* to) {
    Numbers<SimTK::Rotation>::write(x.R(), to);
    Numbers<SimTK::Vec3>::write(x.p(), to + 9);
  }
};

template <>
struct Numbers<SimTK::SpatialVec> {
  static constexpr std::size_t size = 6;
  static SimTK::SpatialVec read(const double* from) { return {SimTK::Vec3::getAs(from), SimTK::Vec3::getAs(from + 3)}; }
  static void write(const SimTK::SpatialVec& t, double* to) {
    Numbers<SimTK::Vec3>::write(t[0], to);
    Numbers<SimTK::Vec3>::write(t[1], to + 3);
  }
};

namespace {

struct Turn {
  SimTK::UnitVec3 axis;
  double angle = 0;
};

}  // namespace

template <>
struct Numbers<Turn> {
  static constexpr std::size_t size = 4;
  static Turn read(const double* from) { return {SimTK::UnitVec3(SimTK::Vec3::getAs(from), true), from[3]}; }
  static void write(const Turn& turn, double* to) {
    Numbers<SimTK::Vec3>::write(turn.axis.asVec3(), to);
    to[3] = turn.angle;
  }
};

namespace {

/// Simbody packs angle and axis together, the angle first.
Turn unpacked(const SimTK::Vec4& x) { return {SimTK::UnitVec3(x.getSubVec<3>(1), true), x[0]}; }

template <int i, int j, int k>
void add_angles(Library& library, const std::string& name) {
  using SimTK::BodyRotationSequence, SimTK::CoordinateAxis, SimTK::Rotation, SimTK::Vec3;
  library.add<Rotation>("matrix_to_" + name, [](const auto& r) -> Vec3 {
    return r.convertThreeAxesRotationToThreeAngles(BodyRotationSequence, CoordinateAxis(i), CoordinateAxis(j),
                                                   CoordinateAxis(k));
  });
  library.add<Vec3>(name + "_to_matrix", [](const auto& x) {
    return Rotation(BodyRotationSequence, x[0], CoordinateAxis(i), x[1], CoordinateAxis(j), x[2], CoordinateAxis(k));
  });
}

}  // namespace

Library simbody_library() {
  using SimTK::Quaternion, SimTK::Rotation, SimTK::SpatialVec, SimTK::Transform, SimTK::Vec3;
  Library library;
  library.add<Rotation>("matrix_to_quaternion", [](const auto& r) { return r.convertRotationToQuaternion(); });
  library.add<Quaternion>("quaternion_to_matrix", [](const auto& q) { return Rotation(q); });
  library.add<Rotation>("matrix_to_axis_angle", [](const auto& r) { return unpacked(r.convertRotationToAngleAxis()); });
  library.add<Turn>("axis_angle_to_matrix", [](const auto& x) { return Rotation(x.angle, x.axis); });
  library.add<Quaternion>("quaternion_to_axis_angle",
                          [](const auto& q) { return unpacked(q.convertQuaternionToAngleAxis()); });
  library.add<Turn>("axis_angle_to_quaternion", [](const auto& x) {
    Quaternion q;
    q.setQuaternionFromAngleAxis(x.angle, x.axis);
    return q;
  });
  add_angles<2, 0, 2>(library, "euler_zxz");
  add_angles<0, 1, 2>(library, "cardan_xyz");
  add_angles<2, 1, 0>(library, "yaw_pitch_roll");

  library.add<Rotation, Rotation>("matrix_product", [](const auto& a, const auto& b) { return a * b; });
  library.add<Transform, Transform>("pose_product", [](const auto& a, const auto& b) { return a * b; });
  library.add<Rotation>("matrix_inverse", [](const auto& r) { return Rotation(~r); });
  library.add<Transform>("pose_inverse", [](const auto& x) { return Transform(~x); });
  library.add<Rotation, Vec3>("matrix_times_vector", [](const auto& r, const auto& v) -> Vec3 { return r * v; });
  library.add<Transform, Vec3>("pose_times_point", [](const auto& x, const auto& p) -> Vec3 { return x * p; });
  library.add<Transform, SpatialVec>("pose_times_twist", [](const auto& x, const auto& t) -> SpatialVec {
    return SimTK::shiftVelocityBy(SpatialVec(x.R() * t[0], x.R() * t[1]), -x.p());
  });
  return library;
}

}  // namespace koppel::bench
