// Positions of rest against closed forms, and what is said where there are none.
#include "dynamics/equilibrium.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "four_bar.hpp"
#include "resting.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;
constexpr double weight = 2.0 * 9.81 * 0.5;  // N m, of the pendulum

/// Where the forces are known to rounding of their size, a coordinate is to that over the stiffness.
double rounding(const Equilibrium& e) { return 16.0 * eps * e.force_scale / e.stiffness.eigenvalues[0]; }

TEST(Equilibrium, PendulumHangs) {
  for (const char* start : {"0.0", "1.5", "-3.0", "2.8"}) {
    const Started scene(pendulum(start));
    const Equilibrium e = scene.found();
    const double angle = e.q[scene.q("pivot.angle")];
    EXPECT_NEAR(std::cos(angle), 0.0, rounding(e)) << start;
    EXPECT_LT(std::sin(angle), 0.0) << start;
    EXPECT_EQ(e.stiffness.count(Holding::stable), 1u);
    EXPECT_NEAR(e.stiffness.matrix.value(0, 0), weight, e.stiffness.matrix.error(0, 0) + 4 * eps * weight);
    EXPECT_NEAR(e.energy, -weight, 4 * eps * weight);
    EXPECT_LT(e.residual, 16 * eps);
  }
}

TEST(Equilibrium, PendulumUprightIsUnstable) {
  const Started upright(pendulum("'90 deg'"));
  const Equilibrium e = upright.found();
  EXPECT_EQ(e.q, upright.state.q);
  EXPECT_EQ(e.stiffness.count(Holding::unstable), 1u);
  EXPECT_EQ(e.iterations, 0u);

  EquilibriumOptions nearest;
  nearest.nearest = true;
  const Started tilted(pendulum("1.2"));
  const Equilibrium near = tilted.found(nearest);
  EXPECT_NEAR(near.q[tilted.q("pivot.angle")], pi / 2, -rounding(near));
  EXPECT_EQ(near.stiffness.count(Holding::unstable), 1u);
}

TEST(Equilibrium, FourBarRestsWhereItsPotentialIsLeast) {
  const Started scene(FourBar::scene());
  const Equilibrium e = scene.found();
  const double angle = e.q[scene.q("crank.angle")];
  const Jet potential = FourBar(angle).potential();
  EXPECT_NEAR(potential.first, 0.0, 64 * eps * e.force_scale);
  ASSERT_GT(potential.second, 0.0);
  EXPECT_EQ(e.stiffness.count(Holding::stable), 1u);
  EXPECT_NEAR(e.energy, potential.value, 64 * eps * e.force_scale);
  // The stiffness in whichever coordinate is independent: at rest it goes with the square of the rates' ratio.
  ASSERT_EQ(e.independent.size(), 1u);
  const Eigen::VectorXd direction = e.stiffness.directions.col(0);
  const double ratio = direction[scene.v("crank.angle")] / direction[e.independent[0]];
  EXPECT_NEAR(e.stiffness.matrix.value(0, 0), potential.second * ratio * ratio,
              e.stiffness.matrix.error(0, 0) + 1e3 * eps * e.force_scale);
  EXPECT_NEAR(direction[scene.v("rocker.angle")] / direction[scene.v("crank.angle")], FourBar(angle).rocker_rate(),
              64 * eps);
}

TEST(Equilibrium, DoesNotDependOnWhereTheLoopIsCut) {
  const Started one(FourBar::scene());
  const Equilibrium first = one.found();
  for (const std::vector<std::string>& order : {std::vector<std::string>{"rocker", "b", "a", "crank"},
                                                {"b", "rocker", "crank", "a"},
                                                {"a", "crank", "rocker", "b"}}) {
    const Started other(FourBar::scene(order));
    const Equilibrium e = other.found();
    const double allowed = rounding(first) + rounding(e);
    for (const char* name : {"crank.angle", "rocker.angle"}) {
      EXPECT_NEAR(std::remainder(e.q[other.q(name)] - first.q[one.q(name)], 2 * pi), 0.0, allowed) << name;
    }
    EXPECT_NEAR(e.energy, first.energy, 64 * eps * first.force_scale);
  }
}

TEST(Equilibrium, DrivesHold) {
  const Started scene(FourBar::scene({"crank", "a", "b", "rocker"},
                                     "[[drive]]\nof = 'crank.angle'\ntype = 'ramp'\nstart = 1.0\nslope = 3.0\n"));
  const Equilibrium e = scene.found();
  EXPECT_EQ(e.force.size(), 0);
  EXPECT_EQ(e.q[scene.q("crank.angle")], 1.0);
  EXPECT_EQ(e.v.lpNorm<Eigen::Infinity>(), 0.0);
}

/// An arm on an axle at the axis of a driven shaft: it stands off where gravity and the turning balance.
std::string turning_arm(double speed) {
  return "[scene]\ngravity = [0, 0, -9.81]\nlength = 1\n[[body]]\nname = 'shaft'\n"
         "[[body]]\nname = 'arm'\ntype = 'point_mass'\nmass = 2\nat = [0, 0, 0]\n"
         "[[joint]]\nname = 'shaft'\ntype = 'revolute'\ninlet = 'ground'\noutlet = 'shaft'\n"
         "[[joint]]\nname = 'hinge'\ntype = 'revolute'\ninlet = { on = 'shaft', axis = [0, 1, 0], x_axis = [0, 0, -1] "
         "}\n"
         "outlet = { on = 'arm', at = [-0.5, 0, 0], axis = [0, 0, 1], x_axis = [1, 0, 0] }\nstart = { angle = 0.7 }\n"
         "[[drive]]\nof = 'shaft.angle'\ntype = 'ramp'\nslope = " +
         std::to_string(speed) + "\n";
}

TEST(Equilibrium, GovernorStandsOffInSteadyMotion) {
  constexpr double speed = 6.0, length = 0.5;
  const Started scene(turning_arm(speed));
  EquilibriumOptions moving;
  moving.moving = true;
  const Equilibrium e = scene.found(moving);
  const double cosine = 9.81 / (speed * speed * length);
  const double stiffness = 2.0 * length * length * speed * speed * (1.0 - cosine * cosine);
  EXPECT_NEAR(std::cos(e.q[scene.q("hinge.angle")]), cosine, rounding(e));
  EXPECT_NEAR(e.stiffness.matrix.value(0, 0), stiffness, e.stiffness.matrix.error(0, 0) + 64 * eps * stiffness);
  EXPECT_EQ(e.unrest, 0.0);
  EXPECT_NEAR(e.v[scene.v("shaft.angle")], speed, 0.0);
  // At rest it hangs.
  const Equilibrium still = scene.found();
  EXPECT_NEAR(still.q[scene.q("hinge.angle")], 0.0, rounding(still));
}

TEST(Equilibrium, BodyOnSpringsComesHome) {
  const std::string text =
      "[scene]\ngravity = [0, 0, 0]\nlength = 1\n[[body]]\nname = 'block'\nmass = 2\ninertia = [1, 2, 3, 0, 0, 0]\n"
      "[[joint]]\nname = 'block'\ntype = 'free'\ninlet = 'ground'\noutlet = 'block'\n"
      "start = { rotation = [0.6, 0.48, 0.64, 0], x = 0.3, y = -0.2, z = 0.5 }\n"
      "[[force]]\nname = 'mount'\ntype = 'bushing'\nfrom = 'ground'\nto = 'block'\nstiffness = [100, 200, 300]\n"
      "rotational_stiffness = [10, 20, 30]\n";
  const Started scene(text);
  const Equilibrium e = scene.found();
  const double allowed = 64 * eps * e.force_scale / 10.0;
  EXPECT_NEAR(std::abs(e.q[scene.q("block.rotation.w")]), 1.0, allowed);
  for (const char* name :
       {"block.rotation.x", "block.rotation.y", "block.rotation.z", "block.x", "block.y", "block.z"}) {
    EXPECT_NEAR(e.q[scene.q(name)], 0.0, allowed) << name;
  }
  ASSERT_EQ(e.stiffness.eigenvalues.size(), 6);
  const double known[] = {10, 20, 30, 100, 200, 300};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(e.stiffness.eigenvalues[i], known[i], e.stiffness.error);
  EXPECT_LT(e.stiffness.error, 1e-9);
}

TEST(Equilibrium, NeedsNoMass) {
  const Started scene(
      "[scene]\nlength = 1\n[[body]]\nname = 'ghost'\n[[joint]]\nname = 'pin'\ntype = 'revolute'\n"
      "inlet = 'ground'\noutlet = 'ghost'\n[[force]]\nname = 'spring'\ntype = 'coordinate_spring'\nof = 'pin.angle'\n"
      "stiffness = 7\nfree = 0.3\n[[force]]\nname = 'motor'\ntype = 'motor'\nof = 'pin.angle'\neffort = 1.4\n");
  const Equilibrium e = scene.found();
  EXPECT_NEAR(e.q[scene.q("pin.angle")], 0.5, 4 * eps);
  EXPECT_EQ(e.stiffness.count(Holding::stable), 1u);
}

TEST(Equilibrium, NothingHoldsAFreeBody) {
  const Started scene(
      "[scene]\ngravity = [0, 0, 0]\nlength = 1\n[[body]]\nname = 'stone'\nmass = 1\n"
      "inertia = [1, 1, 2, 0, 0, 0]\n");
  const Equilibrium e = scene.found();
  EXPECT_EQ(e.stiffness.count(Holding::indifferent), 6u);
  EXPECT_EQ(e.q, scene.state.q);
}

TEST(Equilibrium, WheelIsIndifferentBesideAPendulum) {
  const Started scene(pendulum("0.0",
                               "[[body]]\nname = 'wheel'\nmass = 5\ninertia = [1, 1, 2, 0, 0, 0]\n[[joint]]\n"
                               "name = 'axle'\ntype = 'revolute'\ninlet = { on = 'bob', at = [0.5, 0, 0] }\n"
                               "outlet = 'wheel'\n"));
  const Equilibrium e = scene.found();
  ASSERT_EQ(e.stiffness.holding.size(), 2u);
  EXPECT_EQ(e.stiffness.holding[0], Holding::indifferent);
  EXPECT_EQ(e.stiffness.holding[1], Holding::stable);
  EXPECT_EQ(e.stiffness.directions(scene.v("axle.angle"), 0), 1.0);
  EXPECT_NEAR(e.stiffness.directions(scene.v("pivot.angle"), 0), 0.0, e.stiffness.error / weight);
}

TEST(Equilibrium, IntegralControllerHoldsItsSetpoint) {
  const Started scene(pendulum("0.2",
                               "[[force]]\nname = 'servo'\ntype = 'controller'\nof = 'pivot.angle'\nsetpoint = 0.5\n"
                               "proportional = 30\nintegral = 4\nderivative = 1\n"));
  const Equilibrium e = scene.found();
  EXPECT_NEAR(e.q[scene.q("pivot.angle")], 0.5, 16 * eps);
  // It alone carries the weight.
  EXPECT_NEAR(e.internal[0], weight * std::cos(0.5) / 4.0, 1e3 * eps * weight);
  EXPECT_TRUE(e.stiffness.states_held);
}

TEST(Equilibrium, TakenOverNothingMoves) {
  Started scene(pendulum("0.2",
                         "[[force]]\nname = 'servo'\ntype = 'controller'\nof = 'pivot.angle'\nsetpoint = 0.5\n"
                         "proportional = 30\nintegral = 4\nderivative = 1\n"));
  scene.state.v.setOnes();
  scene.state.a.setOnes();
  scene.take(scene.found());
  EXPECT_EQ(scene.state.stage, Stage::accelerations);
  EXPECT_TRUE(scene.state.v.isZero(0.0));
  EXPECT_TRUE(scene.state.a.isZero(0.0));
  // Nor does the controller's integral.
  EXPECT_EQ(scene.linear().course, Course::resting);
}

TEST(Equilibrium, ConstantForceDrivesASliderAwayWithoutEnd) {
  const Started scene(
      "[scene]\nlength = 1\n[[body]]\nname = 'sledge'\nmass = 1\n[[joint]]\nname = 'track'\n"
      "type = 'prismatic'\ninlet = { on = 'ground', axis = [1, 0, 0] }\noutlet = 'sledge'\n"
      "[[force]]\nname = 'wind'\ntype = 'motor'\nof = 'track.displacement'\neffort = 3\n");
  const auto e = scene.rest();
  ASSERT_TRUE(e);
  EXPECT_FALSE(e->found);
  EXPECT_NE(e->why.find("drive track.displacement away without end"), std::string::npos) << e->why;
  ASSERT_EQ(e->force.size(), 1);
  EXPECT_EQ(std::abs(e->force[0]), 3.0);
}

TEST(Equilibrium, MotorStrongerThanTheWeightFindsNoRest) {
  const Started scene(pendulum("0.0", "[[force]]\nname = 'motor'\ntype = 'motor'\nof = 'pivot.angle'\neffort = 20\n"));
  const auto e = scene.rest();
  ASSERT_TRUE(e);
  EXPECT_FALSE(e->found);
  EXPECT_FALSE(e->why.empty());
  // It shows the place where least is missing.
  EXPECT_NEAR(e->force[0], 20.0 - weight, 1e-6 * weight);
}

TEST(Equilibrium, WeakerMotorIsHeldByTheWeight) {
  const Started scene(
      pendulum("'-90 deg'", "[[force]]\nname = 'motor'\ntype = 'motor'\nof = 'pivot.angle'\neffort = 5\n"));
  const Equilibrium e = scene.found();
  EXPECT_NEAR(std::cos(e.q[scene.q("pivot.angle")]), 5.0 / weight, rounding(e));
  EXPECT_EQ(e.stiffness.count(Holding::stable), 1u);
}

TEST(Equilibrium, ForceThatIsNotFiniteIsNamed) {
  const Started scene(pendulum("2.0",
                               "[[force]]\nname = 'wild'\ntype = 'coordinate_spring'\nof = 'pivot.angle'\n"
                               "stiffness = 1e308\nfree = -9\n"));
  const auto e = scene.rest();
  ASSERT_FALSE(e);
  EXPECT_EQ(e.error().code, Code::plugin_misbehaved);
  EXPECT_NE(e.error().element.find("wild"), std::string::npos);
}

TEST(Equilibrium, SoftDirectionBesideAStiffOneIsFoundAsWell) {
  const Started scene(
      "[scene]\nlength = 1\ngravity = [0, 0, 0]\n[[body]]\nname = 'b'\n[[joint]]\nname = 'j'\ntype = 'planar'\n"
      "inlet = 'ground'\noutlet = 'b'\n"
      "[[force]]\nname = 'x'\ntype = 'coordinate_spring'\nof = 'j.x'\nstiffness = 1e6\nfree = 1\n"
      "[[force]]\nname = 'y'\ntype = 'coordinate_spring'\nof = 'j.y'\nstiffness = 10\nfree = 2\n"
      "[[force]]\nname = 'a'\ntype = 'coordinate_spring'\nof = 'j.angle'\nstiffness = 1\nfree = 3\n");
  const Equilibrium e = scene.found();
  EXPECT_NEAR(e.q[scene.q("j.x")], 1.0, 4 * eps);
  EXPECT_NEAR(e.q[scene.q("j.y")], 2.0, 4 * eps);
  EXPECT_NEAR(e.q[scene.q("j.angle")], 3.0, 8 * eps);
}

}  // namespace
}  // namespace koppel::test
