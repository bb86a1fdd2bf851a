// Simulations against the digits of benchmarks and closed forms, and against what mechanics keeps.
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "simulated.hpp"

namespace koppel::test {
namespace {

/// A published or closed-form value of a coordinate.
struct Digits {
  const char* scene;
  double time;
  const char* coordinate;
  double value;
};

void PrintTo(const Digits& d, std::ostream* out) { *out << d.scene << " at " << d.time; }

struct Reference : testing::TestWithParam<Digits> {};

/// Errors of steps are each within the tolerance (root mean square over n components, so n^(1/2) of it in one), and
/// grow from then on no more than a disturbance that is there from the start: steps * n^(1/2) * tolerance * growth. A
/// decade for what the embedded method underestimates.
TEST_P(Reference, IsMetWithinTheTolerance) {
  const Digits& known = GetParam();
  const std::string text = scene(known.scene);
  const double push = 1e-6;
  Simulated pushed(text, within(1e-10, known.time), push);
  pushed.to(known.time);
  for (const double tolerance : {1e-7, 1e-9, 1e-11}) {
    Simulated run(text, within(tolerance, known.time));
    run.to(known.time);
    const double growth = 1.0 + std::abs(pushed.q(known.coordinate) - known.value) / push;
    const double steps = static_cast<double>(run.simulation->summary().steps);
    const double components = 2.0 * static_cast<double>(run.simulation->independent().size());
    const double rounding = eps * std::abs(known.value) * steps;
    EXPECT_NEAR(
        run.q(known.coordinate), known.value,
        10.0 * steps * std::sqrt(components) * tolerance * std::max(1.0, std::abs(known.value)) * growth + rounding)
        << "tolerance " << tolerance;
    EXPECT_LT(run.simulation->summary().position_drift, 1e-13);
  }
}

INSTANTIATE_TEST_SUITE_P(Dynamics, Reference,
                         testing::Values(
                             // A01: angle from the vertical of (x, y) = (-0.275087462576116860, -0.961419205099125064).
                             Digits{"pendulum", 10.0, "pivot.angle", -0.27868067356998},
                             // A02, N = 2: upright start, through its singular positions; ours turns the other way.
                             Digits{"nfourbar", 1.0, "bar0.angle", -3.3378708031050977},
                             Digits{"nfourbar", 10.0, "bar0.angle", -31.750597186986102},
                             // A03.
                             Digits{"andrews", 0.01, "beta.angle", 2.1601131315315265},
                             Digits{"andrews", 0.03, "beta.angle", 15.810771195153707},
                             Digits{"andrews", 0.03, "gamma.angle", 0.040822240119645805},
                             // A04.
                             Digits{"bricard", 1.0, "p0.angle", 1.03502845951806218},
                             Digits{"bricard", 10.0, "p0.angle", 0.000269048883324646512},
                             // A05 with 1 Hz at the start.
                             Digits{"governor", 0.1, "slider.displacement", 0.523836475569575694},
                             // Three uniform rods.
                             Digits{"triple_pendulum", 2.0, "first.angle", -0.51849853707901688048}),
                         [](const auto& row) {
                           return std::string(row.param.scene) + "_" + std::to_string(row.index);
                         });

TEST(Simulation, FreeBodyTurnsAsEulerSays) {
  Simulated run(scene("free_body"), within(1e-11, 10.0));
  run.to(10.0);
  // X-FREE; ten digits are known, and some thousand steps at the tolerance.
  EXPECT_NEAR(run.v("body.rotation.x"), 0.3587421993, 1e-8);
  EXPECT_NEAR(run.v("body.rotation.y"), 5.9677644142, 1e-8);
  EXPECT_NEAR(run.v("body.rotation.z"), 0.6214401795, 1e-8);
  EXPECT_NEAR(Eigen::Vector4d(run.state.q.head<4>()).norm(), 1.0, 4 * eps);
}

TEST(Simulation, SatelliteComesBackAfterAPeriod) {
  constexpr double period = 39.10573419726872;
  Simulated run(scene("satellite"), within(1e-11, period));
  run.to(period);
  EXPECT_NEAR(run.v("satellite.rotation.x"), 0.01, 1e-8);
  EXPECT_NEAR(run.v("satellite.rotation.y"), 1.0, 1e-8);
  EXPECT_NEAR(run.v("satellite.rotation.z"), 0.01, 1e-8);
}

TEST(Simulation, TopKeepsItsTiltInSteadyPrecession) {
  Simulated run(scene("top"), within(1e-11, 1.0));
  const Kinematics& kinematics = run.work.equations.kinematics;
  run.to(1.0);
  ASSERT_TRUE(realise(run.work, run.state));
  const Vector3 axis = kinematics.poses[1].rotation.col(2);
  EXPECT_NEAR(axis.z(), std::cos(pi / 6), 1e-8);
  // Once round at 2.521316969 rad/s, from where it started: ten digits are known.
  Simulated start(scene("top"), within(1e-11, 1.0));
  ASSERT_TRUE(realise(start.work, start.state));
  const Vector3 first = start.work.equations.kinematics.poses[1].rotation.col(2);
  const double turned =
      std::atan2(first.x() * axis.y() - first.y() * axis.x(), first.x() * axis.x() + first.y() * axis.y());
  EXPECT_NEAR(turned, 2.521316969, 1e-8);
}

TEST(Simulation, GimbalsPrecessAsTheTopDoes) {
  Simulated run(scene("gyroscope"), within(1e-11, 1.0));
  run.to(1.0);
  const auto& names = run.built->rate_names;
  EXPECT_NEAR(run.state.v[0], 2.521316969, 1e-8) << names[0].name;
}

/// Energy is kept where nothing feeds or drains it, the better the finer the steps.
struct Conservative : testing::TestWithParam<const char*> {};
TEST_P(Conservative, KeepsItsEnergy) {
  double before = std::numeric_limits<double>::infinity();
  for (const double tolerance : {1e-6, 1e-9}) {
    Simulated run(scene(GetParam()), within(tolerance, 1.0));
    run.to(1.0);
    const SimulationSummary& summary = run.simulation->summary();
    const double error = summary.energy_error / summary.energy_size;
    // Each step may lose its tolerance, twice over since the energy goes with the square of a rate.
    EXPECT_LT(error, 20.0 * tolerance * static_cast<double>(summary.steps));
    EXPECT_LT(error, before);
    EXPECT_LT(summary.position_drift, 1e-13);
    EXPECT_LT(summary.velocity_drift, 1e-10);
    before = error;
  }
}
INSTANTIATE_TEST_SUITE_P(Dynamics, Conservative,
                         testing::Values("fourbar_free", "rsur_free", "fivelink_free", "bricard", "double_pendulum",
                                         "folding_slidercrank", "heavy_top"));

const char* const driven_crank =
    "[scene]\ngravity = [0, -9.81, 0]\n"
    "[[body]]\nname = 'crank'\nmass = 1\ncentre_of_mass = [0.05, 0, 0]\ninertia = [0, 0.01, 0.01, 0, 0, 0]\n"
    "[[body]]\nname = 'rod'\nmass = 2\ncentre_of_mass = [0.15, 0, 0]\ninertia = [0, 0.02, 0.02, 0, 0, 0]\n"
    "[[body]]\nname = 'slider'\nmass = 3\n"
    "[[joint]]\nname = 'crank'\ntype = 'revolute'\ninlet = 'ground'\noutlet = 'crank'\n"
    "[[joint]]\nname = 'pin'\ntype = 'revolute'\ninlet = { on = 'crank', at = [0.1, 0, 0] }\noutlet = 'rod'\n"
    "[[joint]]\nname = 'wrist'\ntype = 'revolute'\ninlet = { on = 'rod', at = [0.3, 0, 0] }\noutlet = 'slider'\n"
    "[[joint]]\nname = 'slider'\ntype = 'prismatic'\ninlet = { on = 'ground', axis = [1, 0, 0] }\n"
    "outlet = { on = 'slider', axis = [1, 0, 0] }\nstart = { displacement = 0.4 }\n";

TEST(Simulation, WorkOfADriveExplainsTheEnergy) {
  Simulated run(std::string(driven_crank) +
                    "[[drive]]\nof = 'crank.angle'\ntype = 'ramp'\nslope = 20\n"
                    "[[force]]\nname = 'gas'\ntype = 'motor'\nof = 'slider.displacement'\neffort = -40\n",
                within(1e-9, 1.0));
  run.to(1.0);
  const SimulationSummary& summary = run.simulation->summary();
  EXPECT_TRUE(run.simulation->independent().empty());
  EXPECT_GT(summary.energy_size, 1.0);  // it does change
  // Nothing but the integral of the power is integrated; its steps are within the tolerance of 1 J.
  EXPECT_LT(summary.energy_error, 20.0 * 1e-9 * static_cast<double>(summary.steps) * summary.energy_size);
  EXPECT_EQ(run.q("crank.angle"), 20.0);
}

TEST(Simulation, DampersTakeWhatIsMissing) {
  Simulated run(
      std::string(driven_crank) +
          "[[force]]\nname = 'spring'\ntype = 'coordinate_spring'\nof = 'slider.displacement'\nstiffness = 300\n"
          "damping = 30\nfree = 0.3\n",
      within(1e-9, 20.0));
  run.to(20.0);
  const SimulationSummary& summary = run.simulation->summary();
  EXPECT_LT(summary.energy_error,
            20.0 * 1e-9 * static_cast<double>(summary.steps) * std::max(1.0, summary.energy_size));
  EXPECT_NEAR(run.v("crank.angle"), 0.0, 1e-6);  // it has come to rest
}

TEST(Simulation, ClassicalMethodIsOfOrderFour) {
  const auto error = [](double step) {
    Simulated run(scene("nfourbar"), by(IntegratorKind::classical, 0.0, step, 1.0));
    run.to(1.0);
    return std::abs(run.q("bar0.angle") + 3.3378708031050977);
  };
  const double slope = std::log2(error(0.02) / error(0.01));
  EXPECT_GT(slope, 3.6);
  EXPECT_LT(slope, 4.6);
}

TEST(Simulation, CutJointsGoOnTurning) {
  Simulated run(scene("andrews"), within(1e-9, 0.03));
  // Around the loop the angles of revolutes with parallel axes add up to what they were.
  const auto sum = [&] {
    return run.q("beta.angle") + run.q("theta.angle") - run.q("gamma.angle") - run.q("e_bde.angle");
  };
  const auto other = [&] {
    return run.q("beta.angle") + run.q("theta.angle") - run.q("gamma.angle") + run.q("e_bde.angle");
  };
  const double first = sum(), second = other();
  for (int i = 1; i <= 30; ++i) run.to(0.001 * i);
  EXPECT_GT(std::abs(run.q("beta.angle")), 4 * pi);
  EXPECT_LT(std::min(std::abs(sum() - first), std::abs(other() - second)), 1e-10);
}

TEST(Simulation, StepsDoNotDependOnWhatIsLookedAt) {
  Simulated once(scene("bricard"), within(1e-8, 2.0)), often(scene("bricard"), within(1e-8, 2.0));
  once.to(2.0);
  for (int i = 1; i <= 200; ++i) often.to(i == 200 ? 2.0 : 0.01 * i);
  EXPECT_EQ(once.simulation->summary().steps, often.simulation->summary().steps);
  EXPECT_NEAR(once.q("p0.angle"), often.q("p0.angle"), 1e-12);
}

TEST(Simulation, StartRatesSpreadOverTheLoops) {
  Simulated run(
      std::string(driven_crank) + "[[force]]\nname = 'none'\ntype = 'motor'\nof = 'crank.angle'\neffort = 0\n",
      within(1e-9, 1.0));
  State state(*run.built.mechanism);
  EXPECT_EQ(run.simulation->summary().start_change, 0.0);
  Simulated asked(
      [] {
        std::string text = driven_crank;
        const std::string crank = "outlet = 'crank'\n";
        return text.insert(text.find(crank) + crank.size(), "start_rate = { angle = 5 }\n");
      }(),
      within(1e-9, 1.0));
  asked.to(0.0);
  EXPECT_NEAR(asked.v("crank.angle"), 5.0, 16 * eps * 5.0);
  // At the dead centre the slider rests; the rod turns back with r / l of the crank's rate, seen from the crank more.
  EXPECT_NEAR(asked.v("slider.displacement"), 0.0, 1e-14);
  EXPECT_NEAR(asked.v("pin.angle"), -5.0 - 5.0 / 3.0, 1e-13);
  EXPECT_LT(asked.simulation->summary().start_change, 1e-14);
}

TEST(Simulation, SaysWhatMovesWithoutMass) {
  Simulated run(
      "[[body]]\nname = 'ghost'\n[[joint]]\nname = 'pin'\ntype = 'revolute'\ninlet = 'ground'\noutlet = 'ghost'\n",
      within(1e-9, 1.0));
  ASSERT_FALSE(run.started);
  EXPECT_EQ(run.started.error().code, Code::massless);
  EXPECT_NE(run.started.error().element.find("pin.angle"), std::string::npos);
}

TEST(Simulation, StopsAtTheLimitOfADrive) {
  // The slider is driven beyond the stretched position, which it reaches at 0.1 s.
  std::string text = driven_crank;
  Simulated run(text.replace(text.find("start = { displacement = 0.4 }"), 30, "start = { displacement = 0.39 }") +
                    "[[drive]]\nof = 'slider.displacement'\ntype = 'ramp'\nstart = 0.39\nslope = 0.1\n",
                within(1e-8, 1.0));
  ASSERT_TRUE(run.started);
  const Eigen::VectorXd before = run.state.q;
  const auto advanced = run.simulation->advance(1.0, run.state);
  ASSERT_FALSE(advanced);
  EXPECT_EQ(advanced.error().code, Code::simulation_stuck);
  EXPECT_EQ(run.state.q, before);
}

}  // namespace
}  // namespace koppel::test
