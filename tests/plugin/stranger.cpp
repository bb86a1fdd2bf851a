// A stranger's screw of varying pitch: its callbacks agree with each other and with the motion that it promises.
#include <cmath>
#include <limits>
#include <random>

#include "curve.hpp"
#include "fixtures.hpp"

namespace koppel::test {
namespace {

constexpr double pitch = 0.2, growth = 0.01;  // s' = pitch + 2 growth angle: positive above -10 rad

class VaryingScrew : public testing::Test {
 protected:
  Registry registry{with_strangers()};
  const JointType* type = expect_value(registry.joint("acme.varying_screw", {}));
  const Instance instance = expect_value(create(*type, {{"pitch", {pitch}}, {"growth", {growth}}}));
  const void* pointer = instance.get();

  PoseNumbers pose_numbers(double angle) const {
    PoseNumbers out{};
    EXPECT_EQ(type->calls.pose(1, &pointer, &angle, out.data()), KOPPEL_OK);
    return out;
  }
  Pose pose(double angle) const {
    const PoseNumbers n = pose_numbers(angle);
    Pose out;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) out.rotation(i, j) = n[static_cast<std::size_t>(3 * i + j)];
      out.position[i] = n[static_cast<std::size_t>(9 + i)];
    }
    return out;
  }
  Vector6 subspace(double angle) const {
    Vector6 s;
    EXPECT_EQ(type->calls.subspace(1, &pointer, &angle, s.data()), KOPPEL_OK);
    return s;
  }
  using Residual = Eigen::Matrix<double, 5, 1>;
  using Jacobian = Eigen::Matrix<double, 5, 6, Eigen::RowMajor>;
  std::pair<Residual, Jacobian> implicit(const Pose& at) const {
    const PoseNumbers n = numbers_of(at);
    std::pair<Residual, Jacobian> out;
    EXPECT_EQ(type->calls.implicit(1, &pointer, n.data(), out.first.data(), out.second.data()), KOPPEL_OK);
    return out;
  }
};

TEST_F(VaryingScrew, IsNoProductOfElementaryMotions) {
  EXPECT_FALSE(type->is_product());
  EXPECT_EQ(type->rows.size(), 5u);
}

TEST_F(VaryingScrew, AdvancesMoreAndMore) {
  EXPECT_NEAR(pose(2).position.z(), pitch * 2 + growth * 4, 1e-16);
  EXPECT_TRUE(pose(0).rotation.isIdentity(0));
}

// Steps of 0.01 on functions of scale 1: truncation below 1e-14, rounding below 1e-13.
TEST_F(VaryingScrew, SubspaceIsTheRateOfThePose) {
  for (double angle = -4; angle < 7; angle += 0.7) {
    const Pose now = pose(angle);
    Vector6 twist;
    const auto entry = [&](int i, int j) {
      return derivative([&](double t) { return (now.rotation.transpose() * pose(angle + t).rotation)(i, j); });
    };
    twist << entry(2, 1), entry(0, 2), entry(1, 0),
        derivative([&](double t) { return now.rotation.col(0).dot(pose(angle + t).position); }),
        derivative([&](double t) { return now.rotation.col(1).dot(pose(angle + t).position); }),
        derivative([&](double t) { return now.rotation.col(2).dot(pose(angle + t).position); });
    EXPECT_LE((subspace(angle) - twist).cwiseAbs().maxCoeff(), 1e-12) << "at " << angle;
  }
}

TEST_F(VaryingScrew, BiasIsTheRateOfTheSubspace) {
  const double angle = 0.3, u = 2, w = -3;
  Vector6 bias;
  ASSERT_EQ(type->calls.bias(1, &pointer, &angle, &u, &w, bias.data()), KOPPEL_OK);
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(bias[i], derivative([&](double t) { return (subspace(angle + u * t) * w)[i]; }), 1e-12);
  }
}

TEST_F(VaryingScrew, ResidualsVanishOnItsMotionAndOnlyThere) {
  for (double angle = -6; angle < 20; angle += 0.9) {
    EXPECT_LE(implicit(pose(angle)).first.cwiseAbs().maxCoeff(), 1e-13) << "at " << angle;
  }
  const double pi = std::acos(-1.0);
  const Pose turned = pose(0.5) * Pose{rotation_about<double>(Vector3::UnitZ(), pi), Vector3::Zero()};
  EXPECT_NEAR(std::abs(implicit(turned).first[4]), pi, 1e-12);
  const Pose upside_down{rotation_about<double>(Vector3::UnitX(), pi), Vector3::Zero()};
  EXPECT_NEAR(implicit(upside_down).first.segment<2>(2).norm(), pi, 1e-12);
}

// The same bound as above; the tilted poses are up to 1.7 rad off, where the residuals are still smooth over 1 rad.
TEST_F(VaryingScrew, JacobianIsTheRateOfTheResiduals) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return Vector3(uniform(random), uniform(random), uniform(random)); };
  for (int trial = 0; trial < 100; ++trial) {
    const double off = trial % 4 == 0 ? 0.0 : 0.8;  // on the motion, and away from it
    const Pose at = pose(2 * uniform(random)) *
                    Pose{rotation_about<double>(vector().normalized(), off * uniform(random)), 0.1 * off * vector()};
    Vector6 twist;
    twist << 0.5 * vector(), 0.05 * vector();
    const Residual expected = Residual::NullaryExpr([&](Eigen::Index i) {
      return derivative([&](double t) { return implicit(along_twist(at, twist, t)).first[i]; });
    });
    EXPECT_LE((implicit(at).second * twist - expected).cwiseAbs().maxCoeff(), 1e-10) << "trial " << trial;
  }
}

TEST_F(VaryingScrew, TellsItsAngleOverManyTurns) {
  for (double angle = -8; angle < 40; angle += 1.3) {
    const PoseNumbers at = pose_numbers(angle);
    double q = 0;
    ASSERT_EQ(type->calls.coordinates_of(1, &pointer, at.data(), &q), KOPPEL_OK);
    EXPECT_NEAR(q, angle, 64 * std::numeric_limits<double>::epsilon() * 40);
  }
}

TEST_F(VaryingScrew, RefusesToStandStill) {
  const auto refused = create(*type, {{"pitch", {0}}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::instance_refused);
  expect_mentions(refused.error(), {"acme.varying_screw", "pitch", "must not be zero", "use a hinge"});
}

TEST_F(VaryingScrew, BareFormOffersThePoseAlone) {
  const JointType* bare = expect_value(registry.joint("acme.bare_screw", {}));
  EXPECT_NE(bare->calls.pose, nullptr);
  EXPECT_EQ(bare->calls.subspace, nullptr);
  EXPECT_EQ(bare->calls.bias, nullptr);
  EXPECT_EQ(bare->calls.implicit, nullptr);
  EXPECT_TRUE(bare->rows.empty());
}

}  // namespace
}  // namespace koppel::test
