// Faces: equations of a relative pose that vanish on the joint's motion and nowhere else.
#include "mechanism/face.hpp"

#include <limits>
#include <numbers>

#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "../plugin/curve.hpp"
#include "../spatial/directions.hpp"
#include "built.hpp"
#include "spatial/rotation_vector.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;
using Rows = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

bool without_face(const JointCase& joint) {
  const std::string& n = joint.name;
  return n == "helical" || n == "bare_screw" || n == "parallel" || n == "beside" || n == "slide" || n == "pointing";
}

std::vector<JointCase> joints(bool with_face) {
  std::vector<JointCase> out;
  for (const JointCase& joint : all_joints()) {
    if (without_face(joint) != with_face) out.push_back(joint);
  }
  return out;
}

struct Evaluated {
  Eigen::VectorXd residual;
  Rows jacobian;
};

class JointWithFace : public testing::TestWithParam<JointCase> {
 protected:
  const Built built{single_joint(GetParam().text)};
  const Joint& joint = built->joints[0];
  const Face face = Face::of(joint).value();
  Random random{21};

  Evaluated evaluate(const Pose& pose) const {
    const auto n = static_cast<Eigen::Index>(face.rows().size());
    Evaluated out{Eigen::VectorXd(n), Rows(n, 6)};
    EXPECT_TRUE(face.evaluate(joint, pose, out.residual.data(), out.jacobian.data()));
    return out;
  }
  double residual_at(const Pose& pose) const {
    const Eigen::VectorXd r = evaluate(pose).residual;
    return r.size() == 0 ? 0.0 : r.lpNorm<Eigen::Infinity>();
  }
  Pose pose_at(const Eigen::VectorXd& q) const {
    Pose pose;
    EXPECT_TRUE(joint.pose(q.data(), pose));
    return pose;
  }
  /// Greatest difference of the Jacobian from the rates of the residuals along random twists.
  double jacobian_error(const Pose& at, double step) {
    Vector6 twist;
    twist << 0.5 * random.vector(), 0.5 * random.vector();
    const Evaluated here = evaluate(at);
    double worst = 0;
    for (Eigen::Index i = 0; i < here.residual.size(); ++i) {
      const double expected =
          derivative([&](double t) { return evaluate(along_twist(at, twist, t)).residual[i]; }, step);
      worst = std::max(worst, std::abs(here.jacobian.row(i).dot(twist) - expected));
    }
    return worst;
  }
};

std::string case_name(const testing::TestParamInfo<JointCase>& info) { return info.param.name; }
INSTANTIATE_TEST_SUITE_P(Of, JointWithFace, testing::ValuesIn(joints(true)), case_name);

TEST_P(JointWithFace, HasOneEquationForEachFreedomThatItTakes) { EXPECT_EQ(face.rows().size(), 6 - joint.nv); }

TEST_P(JointWithFace, ResidualVanishesOnItsMotion) {
  for (int trial = 0; trial < 50; ++trial) EXPECT_LE(residual_at(pose_at(random_position(*built, random))), 32 * eps);
}

TEST_P(JointWithFace, JacobianOnItsMotionHasFullRankAndIgnoresTheMotion) {
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::VectorXd q = random_position(*built, random);
    const Rows jacobian = evaluate(pose_at(q)).jacobian;
    Subspace s;
    ASSERT_TRUE(joint.subspace(q.data(), s));
    if (jacobian.rows() == 0) continue;
    EXPECT_GT(Eigen::JacobiSVD<Eigen::MatrixXd>(jacobian).singularValues().minCoeff(), 0.1);
    EXPECT_LE((jacobian * s).norm(), 64 * eps);
  }
}

// Differences of sixth order with a step of 0.01 on functions that are smooth over a length of about 0.5.
TEST_P(JointWithFace, JacobianIsTheRateOfTheResidualsAwayFromTheMotionToo) {
  for (int trial = 0; trial < 50; ++trial) {
    const Pose off{rotation_about<double>(random.direction(), random.between(-1.2, 1.2)), 0.1 * random.vector()};
    EXPECT_LE(jacobian_error(pose_at(random_position(*built, random)) * off, 0.004), 1e-10) << "trial " << trial;
  }
}

TEST_P(JointWithFace, JacobianIsTheRateOfTheResidualsAtItsMotion) {
  for (int trial = 0; trial < 20; ++trial) {
    EXPECT_LE(jacobian_error(pose_at(random_position(*built, random)), 0.004), 1e-11);
    const Pose off{rotation_about<double>(random.direction(), 1e-9), 1e-9 * random.vector()};
    EXPECT_LE(jacobian_error(pose_at(random_position(*built, random)) * off, 0.004), 1e-11);
  }
}

TEST_P(JointWithFace, CoordinatesComeBackWithAllTheirTurns) {
  for (int trial = 0; trial < 100; ++trial) {
    Eigen::VectorXd q = random_position(*built, random, 3.0);
    for (const StateBlock& block : built->blocks) {
      const bool turns = block.kind == BlockKind::angle && GetParam().name != "varying_screw";
      if (turns) q[block.q] += 2 * pi * static_cast<int>(random.between(-3, 3));
    }
    Eigen::VectorXd found = q, off(joint.nv);
    for (Eigen::Index i = 0; i < off.size(); ++i) off[i] = random.between(-1.2, 1.2);
    integrate(*built, q, off, found);  // what was known last
    ASSERT_TRUE(face.coordinates(joint, pose_at(q), found.data()));
    EXPECT_LE((found - q).cwiseAbs().sum(), 1e-13) << q.transpose();
  }
}

/// Joints that keep a direction: turned upside down they are as far from closed as can be.
class JointThatKeepsAnAxis : public JointWithFace {};
INSTANTIATE_TEST_SUITE_P(Of, JointThatKeepsAnAxis, testing::ValuesIn([] {
                           std::vector<JointCase> out;
                           for (const JointCase& joint : joints(true)) {
                             const std::string& n = joint.name;
                             const bool turns_freely = n == "spherical" || n == "free";
                             const bool crosses = n == "universal" || n == "oblique_universal";
                             // The stranger's screw has no turn about z upside down; what it says there is its own.
                             if (!turns_freely && !crosses && n != "varying_screw") out.push_back(joint);
                           }
                           return out;
                         }()),
                         case_name);

TEST_P(JointThatKeepsAnAxis, IsHalfATurnAwayWhenItIsUpsideDown) {
  for (int trial = 0; trial < 20; ++trial) {
    const double about = random.between(0, 2 * pi);
    const Vector3 across(std::cos(about), std::sin(about), 0);
    for (const double off : {0.0, 1e-17, 1e-12, 1e-9, 1e-7}) {
      const Pose turned{rotation_about<double>(across, pi - off), Vector3::Zero()};
      const Evaluated at = evaluate(turned);
      EXPECT_NEAR(at.residual.norm(), pi - off, 1e-8) << off;
      EXPECT_TRUE(at.jacobian.allFinite());
    }
  }
}

// There the direction of the turn changes over a length of `off`: the differences know it to eps / off / step.
TEST_P(JointThatKeepsAnAxis, JacobianIsRightNextToUpsideDown) {
  for (const double off : {0.1, 1e-2, 1e-3}) {
    for (int trial = 0; trial < 20; ++trial) {
      const double about = random.between(0, 2 * pi);
      const Vector3 across(std::cos(about), std::sin(about), 0);
      const Pose turned{rotation_about<double>(across, pi - off), random.vector()};
      EXPECT_LE(jacobian_error(turned, 0.004 * off), 1e3 * eps / (off * off) / 0.04) << off;
    }
  }
}

TEST(Weld, TurnedByHalfATurnAboutAnyAxisIsNotClosed) {
  const Built built(single_joint("type = 'weld'"));
  const Face face = Face::of(built->joints[0]).value();
  Random random(22);
  for (int trial = 0; trial < 100; ++trial) {
    const Pose turned{rotation_about<double>(random.direction(), pi), Vector3::Zero()};
    Vector6 residual;
    Rows jacobian(6, 6);
    ASSERT_TRUE(face.evaluate(built->joints[0], turned, residual.data(), jacobian.data()));
    EXPECT_NEAR(residual.tail<3>().norm(), pi, 1e-15);
  }
}

// If the one equation of a Cardan joint is met, its coordinates make the pose: there is no other root.
TEST(Universal, HasNoFalseRoot) {
  for (const std::string axis2 : {"[1, 0, 0]", "[1, 0.3, 0.8]", "[-0.2, 0.5, -0.1]"}) {
    const Built built(single_joint("type = 'universal'\naxis2 = " + axis2));
    const Joint& joint = built->joints[0];
    const Face face = Face::of(joint).value();
    Random random(23);
    for (int trial = 0; trial < 200; ++trial) {
      Pose pose{random.rotation(), Vector3::Zero()};
      Eigen::Vector4d residual;
      Rows jacobian(4, 6);
      for (int i = 0; i < 60; ++i) {  // along the gradient to the root
        ASSERT_TRUE(face.evaluate(joint, pose, residual.data(), jacobian.data()));
        pose.rotation = pose.rotation * rotation_of_quaternion<double>(quaternion_of_rotation_vector<double>(
                                            -residual[3] * jacobian.row(3).head<3>().transpose()));
      }
      if (std::abs(residual[3]) > 1e-15) continue;
      Eigen::VectorXd q = Eigen::VectorXd::Zero(2);
      ASSERT_TRUE(face.coordinates(joint, pose, q.data()));
      Pose made;
      ASSERT_TRUE(joint.pose(q.data(), made));
      EXPECT_LE((made.rotation - pose.rotation).norm(), 1e-13);
    }
  }
}

TEST(Face, IsNotOfferedByJointsWhoseMotionIsNotOfItsKind) {
  for (const JointCase& joint : joints(false)) {
    EXPECT_FALSE(Face::of(Built(single_joint(joint.text))->joints[0])) << joint.name;
  }
}

}  // namespace
}  // namespace koppel::test
