// The formulations of the equations of motion: they agree with each other at the orders of their integrators, and each
// keeps the loops closed in its own way.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "simulated.hpp"
#include "spatial/unit_vector.hpp"

namespace koppel::test {
namespace {

const FormulationName& of(Formulation formulation) { return formulations()[static_cast<std::size_t>(formulation)]; }

SimulationOptions in(Formulation formulation, double tolerance, double end) {
  SimulationOptions options = within(tolerance, end);
  options.formulation = formulation;
  options.integrator = of(formulation).integrator.value_or(IntegratorKind::dormand_prince);
  return options;
}

SimulationOptions in_steps(Formulation formulation, double step, double end) {
  SimulationOptions options;
  options.formulation = formulation;
  options.integrator = of(formulation).integrator.value_or(IntegratorKind::classical);
  options.tolerance = 0.0;
  options.step = step;
  options.end = end;
  return options;
}

struct Looped {
  const char* scene;
  double end;
};
void PrintTo(const Looped& looped, std::ostream* out) { *out << looped.scene; }

class LoopedScene : public testing::TestWithParam<Looped> {};
INSTANTIATE_TEST_SUITE_P(Of, LoopedScene,
                         testing::Values(Looped{"fourbar_free", 1.0}, Looped{"rsur_free", 0.5},
                                         Looped{"stewart_free", 0.2}, Looped{"fivelink_free", 0.3},
                                         Looped{"andrews", 0.01}, Looped{"bricard", 0.5}, Looped{"nfourbar", 0.3},
                                         Looped{"car_axis", 0.3}, Looped{"double_pendulum", 0.5},
                                         Looped{"heavy_top", 0.05}),
                         [](const auto& each) { return std::string(each.param.scene); });

/// Errors of single steps add up, and grow on the way: by less than a hundred times in these short runs, of rates that
/// may be a hundred times the positions. A decade for backward differentiation formulas (integrator_test.cpp).
TEST_P(LoopedScene, MovesTheSameInAllFormulations) {
  const auto [name, end] = GetParam();
  Simulated reference(scene(name), in(Formulation::minimal, 1e-11, end));
  reference.to(end);
  const double size = std::max(1.0, reference.state.v.lpNorm<Eigen::Infinity>());
  for (const Formulation formulation : {Formulation::projected, Formulation::baumgarte, Formulation::ggl}) {
    SCOPED_TRACE(of(formulation).name);
    Simulated run(scene(name), in(formulation, 1e-9, end));
    run.to(end);
    const double decade = formulation == Formulation::ggl ? 10.0 : 1.0;
    const double allowed = decade * 100.0 * size * 1e-9 * static_cast<double>(run.simulation->summary().steps);
    EXPECT_LE((run.state.q - reference.state.q).lpNorm<Eigen::Infinity>(), allowed);
    EXPECT_LE((run.state.v - reference.state.v).lpNorm<Eigen::Infinity>(), size * allowed);
    // What is shown is closed, whatever drifted.
    Equations equations(*run.built);
    ASSERT_TRUE(equations.evaluate(run.state.q, end));
    EXPECT_LE(equations.error(), 1e-13);
  }
}

/// The generalised-alpha method is of order 2 in positions and rates, whatever turns: the differences of three runs,
/// each with half the step of the one before, need no reference.
TEST_P(LoopedScene, OfIndexThreeConvergesAtOrderTwo) {
  const auto [name, end] = GetParam();
  const auto runs_to = [name = name, end = end](int steps) {
    Simulated run(scene(name), in_steps(Formulation::index3, end / steps, end));
    run.to(end);
    EXPECT_LE(run.simulation->summary().position_drift, 1e-14);
    Eigen::VectorXd reached(run.state.q.size() + run.state.v.size());
    reached << run.state.q, run.state.v;
    return reached;
  };
  const Eigen::VectorXd coarse = runs_to(400), middle = runs_to(800), fine = runs_to(1600);
  EXPECT_NEAR(std::log2((coarse - middle).norm() / (middle - fine).norm()), 2.0, 0.2);
}

TEST(Formulations, ConvergeAtTheOrderOfTheIntegrator) {
  Simulated reference(scene("fourbar_free"), in(Formulation::minimal, 1e-13, 0.5));
  reference.to(0.5);
  for (const Formulation formulation : {Formulation::minimal, Formulation::projected, Formulation::baumgarte}) {
    const auto error = [&](double step) {
      Simulated run(scene("fourbar_free"), in_steps(formulation, step, 0.5));
      run.to(0.5);
      return (run.state.q - reference.state.q).norm();
    };
    // Steps that are short enough for the stabilisation not to depend on them.
    EXPECT_NEAR(std::log2(error(1.0 / 64) / error(1.0 / 128)), 4.0, 0.6) << of(formulation).name;
  }
}

/// A weight that hangs on a unit vector, 0.4 m below where it points from, on its way round.
const char* const pointer =
    "[scene]\nlength = 1\ngravity = [0, 0, -9.81]\n"
    "[[body]]\nname = 'weight'\nmass = 1\ncentre_of_mass = [0, 0, -0.5]\ninertia = [0.25, 0.25, 0, 0, 0, 0]\n"
    "[[joint]]\nname = 'pointer'\ntype = 'odd.pointing'\ninlet = 'ground'\noutlet = 'weight'\n"
    "start = { direction = [0.6, 0.2, 0.77459666924148338] }\nstart_rate = { direction = [1, 2] }\n";

/// The axes along which rates of a unit vector count turn about it, which costs no energy: but the angular momentum
/// about the vertical tells whether that is taken for a motion. Derivatives of a joint that has but a pose are
/// differences, good to 1e-7 or so.
TEST(Formulations, KeepTheMomentumOfASphericalPendulum) {
  const auto momentum = [](const State& state) {
    const Vector3 n = state.q, rate = rate_axes<double>(n) * Eigen::Vector2d(state.v);
    return n.cross(rate).z();
  };
  for (const SimulationOptions& how : {in(Formulation::minimal, 1e-7, 3.0), in(Formulation::projected, 1e-7, 3.0),
                                       in(Formulation::ggl, 1e-7, 3.0), in_steps(Formulation::index3, 1e-3, 3.0)}) {
    SCOPED_TRACE(of(how.formulation).name);
    Simulated run(pointer, how);
    run.to(0.0);
    const double start = momentum(run.state);
    EXPECT_GT(std::abs(start), 0.1);
    for (int i = 1; i <= 30; ++i) {
      run.to(0.1 * i);
      EXPECT_NEAR(momentum(run.state), start, 3e-5) << i;
    }
    EXPECT_LT(run.simulation->summary().energy_error, 3e-5 * run.simulation->summary().energy_size);
  }
}

TEST(Formulations, OfIndexThreeIsOfOrderTwoOnUnitVectorsToo) {
  const auto runs_to = [](int steps) {
    Simulated run(pointer, in_steps(Formulation::index3, 0.5 / steps, 0.5));
    run.to(0.5);
    return Eigen::VectorXd(run.state.q);
  };
  const Eigen::VectorXd coarse = runs_to(100), middle = runs_to(200), fine = runs_to(400);
  EXPECT_NEAR(std::log2((coarse - middle).norm() / (middle - fine).norm()), 2.0, 0.2);
}

/// The crank of a four-bar turns as it likes; it has no mass to be turned, and the rocker's bar bears on a spring.
const char* const driven =
    "[scene]\nlength = 1\ngravity = [0, -9.81, 0]\n"
    "[[body]]\nname = 'crank'\n"
    "[[body]]\nname = 'coupler'\nmass = 1\ncentre_of_mass = [1.5, 0, 0]\ninertia = [0.01, 0.75, 0.75, 0, 0, 0]\n"
    "[[body]]\nname = 'rocker'\nmass = 1\ncentre_of_mass = [1.25, 0, 0]\ninertia = [0.01, 0.5, 0.5, 0, 0, 0]\n"
    "[[joint]]\nname = 'crank'\ntype = 'revolute'\ninlet = 'ground'\noutlet = 'crank'\n"
    "[[joint]]\nname = 'pin'\ntype = 'revolute'\ninlet = { on = 'crank', at = [1, 0, 0] }\noutlet = 'coupler'\n"
    "[[joint]]\nname = 'rocker'\ntype = 'revolute'\ninlet = { on = 'ground', at = [3.5, 0, 0] }\noutlet = 'rocker'\n"
    "start = { angle = 1.6 }\n"
    "[[joint]]\nname = 'end'\ntype = 'revolute'\ninlet = { on = 'coupler', at = [3, 0, 0] }\n"
    "outlet = { on = 'rocker', at = [2.5, 0, 0] }\n"
    "[[force]]\nname = 'spring'\ntype = 'coordinate_spring'\nof = 'rocker.angle'\nstiffness = 5\ndamping = 0.5\n"
    "free = 1.5\n"
    "[[drive]]\nof = 'crank.angle'\ntype = 'polynomial'\ncoefficients = [0.7, 1, 2]\n";

TEST(Formulations, AgreeOnDrivesAndOnTheirWork) {
  Simulated reference(driven, in(Formulation::minimal, 1e-11, 1.0));
  reference.to(1.0);
  for (const SimulationOptions& how : {in(Formulation::ggl, 1e-9, 1.0), in_steps(Formulation::index3, 1e-3, 1.0)}) {
    SCOPED_TRACE(of(how.formulation).name);
    Simulated run(driven, how);
    run.to(1.0);
    // No freedom is left: positions are the drive's, to rounding, and rates follow.
    EXPECT_LE((run.state.q - reference.state.q).norm(), 1e-12);
    EXPECT_LE((run.state.v - reference.state.v).norm(), 1e-11);
    // Work is a quadrature: of order 2 in steps of 1e-3, or by the tolerance.
    const SimulationSummary& summary = run.simulation->summary();
    EXPECT_LE(summary.energy_error, 1e-5 * summary.energy_size);
  }
}

TEST(Formulations, KeepTheLoopsClosedAsTheySay) {
  const auto drift = [](Formulation formulation, double tolerance) {
    Simulated run(scene("fourbar_free"), in(formulation, tolerance, 10.0));
    run.to(10.0);
    return run.simulation->summary().position_drift;
  };
  EXPECT_LE(drift(Formulation::minimal, 1e-6), 1e-13);
  for (const Formulation formulation : {Formulation::projected, Formulation::baumgarte}) {
    // A step's error before it is projected, or some twenty steps' that have not faded yet: not that of ten seconds.
    const double coarse = drift(formulation, 1e-6), fine = drift(formulation, 1e-9);
    EXPECT_LE(coarse, 1e2 * 1e-6);
    EXPECT_LE(fine, 1e2 * 1e-9);
    EXPECT_GT(coarse, 1e-13) << "these drift";
  }
  // Beside the equations stand the loops: Newton's method closes them, to rounding or to its part of the tolerance.
  EXPECT_LE(drift(Formulation::ggl, 1e-6), 1e-6);
  Simulated stepped(scene("fourbar_free"), in_steps(Formulation::index3, 1e-3, 10.0));
  stepped.to(10.0);
  EXPECT_LE(stepped.simulation->summary().position_drift, 1e-14);
}

TEST(Formulations, ThatAreNotKnownAreToldTheChoices) {
  const SimulationDescription scene;
  const auto misspelt = simulation_options("mimimal", "", 0.0, 0.0, scene);
  ASSERT_FALSE(misspelt);
  EXPECT_EQ(misspelt.error().code, Code::unknown_formulation);
  EXPECT_NE(misspelt.error().advice.find("projected"), std::string::npos);
  const auto clash = simulation_options("projected", "cvode", 0.0, 0.0, scene);
  ASSERT_FALSE(clash);
  EXPECT_EQ(clash.error().code, Code::conflicting_keys);
  EXPECT_EQ(simulation_options("projected", "arkode", 0.0, 0.0, scene)->formulation, Formulation::projected);
  EXPECT_EQ(simulation_options("baumgarte", "cvode", 0.0, 0.0, scene)->formulation, Formulation::baumgarte);
}

TEST(Formulations, BringTheirIntegratorsAndIntegratorsTheirFormulations) {
  SimulationDescription scene;
  EXPECT_EQ(simulation_options("ggl", "", 0.0, 0.0, scene)->integrator, IntegratorKind::ida);
  EXPECT_EQ(simulation_options("index3", "", 0.0, 1e-3, scene)->integrator, IntegratorKind::generalised_alpha);
  EXPECT_EQ(simulation_options("", "ida", 0.0, 0.0, scene)->formulation, Formulation::ggl);
  EXPECT_EQ(simulation_options("", "generalised_alpha", 0.0, 1e-3, scene)->formulation, Formulation::index3);
  // That of the scene, unless something that is asked for does not go with it.
  scene.formulation = "ggl";
  EXPECT_EQ(simulation_options("", "", 0.0, 0.0, scene)->integrator, IntegratorKind::ida);
  EXPECT_EQ(simulation_options("", "", 0.0, 1e-3, scene)->formulation, Formulation::minimal);
  EXPECT_EQ(simulation_options("", "dop853", 0.0, 0.0, scene)->formulation, Formulation::minimal);
  EXPECT_EQ(simulation_options("baumgarte", "", 0.0, 0.0, scene)->integrator, IntegratorKind::dormand_prince);
  scene.formulation = "baumgarte";
  EXPECT_EQ(simulation_options("", "dop853", 0.0, 0.0, scene)->formulation, Formulation::baumgarte);
  EXPECT_EQ(simulation_options("", "ida", 0.0, 0.0, scene)->formulation, Formulation::ggl);
  scene.formulation.clear();
  EXPECT_EQ(simulation_options("index3", "", 0.0, 0.0, scene).error().code, Code::missing_key);
  EXPECT_EQ(simulation_options("ggl", "", 0.0, 1e-3, scene).error().code, Code::conflicting_keys);
  for (const auto& [formulation, integrator] :
       {std::pair{"ggl", "dop853"}, {"minimal", "ida"}, {"index3", "ida"}, {"ggl", "generalised_alpha"}}) {
    const auto clash = simulation_options(formulation, integrator, 0.0, 1e-3, scene);
    ASSERT_FALSE(clash) << formulation << ' ' << integrator;
    EXPECT_EQ(clash.error().code, Code::conflicting_keys);
    EXPECT_NE(clash.error().message.find(formulation), std::string::npos) << clash.error().message;
  }
  // What a scene names gives way to what is asked for.
  scene.integrator = "ida";
  EXPECT_EQ(simulation_options("", "", 0.0, 0.0, scene)->formulation, Formulation::ggl);
  EXPECT_EQ(simulation_options("minimal", "", 0.0, 0.0, scene)->integrator, IntegratorKind::dormand_prince);
  EXPECT_EQ(simulation_options("", "", 0.0, 1e-3, scene)->formulation, Formulation::minimal);
}

}  // namespace
}  // namespace koppel::test
