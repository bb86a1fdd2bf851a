// Forward kinematics of random trees: velocities, accelerations and Jacobians agree with differences of positions.
#include "mechanism/kinematics.hpp"

#include <gtest/gtest.h>

#include "../plugin/curve.hpp"
#include "spatial/rotation_vector.hpp"
#include "tree.hpp"

namespace koppel::test {
namespace {

// Rates are 1/n rad/s for n joints, so that everything changes over about a second; positions are up to some metres.
// Steps of 0.01 s: first differences are good to 1e-12, second ones lose another factor of 100 and more.
constexpr double first_accuracy = 1e-10;  // what core forms numerically is no better
constexpr double second_accuracy = 5e-9;

class Tree : public testing::TestWithParam<int> {
 protected:
  const int count = GetParam();
  const Built built{random_tree(static_cast<std::size_t>(count), static_cast<unsigned>(count))};
  const Mechanism& mechanism = *built;
  Random random{static_cast<unsigned>(100 + count)};
  const Eigen::VectorXd q = random_position(mechanism, random);
  const Eigen::VectorXd v = random_rates(mechanism.nv, random) / count;
  const Eigen::VectorXd a = random_rates(mechanism.nv, random) / count;
  Kinematics here{mechanism};
  Kinematics elsewhere{mechanism};

  void SetUp() override {
    ASSERT_TRUE(forward_position(mechanism, q.data(), here));
    ASSERT_TRUE(forward_motion(mechanism, q.data(), v.data(), a.data(), here));
  }
  /// Positions on the way that has the rates v and the accelerations a at time 0.
  const Kinematics& at(double t) {
    Eigen::VectorXd moved = q;
    integrate(mechanism, q, t * v + t * t / 2 * a, moved);
    EXPECT_TRUE(forward_position(mechanism, moved.data(), elsewhere));
    return elsewhere;
  }
  /// Frame b in frame a at time t; ground is node 0.
  Pose relative_at(double t, Node a_node, Node b_node) {
    return relative_pose(at(t).poses[a_node], elsewhere.poses[b_node]);
  }

  template <typename Difference>
  Vector3 turning(const Difference& difference, Node a_node, Node b_node) {
    const Matrix3 now = relative_pose(here.poses[a_node], here.poses[b_node]).rotation;
    return Vector3::NullaryExpr([&](Eigen::Index i) {
      return difference([&](double t) {
        return rotation_vector_of_rotation<double>(now.transpose() * relative_at(t, a_node, b_node).rotation)[i];
      });
    });
  }
  template <typename Difference>
  Vector3 sliding(const Difference& difference, Node a_node, Node b_node) {
    return Vector3::NullaryExpr([&](Eigen::Index i) {
      return difference([&](double t) { return relative_at(t, a_node, b_node).position[i]; });
    });
  }
};

INSTANTIATE_TEST_SUITE_P(OfJoints, Tree, testing::Range(1, 21));

constexpr auto first = [](const auto& f) { return derivative(f); };
constexpr auto second = [](const auto& f) { return second_derivative(f); };

TEST_P(Tree, VelocitiesAreTheRatesOfPositions) {
  for (Node node = 1; node < mechanism.nodes; ++node) {
    const FrameMotion& motion = here.motions[node];
    EXPECT_LE((motion.velocity - sliding(first, 0, node)).norm(), first_accuracy);
    EXPECT_LE((motion.angular_velocity - here.poses[node].rotation * turning(first, 0, node)).norm(), first_accuracy);
  }
}

TEST_P(Tree, AccelerationsAreTheRatesOfVelocities) {
  for (Node node = 1; node < mechanism.nodes; ++node) {
    const FrameMotion& motion = here.motions[node];
    EXPECT_LE((motion.acceleration - sliding(second, 0, node)).norm(), second_accuracy);
    EXPECT_LE((motion.angular_acceleration - here.poses[node].rotation * turning(second, 0, node)).norm(),
              second_accuracy);
  }
}

TEST_P(Tree, RelativeMotionIsThatOfTheRelativePose) {
  const Node b = mechanism.nodes - 1, other = mechanism.nodes / 2;
  const RelativeTwist motion = relative_twist(here.poses[other], here.motions[other], here.poses[b], here.motions[b]);
  const Matrix3 to_b = relative_pose(here.poses[other], here.poses[b]).rotation.transpose();
  const Vector3 turn = turning(first, other, b), slide = to_b * sliding(first, other, b);
  EXPECT_LE((motion.twist.head<3>() - turn).norm(), first_accuracy);
  EXPECT_LE((motion.twist.tail<3>() - slide).norm(), first_accuracy);
  EXPECT_LE((motion.rate.head<3>() - turning(second, other, b)).norm(), second_accuracy);
  EXPECT_LE((motion.rate.tail<3>() - (to_b * sliding(second, other, b) - turn.cross(slide))).norm(), second_accuracy);
}

TEST_P(Tree, JacobianTimesRatesIsTheVelocity) {
  const Node node = mechanism.nodes - 1;
  const Vector3 point(0.3, -0.2, 0.5);
  Jacobian jacobian, rate;
  frame_jacobian(mechanism, here, node, point, jacobian);
  ASSERT_TRUE(frame_jacobian_rate(mechanism, q.data(), v.data(), here, node, point, rate));
  const FrameMotion motion = motion_of(here, node, point);
  Vector6 velocity, acceleration;
  velocity << motion.angular_velocity, motion.velocity;
  acceleration << motion.angular_acceleration, motion.acceleration;
  EXPECT_LE((jacobian * v - velocity).norm(), 1e-13);
  EXPECT_LE((jacobian * a + rate * v - acceleration).norm(), first_accuracy);
}

TEST_P(Tree, JacobianRateIsTheRateOfTheJacobian) {
  const Node node = mechanism.nodes - 1;
  const Vector3 point(0.3, -0.2, 0.5);
  Jacobian rate, there;
  ASSERT_TRUE(frame_jacobian_rate(mechanism, q.data(), v.data(), here, node, point, rate));
  for (Eigen::Index i = 0; i < rate.rows(); ++i) {
    for (Eigen::Index j = 0; j < rate.cols(); ++j) {
      const double expected = derivative([&](double t) {
        frame_jacobian(mechanism, at(t), node, point, there);
        return there(i, j);
      });
      EXPECT_NEAR(rate(i, j), expected, first_accuracy) << i << ", " << j;
    }
  }
}

// The same tree with all its roots on a body that is welded to the ground a thousand kilometres away.
TEST(FarAway, MotionIsTheSame) {
  const std::string text = random_tree(12, 5);
  const std::string moved = replaced(text, "on = 'ground'", "on = 'base'") +
                            "[[body]]\nname = 'base'\n[[joint]]\nname = 'base'\ntype = 'weld'\n"
                            "inlet = { on = 'ground', at = [1e6, -1e6, 5e5] }\noutlet = 'base'\n";
  const Built home(text), far(moved);
  Random random(6);
  const Eigen::VectorXd q = random_position(*home, random), v = random_rates(home->nv, random);
  Kinematics a(*home), b(*far);
  ASSERT_TRUE(forward_position(*home, q.data(), a));
  ASSERT_TRUE(forward_position(*far, q.data(), b));
  ASSERT_TRUE(forward_motion(*home, q.data(), v.data(), v.data(), a));
  ASSERT_TRUE(forward_motion(*far, q.data(), v.data(), v.data(), b));
  constexpr double rounding = 1e6 * 2.3e-16 * 12 * 4;  // of positions, at every joint on the way
  for (Node node = 1; node < home->nodes; ++node) {
    EXPECT_LE((b.poses[node].position - a.poses[node].position - Vector3(1e6, -1e6, 5e5)).norm(), rounding);
    EXPECT_LE((b.motions[node].angular_velocity - a.motions[node].angular_velocity).norm(), 1e-13);
    EXPECT_LE((b.motions[node].velocity - a.motions[node].velocity).norm(), 20 * rounding);
    EXPECT_LE((b.motions[node].acceleration - a.motions[node].acceleration).norm(), 200 * rounding);
  }
}

}  // namespace
}  // namespace koppel::test
