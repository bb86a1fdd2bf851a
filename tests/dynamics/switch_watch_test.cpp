// Kinks and jumps of forces: steps end there, so that methods keep their order and their errors the tolerance.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "simulated.hpp"

namespace koppel::test {
namespace {

/// 1 kg falls from rest at a height of h = 1 m onto an elastic stop at 0 and comes back up.
constexpr double stiffness = 1e4, gravity = 10.0;
const char* const ball =
    "[scene]\ngravity = [0, 0, -10]\nlength = 1\n"
    "[[body]]\nname = 'ball'\nmass = 1\n"
    "[[joint]]\nname = 'way'\ntype = 'prismatic'\ninlet = { on = 'ground', axis = [0, 0, 1] }\n"
    "outlet = { on = 'ball', axis = [0, 0, 1] }\nstart = { displacement = 1 }\n";
const std::string bouncing =
    std::string(ball) +
    "[[force]]\nname = 'floor'\ntype = 'stop'\nof = 'way.displacement'\nlower = 0\nstiffness = 10000\n";

/// The height after t, pieced together: parabolas above the stop, and below it x'' = -g - k x from 0 at -v.
double height(double t) {
  const double w = std::sqrt(stiffness), v = std::sqrt(2 * gravity), fall = v / gravity, rest = -gravity / stiffness;
  // x = rest - rest cos(w s) - v / w sin(w s) is 0 again where tan(w s / 2) = -v / (w rest), past a quarter.
  const double contact = 2 / w * (std::acos(-1.0) - std::atan2(v / w, -rest));
  const double s = std::fmod(t + fall, 2 * fall + contact);  // since it last left the stop
  if (s < 2 * fall) return v * s - gravity * s * s / 2;
  const double c = s - 2 * fall;
  return rest - rest * std::cos(w * c) - v / w * std::sin(w * c);
}

/// At the top of the parabola after ten contacts: an error in the times of contacts shows as v times as much in height.
constexpr double end = 5.0;

/// Errors of steps are within the tolerance each; a velocity that is off shifts what follows, by less than t of it.
TEST(SwitchWatch, ABallBouncesWithinTheTolerance) {
  for (const IntegratorKind kind :
       {IntegratorKind::dormand_prince, IntegratorKind::dop853, IntegratorKind::cvode, IntegratorKind::arkode}) {
    for (const double tolerance : {1e-6, 1e-9}) {
      Simulated run(bouncing, by(kind, tolerance, 0.0, end));
      run.to(end);
      const SimulationSummary& summary = run.simulation->summary();
      EXPECT_EQ(summary.events, 10u) << "five contacts, with two ends each";
      const double decade = kind == IntegratorKind::cvode ? 100.0 : 10.0;
      EXPECT_NEAR(run.q("way.displacement"), height(end),
                  decade * end * std::sqrt(2 * gravity) * tolerance * static_cast<double>(summary.steps));
    }
  }
}

/// Fixed steps, which end anywhere beside the kinks: still of order 4. Without events it would be 2 here.
TEST(SwitchWatch, KinksDoNotCostTheOrder) {
  const auto error = [](double step) {
    Simulated run(bouncing, by(IntegratorKind::classical, 0.0, step, end));
    double greatest = 0.0;
    for (int i = 1; i <= 10; ++i) {
      run.to(0.5 * i);
      greatest = std::max(greatest, std::abs(run.q("way.displacement") - height(0.5 * i)));
    }
    return greatest;
  };
  const double slope = std::log2(error(1.0 / 500) / error(1.0 / 2000)) / 2;
  EXPECT_GT(slope, 3.5);
}

TEST(SwitchWatch, FreeMotionHasNoEvents) {
  Simulated run(bouncing, by(IntegratorKind::dormand_prince, 1e-8, 0.0, 0.4));
  run.to(0.4);
  EXPECT_EQ(run.simulation->summary().events, 0u);
  EXPECT_NEAR(run.q("way.displacement"), 1 - gravity * 0.16 / 2, 1e-12);
}

TEST(SwitchWatch, RowsDoNotChangeTheMotion) {
  Simulated once(bouncing, by(IntegratorKind::dop853, 1e-8, 0.0, end));
  Simulated often(bouncing, by(IntegratorKind::dop853, 1e-8, 0.0, end));
  once.to(end);
  for (int i = 1; i <= 500; ++i) {
    often.to(end * i / 500);
    EXPECT_NEAR(often.q("way.displacement"), height(end * i / 500), 1e-5);
  }
  EXPECT_EQ(once.q("way.displacement"), often.q("way.displacement"));
  EXPECT_EQ(once.simulation->summary().steps, often.simulation->summary().steps);
}

}  // namespace
}  // namespace koppel::test
