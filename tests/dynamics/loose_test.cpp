// Where nothing resists, dynamics says so and names the rate; bodies without mass between others do no harm.
#include <gtest/gtest.h>

#include "moving_tree.hpp"

namespace koppel::test {
namespace {

/// Names of the rates that the two ways of forward dynamics call loose; empty if they find accelerations.
struct Loose {
  std::string by_bodies, by_factors;
};

Loose loose(MovingTree& tree) {
  const auto name = [&](std::uint32_t rate) { return tree.mechanism.rate_names[rate].name; };
  Loose result;
  Eigen::VectorXd found(tree.mechanism.nv);
  ArticulatedBodies articulated(tree.layout, tree.inertias);
  FactoredDynamics factored(tree.layout, tree.inertias);
  const Eigen::VectorXd efforts = tree.a;
  tree.move(tree.q, tree.v, tree.zero());
  if (!articulated.evaluate(tree.kinematics, tree.gravity, {}, efforts, found)) {
    result.by_bodies = name(articulated.loose());
  }
  if (!factored.evaluate(tree.kinematics, tree.gravity, {}, efforts, found)) result.by_factors = name(factored.loose());
  return result;
}

std::string row_of(const std::vector<std::string>& joints) {
  Random random(3);
  std::string text = "[scene]\nlength = 1\n";
  for (std::size_t i = 1; i <= joints.size(); ++i) {
    const std::string body = numbered("b", i), before = i == 1 ? "ground" : numbered("b", i - 1);
    text += "[[body]]\nname = '" + body + "'\n[[joint]]\nname = '" + numbered("j", i) + "'\n" + joints[i - 1] +
            "\ninlet = '" + before + "'\noutlet = '" + body + "'\n";
  }
  return text;
}

TEST(Loose, LastBodyWithoutMass) {
  MovingTree tree(row_of({"type = 'revolute'", "type = 'universal'"}), 5, [](Node node) { return node == 2; });
  const Loose found = loose(tree);
  EXPECT_EQ(found.by_bodies.substr(0, 2), "j2");
  EXPECT_EQ(found.by_factors.substr(0, 2), "j2");
}

TEST(Loose, CoaxialJointsWithoutMassBetween) {
  MovingTree tree(row_of({"type = 'revolute'", "type = 'revolute'"}), 5, [](Node node) { return node == 1; });
  const Loose found = loose(tree);
  EXPECT_EQ(found.by_bodies.substr(0, 2), "j1");
  EXPECT_EQ(found.by_factors.substr(0, 2), "j1");
}

TEST(Loose, TwoCoaxialMotionsOfOneJoint) {
  MovingTree tree(row_of({"type = 'free'", "type = 'odd.parallel'", "type = 'spherical'"}), 5);
  const Loose found = loose(tree);
  EXPECT_EQ(found.by_bodies.substr(0, 2), "j2");
  EXPECT_EQ(found.by_factors.substr(0, 2), "j2");
}

TEST(Loose, PointTurnedAboutItself) {
  MovingTree tree(row_of({"type = 'revolute'", "type = 'spherical'"}), 5);
  tree.inertias.of_node[2] = {0.7, Vector3(0.3, 0.1, -0.4), Matrix3::Zero()};
  const Loose found = loose(tree);
  EXPECT_EQ(found.by_bodies.substr(0, 2), "j2");
  EXPECT_EQ(found.by_factors.substr(0, 2), "j2");
}

TEST(Loose, RodTurnedAboutItsLine) {
  MovingTree tree(row_of({"type = 'free'", "type = 'revolute'"}), 5);
  tree.inertias.of_node[2] = {0.7, Vector3(0, 0, -0.4), Vector3(0.01, 0.01, 0).asDiagonal()};
  const Loose found = loose(tree);
  EXPECT_EQ(found.by_bodies.substr(0, 2), "j2");
  EXPECT_EQ(found.by_factors.substr(0, 2), "j2");
}

// After three translations nothing is left of a point for a turn to move, but rounding of its mass.
TEST(Loose, TurnBeforeThreeTranslations) {
  const std::string slide = "type = 'prismatic'\n";
  std::string text = row_of({"type = 'revolute'", slide, slide, slide});
  const auto turned = [&](const std::string& body, const std::string& turn) {
    const std::string plain = "\ninlet = '" + body + "'";
    text.replace(text.find(plain), plain.size(), "\ninlet = { on = '" + body + "', rotate = [" + turn + "] }");
  };
  turned("b1", "['x', 0.3]");
  turned("b2", "['x', 1.1]");
  turned("b3", "['y', 1.3]");
  MovingTree tree(text, 5, [](Node node) { return node < 4; });
  tree.inertias.of_node[4].about_centre.setZero();
  const Loose found = loose(tree);
  EXPECT_EQ(found.by_bodies.substr(0, 2), "j1");
  EXPECT_EQ(found.by_factors.substr(0, 2), "j1");
}

TEST(Loose, NotWithThreeMassesThatDifferByTenToTheTwelve) {
  MovingTree tree(row_of({"type = 'spherical'", "type = 'free'", "type = 'spherical'"}), 5);
  tree.inertias.of_node[1].mass *= 1e-6, tree.inertias.of_node[1].about_centre *= 1e-6;
  tree.inertias.of_node[3].mass *= 1e6, tree.inertias.of_node[3].about_centre *= 1e6;
  const Loose found = loose(tree);
  EXPECT_EQ(found.by_bodies, "");
  EXPECT_EQ(found.by_factors, "");
}

// A joint of several freedoms, and the same freedoms one by one with bodies without mass between.
TEST(Massless, BodiesBetweenJointsMakeOneJointOfThem) {
  const std::string whole = row_of({"type = 'free'", "type = 'universal'", "type = 'cylindrical'"});
  const std::string parts =
      "[scene]\nlength = 1\n[[body]]\nname = 'b1'\n[[body]]\nname = 'b2'\n[[body]]\nname = 'b3'\n"
      "[[body]]\nname = 'between'\n[[body]]\nname = 'inside'\n"
      "[[joint]]\nname = 'j1'\ntype = 'free'\ninlet = 'ground'\noutlet = 'b1'\n"
      "[[joint]]\nname = 'first'\ntype = 'revolute'\ninlet = 'b1'\noutlet = 'between'\n"
      "[[joint]]\nname = 'second'\ntype = 'revolute'\ninlet = { on = 'between', rotate = [['y', '90 deg']] }\n"
      "outlet = { on = 'b2', rotate = [['y', '90 deg']] }\n"
      "[[joint]]\nname = 'turn'\ntype = 'revolute'\ninlet = 'b2'\noutlet = 'inside'\n"
      "[[joint]]\nname = 'slide'\ntype = 'prismatic'\ninlet = 'inside'\noutlet = 'b3'\n";
  MovingTree one(whole, 5), many(parts, 6, [](Node node) { return node > 3; });
  ASSERT_EQ(one.mechanism.nv, many.mechanism.nv);
  for (Node node = 1; node <= 3; ++node) many.inertias.of_node[node] = one.inertias.of_node[node];
  many.q = one.q, many.v = one.v;
  Eigen::VectorXd found(one.mechanism.nv), again(one.mechanism.nv);
  ArticulatedBodies articulated(one.layout, one.inertias), in_parts(many.layout, many.inertias);
  ASSERT_TRUE(articulated.evaluate(one.move(one.q, one.v, one.zero()), one.gravity, {}, one.a, found));
  ASSERT_TRUE(in_parts.evaluate(many.move(many.q, many.v, many.zero()), one.gravity, {}, one.a, again));
  Eigen::MatrixXd m;
  one.mass_matrix().dense(m);
  const Eigen::VectorXd condition = m.inverse() * m.diagonal();
  EXPECT_LE((found - again).norm(), 100 * eps * condition.norm() * found.norm());
}

}  // namespace
}  // namespace koppel::test
