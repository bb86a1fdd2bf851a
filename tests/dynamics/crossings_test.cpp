// Values that a simulation looks out for: times at which a pendulum passes them, against elliptic integrals.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "simulated.hpp"

namespace koppel::test {
namespace {

constexpr double released = 2.0;  // [rad] from the vertical, at rest
constexpr double tolerance = 1e-10;

/// A point on a rod of one metre, so that sqrt(g / l) is 1/s.
std::string pendulum(const std::string& watches) {
  return "[scene]\ngravity = [0, -1, 0]\nlength = 1\n"
         "[[body]]\nname = 'bob'\ntype = 'rigid'\nmass = 1\ncentre_of_mass = [0, -1, 0]\n"
         "[[joint]]\nname = 'pivot'\ntype = 'revolute'\ninlet = 'ground'\noutlet = 'bob'\nstart = { angle = 2 }\n" +
         watches;
}

/// A quarter of its period [s]: the complete elliptic integral of sin(released / 2).
double quarter() { return std::comp_ellint_1(std::sin(released / 2)); }

/// From rest until it passes an angle for the first time.
double time_to(double angle) {
  const double k = std::sin(released / 2);
  return quarter() - std::ellint_1(k, std::asin(std::sin(angle / 2) / k));
}

std::vector<Crossing> crossings(Simulated& run, double end) {
  std::vector<Crossing> all;
  for (;;) {
    const auto found = run.simulation->advance_watching(end, run.state);
    if (!found) throw std::runtime_error(koppel::render(found.error()));
    if (!*found) return all;
    EXPECT_EQ(run.state.time, (*found)->time);
    all.push_back(**found);
  }
}

/// Errors of steps add up, and shift times by as much over the rate, which is 1 to 2 rad/s.
double allowed(const Simulated& run) { return 4.0 * tolerance * static_cast<double>(run.simulation->summary().steps); }

const char* const lowest = "[[watch]]\nname = 'lowest'\nof = 'pivot.angle'\n";

TEST(Crossings, OfTheLowestPointAreHalfAPeriodApart) {
  for (const IntegratorKind kind :
       {IntegratorKind::dormand_prince, IntegratorKind::dop853, IntegratorKind::cvode, IntegratorKind::arkode}) {
    Simulated run(pendulum(lowest), by(kind, tolerance, 0.0, 40.0));
    const std::vector<Crossing> all = crossings(run, 40.0);
    ASSERT_EQ(all.size(), static_cast<std::size_t>((40.0 + quarter()) / (2 * quarter())));
    const double decade = kind == IntegratorKind::cvode ? 10.0 : 1.0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_NEAR(all[i].time, (2.0 * static_cast<double>(i) + 1.0) * quarter(), decade * allowed(run));
      EXPECT_EQ(all[i].rising, i % 2 == 1);
    }
  }
}

TEST(Crossings, AreFoundWhereTheValueLiesOnTheOtherSideByNoMoreThanRounding) {
  Simulated run(pendulum("[[watch]]\nof = 'pivot.angle'\nvalue = '30 deg'\ndirection = 'falling'\n"),
                by(IntegratorKind::dormand_prince, tolerance, 0.0, 10.0));
  const auto found = run.simulation->advance_watching(10.0, run.state);
  ASSERT_TRUE(found && *found);
  EXPECT_NEAR((*found)->time, time_to(pi / 6), allowed(run));
  EXPECT_LT(run.q("pivot.angle"), pi / 6);
  // The time is found to 4 units of rounding, the angle to as many of its rate and its own.
  EXPECT_GT(run.q("pivot.angle"), pi / 6 - 16 * eps * (1.0 + (*found)->time) * std::abs(run.v("pivot.angle")));
}

TEST(Crossings, OfARateAreTurningPoints) {
  Simulated run(pendulum("[[watch]]\nof = 'pivot.angle'\nquantity = 'rate'\ndirection = 'rising'\nname = 'turns'\n"),
                by(IntegratorKind::dormand_prince, tolerance, 0.0, 20.0));
  const std::vector<Crossing> all = crossings(run, 20.0);
  ASSERT_EQ(all.size(), static_cast<std::size_t>((20.0 + 2 * quarter()) / (4 * quarter())));
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_NEAR(all[i].time, (4.0 * static_cast<double>(i) + 2.0) * quarter(), allowed(run));
  }
}

TEST(Crossings, AtTheSameTimeAreAllFound) {
  Simulated run(pendulum("[[watch]]\nname = 'one'\nof = 'pivot.angle'\n[[watch]]\nname = 'other'\nof = 'pivot.angle'\n"
                         "[[watch]]\nname = 'late'\nof = 'pivot.angle'\nvalue = -0.1\n"),
                by(IntegratorKind::dormand_prince, tolerance, 0.0, 4.0));
  const std::vector<Crossing> all = crossings(run, 4.0);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].time, all[1].time);
  EXPECT_NE(all[0].watch, all[1].watch);
  EXPECT_EQ(all[2].watch, 2u);
  EXPECT_GT(all[2].time, all[1].time);
}

/// A value that is passed in the direction that is not looked for, and back between two looks.
TEST(Crossings, InTheOtherDirectionCountForThoseThatFollow) {
  Simulated run(pendulum(std::string(lowest) + "[[watch]]\nname = 'back'\nof = 'pivot.angle'\nvalue = 1.9\n"
                                               "direction = 'rising'\n"),
                by(IntegratorKind::dormand_prince, 1e-4, 0.0, 20.0));
  std::size_t rising = 0;
  for (const Crossing& crossing : crossings(run, 20.0)) rising += crossing.watch == 1;
  EXPECT_EQ(rising, static_cast<std::size_t>((20.0 + time_to(1.9)) / (4 * quarter())));
}

TEST(Crossings, LeaveTheMotionAsItIs) {
  for (const auto& [kind, step] : {std::pair{IntegratorKind::dormand_prince, 0.0},
                                   {IntegratorKind::cvode, 0.0},
                                   {IntegratorKind::arkode, 0.0},
                                   {IntegratorKind::classical, 1e-2},
                                   {IntegratorKind::semi_implicit, 1e-2}}) {
    const SimulationOptions how = by(kind, step > 0.0 ? 0.0 : 1e-8, step, 10.0);
    Simulated watched(pendulum(lowest), how), passed(pendulum(lowest), how);
    for (int i = 1; i <= 10; ++i) {
      crossings(watched, i);
      passed.to(i);
      EXPECT_EQ(watched.state.q, passed.state.q);
      EXPECT_EQ(watched.state.v, passed.state.v);
    }
    EXPECT_EQ(watched.simulation->summary().steps, passed.simulation->summary().steps);
  }
}

TEST(Crossings, GoOnFromACheckpoint) {
  Simulated run(pendulum(lowest), by(IntegratorKind::dop853, tolerance, 0.0, 10.0));
  const double before = quarter() - 0.1;
  EXPECT_TRUE(crossings(run, before).empty());
  const auto bytes = run.simulation->save();
  ASSERT_TRUE(bytes);
  auto loaded = Simulation::load(run.built.mechanism, *bytes);
  ASSERT_TRUE(loaded);
  const auto found = (*loaded)->advance_watching(10.0, run.state);
  ASSERT_TRUE(found && *found);
  EXPECT_NEAR((*found)->time, quarter(), allowed(run));
}

}  // namespace
}  // namespace koppel::test
