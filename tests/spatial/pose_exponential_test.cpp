// The exponential of poses: its logarithm, its derivatives, and what a constant twist does.
#include "spatial/pose_exponential.hpp"

#include <array>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "directions.hpp"
#include "spatial/twist.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;
constexpr std::array<double, 11> angles{0.0, 1e-300, 1e-160, 1e-16, 1e-8, 1e-4, 1.0, 2.0, pi - 1e-8, pi - 1e-15, 2.5};

template <typename Check>
void for_all_displacements(const Check& check) {
  Random random(1);
  for (const double angle : angles) {
    for (const double length : {0.0, 1e-160, 1.0, 1e6}) {
      for (int n = 0; n < 10; ++n) {
        check(Vector6((Vector6() << angle * random.direction(), length * random.direction()).finished()));
      }
    }
  }
}

double apart(const Pose& a, const Pose& b, double length) {
  return std::max((a.rotation - b.rotation).cwiseAbs().maxCoeff(),
                  (a.position - b.position).cwiseAbs().maxCoeff() / (length > 0 ? length : 1));
}

// Checks K-I-3.3.1.
TEST(PoseExponential, ReturnsByItsLogarithm) {
  for_all_displacements([](const Vector6& x) {
    const Vector6 back = pose_log<double>(pose_exp<double>(x));
    const double length = x.tail<3>().norm();
    EXPECT_LE((back.head<3>() - x.head<3>()).stableNorm(), 8 * eps * x.head<3>().stableNorm());
    // J_l^-1 is at most pi/2, and is moved by what the rotation vector lost.
    EXPECT_LE((back.tail<3>() - x.tail<3>()).stableNorm(), 32 * eps * x.tail<3>().stableNorm() + 8 * eps * length);
  });
}

TEST(PoseExponential, ComposesAlongOneTwist) {
  for_all_displacements([](const Vector6& x) {
    const Pose whole = pose_exp<double>(x), parts = pose_exp<double>(0.3 * x) * pose_exp<double>(0.7 * x);
    EXPECT_LE(apart(whole, parts, x.tail<3>().norm()), 16 * eps);
    EXPECT_LE(apart(pose_exp<double>(-x), whole.inverse(), x.tail<3>().norm()), 16 * eps);
  });
}

/// d/ds exp(x + s d) by dual numbers, as twist: in the base's axes at its origin, and in the body's at its own.
struct Moving {
  Moving(const Vector6& x, const Vector6& d) {
    const PoseT<Dual<double>> pose = pose_exp<Dual<double>>(dual(x, d));
    const Matrix3 r = real_part(pose.rotation), rate = dual_part(pose.rotation);
    const Vector3 p = real_part(pose.position), velocity = dual_part(pose.position);
    const Vector3 omega = axial(rate * r.transpose());
    base << omega, velocity - omega.cross(p);
    body << r.transpose() * omega, r.transpose() * velocity;
  }
  Vector6 base, body;
};

// Checks K-I-6.3.
// The Jacobians of rotations, evaluated on dual vectors, are those of poses.
TEST(PoseExponential, MovesAsItsJacobiansSay) {
  Random random(2);
  for_all_displacements([&](const Vector6& x) {
    const Vector6 d = (Vector6() << random.vector(), random.vector()).finished();
    const Moving moving(x, d);
    const double scale = 1 + x.tail<3>().norm();
    EXPECT_LE((pose_left_jacobian<double>(x) * d - moving.base).norm(), 64 * eps * scale);
    EXPECT_LE((pose_right_jacobian<double>(x) * d - moving.body).norm(), 64 * eps * scale);
    EXPECT_LE((pose_left_jacobian_inverse<double>(x) * pose_left_jacobian<double>(x) - Matrix6::Identity())
                  .cwiseAbs()
                  .maxCoeff(),
              32 * eps * scale);
    EXPECT_LE((pose_right_jacobian_inverse<double>(x) * pose_right_jacobian<double>(x) - Matrix6::Identity())
                  .cwiseAbs()
                  .maxCoeff(),
              32 * eps * scale);
    // Both say the same: the adjoint leads from one to the other.
    EXPECT_LE((adjoint(pose_exp<double>(x)) * pose_right_jacobian<double>(x) - pose_left_jacobian<double>(x))
                  .cwiseAbs()
                  .maxCoeff(),
              64 * eps * scale);
  });
}

TEST(PoseExponential, OfAPureTranslationIsIt) {
  const Vector6 x = (Vector6() << 0, 0, 0, 1, -2, 3).finished();
  EXPECT_EQ(pose_exp<double>(x).position, Vector3(1, -2, 3));
  EXPECT_EQ(pose_exp<double>(x).rotation, Matrix3::Identity());
  EXPECT_EQ(pose_log<double>(Pose{Matrix3::Identity(), {1, -2, 3}}), x);
}

// A quarter turn with a pitch: the constant twist about z at the distance 1, advancing by 2 m/rad.
TEST(PoseExponential, OfAScrewIsAHelix) {
  const double angle = pi / 2;
  const Vector3 omega = Vector3::UnitZ(), on_axis(1, 0, 0);
  const Vector3 v = 2 * omega - omega.cross(on_axis);
  const Pose pose = pose_exp<double>(angle * (Vector6() << omega, v).finished());
  EXPECT_LE((pose.position - Vector3(1, -1, pi)).norm(), 8 * eps);
  EXPECT_LE((pose * on_axis - on_axis - Vector3(0, 0, pi)).norm(), 8 * eps);
}

}  // namespace
}  // namespace koppel::test
