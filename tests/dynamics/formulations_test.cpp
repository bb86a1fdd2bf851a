// The formulations of the equations of motion: they agree with each other at the orders of their integrators, and each
// keeps the loops closed in its own way.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "simulated.hpp"

namespace koppel::test {
namespace {

SimulationOptions in(Formulation formulation, double tolerance, double end) {
  SimulationOptions options = within(tolerance, end);
  options.formulation = formulation;
  return options;
}

SimulationOptions in_steps(Formulation formulation, double step, double end) {
  SimulationOptions options;
  options.formulation = formulation;
  options.integrator = IntegratorKind::classical;
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
/// may be a hundred times the positions.
TEST_P(LoopedScene, MovesTheSameInAllFormulations) {
  const auto [name, end] = GetParam();
  Simulated reference(scene(name), in(Formulation::minimal, 1e-11, end));
  reference.to(end);
  const double size = std::max(1.0, reference.state.v.lpNorm<Eigen::Infinity>());
  for (const Formulation formulation : {Formulation::projected, Formulation::baumgarte}) {
    Simulated run(scene(name), in(formulation, 1e-9, end));
    run.to(end);
    const double allowed = 100.0 * size * 1e-9 * static_cast<double>(run.simulation->summary().steps);
    EXPECT_LE((run.state.q - reference.state.q).lpNorm<Eigen::Infinity>(), allowed);
    EXPECT_LE((run.state.v - reference.state.v).lpNorm<Eigen::Infinity>(), size * allowed);
    // What is shown is closed, whatever drifted.
    Equations equations(*run.built);
    ASSERT_TRUE(equations.evaluate(run.state.q, end));
    EXPECT_LE(equations.error(), 1e-13);
  }
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
    EXPECT_NEAR(std::log2(error(1.0 / 64) / error(1.0 / 128)), 4.0, 0.6)
        << formulations()[static_cast<std::size_t>(formulation)].name;
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
  EXPECT_EQ(simulation_options("baumgarte", "cvode", 0.0, 0.0, scene)->formulation, Formulation::baumgarte);
}

}  // namespace
}  // namespace koppel::test
