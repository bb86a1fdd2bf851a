// Integrators on mechanisms: they agree with each other, each in its own way.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "simulated.hpp"

namespace koppel::test {
namespace {

constexpr double bar_after_a_second = -3.3378708031050977;  // A02, as in simulation_test.cpp

/// The parallelogram's angle' = -3.4 at most, and it starts upright, where disturbances grow by e^(3.4 t) (11.445 is
/// the square of 3.4): times 30 in a second, in two components.
TEST(IntegratorsOfMechanisms, AgreeOnLoops) {
  for (const IntegratorKind kind :
       {IntegratorKind::dormand_prince, IntegratorKind::dop853, IntegratorKind::cvode, IntegratorKind::arkode}) {
    for (const double tolerance : {1e-6, 1e-9}) {
      Simulated run(scene("nfourbar"), by(kind, tolerance, 0.0, 1.0));
      run.to(1.0);
      const double steps = static_cast<double>(run.simulation->summary().steps);
      const double decade = kind == IntegratorKind::cvode ? 10.0 : 1.0;
      EXPECT_NEAR(run.q("bar0.angle"), bar_after_a_second, decade * 60.0 * tolerance * steps);
      EXPECT_LT(run.simulation->summary().position_drift, 1e-13);
    }
  }
}

/// The bars lie flat ten times in ten seconds, and the loops' equations lose rank there: no tolerance keeps rounding
/// out of the steps that go across. Each may put rates of size one off by 1e-8, and energy by twice as much of itself.
TEST(IntegratorsOfMechanisms, SingularPositionsAreCrossedAtAnyTolerance) {
  for (const IntegratorKind kind : {IntegratorKind::dormand_prince, IntegratorKind::dop853}) {
    for (const double tolerance : {1e-10, 1e-12, 1e-13}) {
      SCOPED_TRACE(tolerance);
      Simulated run(scene("nfourbar"), by(kind, tolerance, 0.0, 10.0));
      run.to(10.0);
      const SimulationSummary& summary = run.simulation->summary();
      EXPECT_LT(summary.energy_error, 10 * 2 * 1e-8 * summary.energy_size);
      // Ten crossings, at each of which two steps may be disturbed, and six lengths are tried for one.
      EXPECT_LE(summary.rejected, 10u * 2u * 6u) << "steps do not creep up to the singular position";
    }
  }
}

/// Of the platform's turn some rates are independent, the others are not, and long steps turn it far from its chart's
/// base. A hundred units of rounding of coordinates of the size of the mechanism.
TEST(IntegratorsOfMechanisms, LoopsCloseToRoundingHoweverFarAChartIsTurned) {
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    SCOPED_TRACE(tolerance);
    Simulated run(scene("stewart_free"), by(IntegratorKind::dop853, tolerance, 0.0, 1.0));
    run.to(1.0);
    EXPECT_LT(run.simulation->summary().position_drift, 100 * eps);
  }
}

TEST(IntegratorsOfMechanisms, FixedStepsKeepTheirOrders) {
  // Of the rate: it starts upright, without acceleration, so that positions of the semi-implicit method are those of
  // leap frog, and of order 2.
  constexpr double end = 0.375;  // before the bars lie flat, where rounding counts more than orders
  Simulated reference(scene("nfourbar"), by(IntegratorKind::dop853, 1e-12, 0.0, end));
  reference.to(end);
  const auto error = [&](IntegratorKind kind, double step) {
    Simulated run(scene("nfourbar"), by(kind, 0.0, step, end));
    run.to(end);
    return std::abs(run.v("bar0.angle") - reference.v("bar0.angle"));
  };
  const auto slope = [&](IntegratorKind kind, double step) {
    return std::log2(error(kind, step) / error(kind, step / 2));
  };
  EXPECT_NEAR(slope(IntegratorKind::semi_implicit, 1.0 / 1024), 1.0, 0.2);
  EXPECT_NEAR(slope(IntegratorKind::classical, 1.0 / 64), 4.0, 0.5);
}

/// A turning body in space: coordinates on a sphere of quaternions, taken anew where their chart ends.
TEST(IntegratorsOfMechanisms, AgreeOnATumblingBody) {
  Simulated reference(scene("free_body"), by(IntegratorKind::dormand_prince, 1e-12, 0.0, 2.0));
  reference.to(2.0);
  for (const IntegratorKind kind :
       {IntegratorKind::dop853, IntegratorKind::cvode, IntegratorKind::arkode, IntegratorKind::classical}) {
    const bool fixed = kind == IntegratorKind::classical;
    Simulated run(scene("free_body"), by(kind, fixed ? 0.0 : 1e-9, fixed ? 1e-3 : 0.0, 2.0));
    run.to(2.0);
    // Rates of some 6 rad/s whose errors add up over the steps; a decade as above. Fixed steps are finer than that.
    const double steps = static_cast<double>(run.simulation->summary().steps);
    EXPECT_LT((run.state.v - reference.state.v).norm(), 10.0 * 6.0 * 1e-9 * steps);
  }
}

/// A ball that spins by itself: its rates stay, and its turn is known. Times of steps are rounded, and so is the turn
/// of each; the sum of their lengths is not.
TEST(IntegratorsOfMechanisms, ManySmallStepsAddUpToTheTimeThatHasPassed) {
  const std::string ball =
      "[scene]\nlength = 1\n[[body]]\nname = 'ball'\nmass = 1\ninertia = [1, 1, 1, 0, 0, 0]\n"
      "[[joint]]\nname = 'pivot'\ntype = 'spherical'\noutlet = 'ball'\ninlet = 'ground'\n"
      "start_rate = { rotation = [0.36, 0.48, 0.8] }\n";
  constexpr double end = 1000.0, steps = 1e5;
  for (const IntegratorKind kind : {IntegratorKind::classical, IntegratorKind::semi_implicit}) {
    Simulated run(ball, by(kind, 0.0, end / steps, end));
    run.to(end);
    const double side = run.q("pivot.rotation.w") * std::cos(end / 2) > 0.0 ? 1.0 : -1.0;
    EXPECT_NEAR(side * run.q("pivot.rotation.w"), std::cos(end / 2), eps * steps);
    EXPECT_NEAR(side * run.q("pivot.rotation.z"), 0.8 * std::sin(end / 2), eps * steps);
    EXPECT_EQ(run.v("pivot.rotation.z"), 0.8);
  }
}

/// A weight of 1 kg on a spring of 1e9 N/m with a damper of 1e6 N s/m: it creeps home at e^(-1001 t), and what
/// stability wants is steps of some 3e-6 s.
const char* const stiff =
    "[[body]]\nname = 'weight'\nmass = 1\n"
    "[[joint]]\nname = 'slide'\ntype = 'prismatic'\ninlet = { on = 'ground', axis = [1, 0, 0] }\n"
    "outlet = { on = 'weight', axis = [1, 0, 0] }\nstart = { displacement = 0.1 }\n"
    "[[force]]\nname = 'spring'\ntype = 'coordinate_spring'\nof = 'slide.displacement'\nstiffness = 1e9\n"
    "damping = 1e6\n";

TEST(IntegratorsOfMechanisms, CvodeTakesStiffForcesInFewSteps) {
  constexpr double end = 1.0;
  Simulated implicit(stiff, by(IntegratorKind::cvode, 1e-6, 0.0, end));
  implicit.to(end);
  EXPECT_LT(implicit.simulation->summary().steps, 1000u);
  EXPECT_NEAR(implicit.q("slide.displacement"), 0.0, 1e-4);

  // A hundredth of the time shows what the whole would take.
  Simulated explicit_(stiff, by(IntegratorKind::dormand_prince, 1e-6, 0.0, end));
  explicit_.to(end / 100);
  EXPECT_GT(100 * explicit_.simulation->summary().steps, 100000u);
  EXPECT_TRUE(explicit_.simulation->summary().stiff);
}

/// The same without the damper swings 50 times in a step: what is too quick for the step fades by a tenth each, with
/// the square of their number where three modes do so together.
TEST(IntegratorsOfMechanisms, GeneralisedAlphaTakesStiffForcesInLongSteps) {
  std::string springs = stiff;
  springs.erase(springs.find("damping"));
  Simulated run(springs, by(IntegratorKind::generalised_alpha, 0.0, 1e-2, 2.0));
  for (int i = 1; i <= 200; ++i) {
    run.to(1e-2 * i);
    ASSERT_LT(std::abs(run.q("slide.displacement")), 0.1 * (1 + i) * (1 + i) * std::pow(0.9, i)) << i;
  }
}

TEST(IntegratorsOfMechanisms, TheRemedyForStiffnessIsNamed) {
  Simulated run(stiff, by(IntegratorKind::classical, 0.0, 1e-3, 1.0));
  ASSERT_TRUE(run.started);
  const auto advanced = run.simulation->advance(1.0, run.state);
  ASSERT_FALSE(advanced);
  EXPECT_EQ(advanced.error().code, Code::simulation_stuck);
  EXPECT_NE(advanced.error().advice.find("cvode"), std::string::npos);
  // It goes no further, and says the same again.
  EXPECT_EQ(run.simulation->advance(1.0, run.state).error().message, advanced.error().message);
}

TEST(SimulationOptions, WhatIsAskedForGoesBeforeTheScene) {
  SimulationDescription scene;
  EXPECT_EQ(simulation_options("", "", 0.0, 0.0, scene)->integrator, IntegratorKind::dormand_prince);
  EXPECT_EQ(simulation_options("", "", 0.0, 0.0, scene)->tolerance, 1e-8);
  EXPECT_EQ(simulation_options("", "", 0.0, 1e-3, scene)->integrator, IntegratorKind::classical);
  scene.integrator = "dop853";
  scene.tolerance = 1e-5;
  EXPECT_EQ(simulation_options("", "", 0.0, 0.0, scene)->integrator, IntegratorKind::dop853);
  EXPECT_EQ(simulation_options("", "", 0.0, 0.0, scene)->tolerance, 1e-5);
  EXPECT_EQ(simulation_options("", "", 0.0, 1e-3, scene)->integrator, IntegratorKind::classical);
  EXPECT_EQ(simulation_options("", "cvode", 1e-4, 0.0, scene)->tolerance, 1e-4);
  scene.integrator = "semi_implicit";
  scene.step = 0.002;
  EXPECT_EQ(simulation_options("", "", 0.0, 0.0, scene)->step, 0.002);
  EXPECT_EQ(simulation_options("", "", 1e-4, 0.0, scene)->integrator, IntegratorKind::dormand_prince);
  EXPECT_EQ(simulation_options("", "cvode", 0.0, 0.0, scene)->step, 0.0);
}

TEST(SimulationOptions, SayWhatDoesNotFit) {
  const SimulationDescription scene;
  const auto misspelt = simulation_options("", "dop583", 0.0, 0.0, scene);
  ASSERT_FALSE(misspelt);
  EXPECT_EQ(misspelt.error().code, Code::unknown_integrator);
  for (const IntegratorName& each : integrators()) {
    EXPECT_NE(misspelt.error().advice.find(each.name), std::string::npos) << misspelt.error().advice;
  }
  EXPECT_EQ(simulation_options("", "classical", 0.0, 0.0, scene).error().code, Code::missing_key);
  EXPECT_EQ(simulation_options("", "dop853", 0.0, 1e-3, scene).error().code, Code::conflicting_keys);
}

}  // namespace
}  // namespace koppel::test
