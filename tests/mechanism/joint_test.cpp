// Joints of every kind, one by one: subspace, bias and what is carried over them agree with differences of the pose.
#include "mechanism/joint.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "../plugin/curve.hpp"
#include "../spatial/directions.hpp"
#include "built.hpp"
#include "spatial/rotation_vector.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

class EveryJoint : public testing::TestWithParam<JointCase> {
 protected:
  const Built built{single_joint(GetParam().text)};
  const Joint& joint = built->joints[0];
  const double accuracy = GetParam().accuracy;
  Random random{11};

  Pose pose_at(const Eigen::VectorXd& q) const {
    Pose pose;
    EXPECT_TRUE(joint.pose(q.data(), pose));
    return pose;
  }
  Eigen::VectorXd moved(const Eigen::VectorXd& q, const Eigen::VectorXd& rates, double time) const {
    Eigen::VectorXd out = q;
    integrate(*built, q, time * rates, out);
    return out;
  }
  Subspace subspace_at(const Eigen::VectorXd& q) const {
    Subspace s;
    EXPECT_TRUE(joint.subspace(q.data(), s));
    return s;
  }
  Pose random_frame() { return {random.rotation(), random.vector()}; }
  FrameMotion random_motion(const Vector3& at) {
    return {at, random.vector(), random.vector(), random.vector(), random.vector()};
  }
};

std::string case_name(const testing::TestParamInfo<JointCase>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Of, EveryJoint, testing::ValuesIn(all_joints()), case_name);

TEST_P(EveryJoint, StandsStillWhereItsCoordinatesAreNeutral) {
  const Pose pose = pose_at(State(*built).q);
  EXPECT_LE((pose.rotation - Matrix3::Identity()).norm(), 4 * eps);
  EXPECT_LE(pose.position.norm(), 4 * eps);
}

TEST_P(EveryJoint, SubspaceIsTheRateOfThePose) {
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::VectorXd q = random_position(*built, random);
    const Eigen::VectorXd v = random_rates(joint.nv, random);
    const Pose here = pose_at(q);
    const Vector6 twist = subspace_at(q) * v;
    const Vector6 expected = Vector6::NullaryExpr([&](Eigen::Index i) {
      return derivative([&](double t) {
        const Pose step = relative_pose(here, pose_at(moved(q, v, t)));
        return i < 3 ? rotation_vector_of_rotation<double>(step.rotation)[i] : step.position[i - 3];
      });
    });
    EXPECT_LE((twist - expected).cwiseAbs().maxCoeff(), 4 * accuracy);
  }
}

TEST_P(EveryJoint, BiasIsTheRateOfTheSubspace) {
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::VectorXd q = random_position(*built, random);
    const Eigen::VectorXd v = random_rates(joint.nv, random);
    Vector6 bias;
    ASSERT_TRUE(joint.bias(q.data(), v.data(), bias));
    if (GetParam().name == "pointing")
      continue;  // its tangent vectors turn along the way; kinematics are checked below
    const Vector6 expected = Vector6::NullaryExpr([&](Eigen::Index i) {
      return derivative([&](double t) -> double { return (subspace_at(moved(q, v, t)) * v)[i]; });
    });
    EXPECT_LE((bias - expected).cwiseAbs().maxCoeff(), 4 * accuracy);
  }
}

TEST_P(EveryJoint, WalkedForwardAndBackwardsEndsWhereItBegan) {
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::VectorXd q = random_position(*built, random);
    const Pose near = random_frame();
    std::array<Column, max_joint_rates> there, back;
    Pose far = near;
    ASSERT_TRUE(joint.step(q.data(), false, far, there.data()));
    Pose home = far;
    ASSERT_TRUE(joint.step(q.data(), true, home, back.data()));
    EXPECT_LE((home.rotation - near.rotation).norm(), 16 * eps);
    EXPECT_LE((home.position - near.position).norm(), 32 * eps);
    // What moves the far side against the near one moves the near side the other way.
    for (std::uint32_t i = 0; i < joint.nv; ++i) {
      EXPECT_LE((there[i].angular + back[i].angular).norm(), 1e-14);
      const Vector3 at = random.vector();
      const auto velocity = [&](const Column& c) { return Vector3(c.linear + c.angular.cross(at - c.point)); };
      EXPECT_LE((velocity(there[i]) + velocity(back[i])).norm(), 1e-14);
    }
  }
}

TEST_P(EveryJoint, MotionCarriedForwardAndBackwardsIsTheSame) {
  for (int trial = 0; trial < 10; ++trial) {
    const Eigen::VectorXd q = random_position(*built, random);
    const Eigen::VectorXd v = random_rates(joint.nv, random), a = random_rates(joint.nv, random);
    const Pose near = random_frame();
    std::array<Column, max_joint_rates> there, back;
    Pose far = near;
    ASSERT_TRUE(joint.step(q.data(), false, far, there.data()));
    Pose home = far;
    ASSERT_TRUE(joint.step(q.data(), true, home, back.data()));
    const FrameMotion before = random_motion(near.position);
    FrameMotion after = before;
    ASSERT_TRUE(joint.step_motion(q.data(), v.data(), a.data(), false, near, far, there.data(), after));
    ASSERT_TRUE(joint.step_motion(q.data(), v.data(), a.data(), true, far, home, back.data(), after));
    after.shift(before.at);
    EXPECT_LE((after.velocity - before.velocity).norm(), 1e-14);
    EXPECT_LE((after.angular_velocity - before.angular_velocity).norm(), 1e-14);
    EXPECT_LE((after.acceleration - before.acceleration).norm(), 1e-13);
    EXPECT_LE((after.angular_acceleration - before.angular_acceleration).norm(), 1e-13);
  }
}

TEST(Joint, TellsWhatIsFormedNumerically) {
  const auto parts = [](const std::string& text) { return Built(single_joint(text))->joints[0].numerical_parts(); };
  EXPECT_TRUE(parts("type = 'revolute'").empty());
  EXPECT_TRUE(parts("type = 'acme.varying_screw'\npitch = 1").empty());
  EXPECT_EQ(parts("type = 'acme.bare_screw'\npitch = 1"), (std::vector<std::string>{"subspace", "bias"}));
}

}  // namespace
}  // namespace koppel::test
