// A stranger's joints in loops: with callbacks or with the pose alone, in the tree and where the loop is cut, and what
// becomes of a plugin that answers nonsense.
#include <gtest/gtest.h>

#include "passage.hpp"

namespace koppel::test {
namespace {

std::string joint(const std::string& name, const std::string& from, const std::string& to, const std::string& place,
                  const std::string& type) {
  return "[[joint]]\nname = '" + name + "'\nbetween = ['" + from + "', '" + to + "']\n" + place + "\ntype = " + type +
         "\n";
}

const std::string callbacks = "'acme.varying_screw'\npitch = 0.1\ngrowth = 0.01";
const std::string pose_only = "'acme.bare_screw'\npitch = 0.1\ngrowth = 0.01";

std::string bodies(int count) {
  std::string text;
  for (int i = 1; i <= count; ++i) text += std::string("[[body]]\nname = 'b") + std::to_string(i) + "'\n";
  return text;
}

/// Crank, stranger's screw, Cardan joint and ball: mobility 1. The loop is cut at the ball.
std::string screw_in_the_tree(const std::string& screw) {
  return bodies(3) + joint("crank", "ground", "b1", "at = [0, 0, 0]\naxis = [0, 0, 1]", "'revolute'") +
         joint("screw", "ground", "b3", "at = [0.4, 0.1, 0.1]\naxis = [0, 1, 0.2]", screw) +
         joint("cross", "b3", "b2", "at = [0.5, 0.2, 0.4]\naxis = [1, 0, 0]", "'universal'\naxis2 = [0, 1, 0.3]") +
         joint("ball", "b2", "b1", "at = [0.15, 0, 0.1]", "'spherical'") +
         "[[drive]]\nof = 'crank.angle'\ntype = 'ramp'\nslope = 1\n";
}

/// Six screws of constant pitch, which nothing can cut, and the stranger's: mobility 1. Cut at the stranger's joint if
/// it has equations.
std::string screw_at_the_cut(const std::string& screw) {
  const char* const places[] = {"at = [0, 0, 0]\naxis = [0, 0, 1]",       "at = [0.3, 0, 0.1]\naxis = [1, 0.2, 0]",
                                "at = [0.4, 0.3, 0]\naxis = [0, 1, 0.5]", "at = [0.5, 0.4, 0.3]\naxis = [0.3, 0, 1]",
                                "at = [0.2, 0.6, 0.3]\naxis = [1, 1, 0]", "at = [0, 0.5, 0.2]\naxis = [0, 1, 1]"};
  std::string text = bodies(6);
  for (int i = 0; i < 6; ++i) {
    const std::string from = i == 0 ? std::string("ground") : std::string("b") + std::to_string(i);
    text += joint(std::string("h") + std::to_string(i), from, std::string("b") + std::to_string(i + 1), places[i],
                  "'helical'\npitch = 0.0" + std::to_string(i + 1));
  }
  return text + joint("screw", "b6", "ground", "at = [-0.2, 0.2, 0.1]\naxis = [1, 0, 0.4]", screw) +
         "[[drive]]\nof = 'h0.angle'\ntype = 'ramp'\nslope = 1\n";
}

void expect_derivatives(const std::string& text, double accuracy) {
  Closed closed(text);
  const Passage passage = Passage::around(closed, 0.3, 0.004);
  EXPECT_GT(std::abs(passage.now().v[closed.built.coordinate("screw.angle")]), 0.01) << "the screw must move";
  EXPECT_LE(closed.residual(), 1e-13);
  const double speed = 1 + passage.now().v.lpNorm<Eigen::Infinity>();
  EXPECT_LE(passage.velocity_error(*closed.built), accuracy * speed);
  EXPECT_LE(passage.acceleration_error(), 10 * accuracy * speed * speed);
}

TEST(StrangersScrew, ClosesALoopAsATreeJoint) {
  const std::string text = screw_in_the_tree(callbacks);
  const Built built(text);
  ASSERT_EQ(built->joints[built->relations[0].joint.index()].name, "ball");
  expect_derivatives(text, 1e-9);
}

TEST(StrangersScrew, ClosesALoopWhereItIsCut) {
  const std::string text = screw_at_the_cut(callbacks);
  const Built built(text);
  ASSERT_EQ(built->relations[0].kind, RelationKind::cut_joint);
  ASSERT_EQ(built->joints[built->relations[0].joint.index()].name, "screw");
  expect_derivatives(text, 1e-9);
}

TEST(StrangersScrew, WithThePoseAloneClosesBothToo) {
  expect_derivatives(screw_in_the_tree(pose_only), 1e-8);
  const std::string cut = screw_at_the_cut(pose_only);
  ASSERT_EQ(Built(cut)->relations[0].kind, RelationKind::cut_body);
  expect_derivatives(cut, 1e-8);
}

// Positions are closed to rounding whatever the derivatives; rates are as good as the differences that core forms.
TEST(StrangersScrew, MovesTheSameWithThePoseAlone) {
  for (const auto scene : {screw_in_the_tree, screw_at_the_cut}) {
    Closed with(scene(callbacks)), bare(scene(pose_only));
    for (int i = 0; i <= 40; ++i) {
      ASSERT_GE(with.move(0.01 * i), 0);
      ASSERT_GE(bare.move(0.01 * i), 0);
      const double speed = 1 + with.state.v.squaredNorm();
      EXPECT_LE((with.state.q - bare.state.q).norm(), 1e-12);
      EXPECT_LE((with.state.v - bare.state.v).norm(), 1e-11 * speed);
      EXPECT_LE((with.state.a - bare.state.a).norm(), 1e-8 * speed);
    }
  }
}

TEST(PluginThatReturnsNaN, IsNamedAndLeavesTheStateUntouched) {
  // Its pose is not a number, and it has two coordinates of its own: an angle and a displacement.
  const std::string text = bodies(2) +
                           joint("crank", "ground", "b1", "at = [0, 0, 0]\naxis = [0, 0, 1]", "'revolute'") +
                           joint("broken", "ground", "b2", "at = [0.4, 0, 0]\naxis = [0, 0, 1]",
                                 "'bad.joint'\nplugin = 'bad/pose_nan.so'\nfirst = 1") +
                           joint("ball", "b2", "b1", "at = [0.15, 0, 0.1]", "'spherical'");
  Closed closed(text);
  const State before = closed.state;
  EXPECT_EQ(closed.close(), KOPPEL_PLUGIN);
  EXPECT_TRUE(same_bits(closed.state, before));
  const std::string culprit = closed.work.equations.culprit();
  for (const std::string word : {"joint broken", "bad.joint", "pose_nan.so"}) {
    EXPECT_NE(culprit.find(word), std::string::npos) << culprit;
  }
  EXPECT_EQ(closed.move(1.0), KOPPEL_PLUGIN);
  EXPECT_TRUE(same_bits(closed.state, before));
}

}  // namespace
}  // namespace koppel::test
