// Newton's method near a closed position, and where there is none.
#include "closure/newton.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "closed.hpp"

namespace koppel::test {
namespace {

// Each error is at most a constant times the square of the one before, down to rounding.
TEST(Newton, ConvergesQuadratically) {
  for (const std::string scene : {"rstr", "rscr", "5link", "stewart", "multilink"}) {
    Closed closed(shipped(scene));
    ASSERT_GE(closed.close(), 0) << scene;
    Work& work = closed.work;
    Random random(41);
    work.delta = 0.02 * random_rates(work.delta.size(), random);
    for (const Input& input : closed.built->inputs) work.delta[input.v] = 0;
    integrate(*closed.built, closed.state.q, work.delta, work.q);
    ASSERT_TRUE(work.equations.evaluate(work.q, 0));
    double before = work.equations.error();
    int steps = 0;
    for (; before > 1e-13 && steps < 8; ++steps) {
      (void)newton(work, 0, {1, 1e-15, InputsAre::held});
      const double after = work.equations.error();
      EXPECT_LE(after, 20 * before * before + 1e-14) << scene << ", step " << steps;
      before = after;
    }
    EXPECT_LE(steps, 5) << scene;
    EXPECT_LE(before, 1e-13) << scene;
  }
}

const char* const turned_weld =
    "[scene]\nlength = 1\n[[body]]\nname = 'b'\n[[joint]]\nname = 'hinge'\ntype = 'revolute'\ninlet = 'ground'\noutlet "
    "= 'b'\n"
    "[[joint]]\nname = 'weld'\ntype = 'weld'\ninlet = 'b'\noutlet = 'ground'\n";

TEST(WeldedLoop, TurnedByHalfATurnIsNotClosed) {
  Closed closed(turned_weld + std::string("[[drive]]\nof = 'hinge.angle'\ntype = 'constant'\nvalue = '180 deg'\n"));
  const State before = closed.state;
  EXPECT_EQ(closed.close(), KOPPEL_NOT_CLOSED);
  EXPECT_EQ(closed.report.verdict, Verdict::unreachable);
  EXPECT_NEAR(closed.report.residual, std::numbers::pi, 1e-12);
  EXPECT_TRUE(same_bits(closed.state, before));
}

TEST(WeldedLoop, FindsItsWayBackFromHalfATurn) {
  Closed closed(turned_weld);
  closed.state.q[0] = std::numbers::pi;
  EXPECT_EQ(closed.close(), KOPPEL_REDUNDANT);
  EXPECT_NEAR(std::remainder(closed.state.q[0], 2 * std::numbers::pi), 0, 1e-13);
}

// The cut joint keeps an axis that starts upside down: there the direction of the way back is anybody's.
TEST(UpsideDownLoop, FindsItsWayBack) {
  for (const double start : {std::numbers::pi, std::numbers::pi - 1e-9, std::numbers::pi - 1e-5}) {
    Closed closed(
        "[scene]\nlength = 1\n[[body]]\nname = 'b'\n[[joint]]\nname = 'hinge'\ntype = 'revolute'\n"
        "inlet = { on = 'ground', rotate = [['x', '90 deg']] }\noutlet = { on = 'b', rotate = [['x', '90 deg']] }\n"
        "[[joint]]\nname = 'tube'\ntype = 'cylindrical'\ninlet = 'ground'\noutlet = 'b'\n");
    ASSERT_EQ(closed.built->relations[0].rows, 4u);
    closed.state.q[closed.built.coordinate("hinge.angle")] = start;
    EXPECT_EQ(closed.close(), KOPPEL_REDUNDANT) << start;
    EXPECT_NEAR(std::remainder(closed.at("hinge.angle"), 2 * std::numbers::pi), 0, 1e-13);
  }
}

TEST(ImpossibleLoop, IsNotClosedAndLeavesTheStateUntouched) {
  const std::string text = shipped("4bar", {{"rocker = 0.25", "rocker = 0.05"}});  // 0.4 > 0.12 + 0.05 + ...: too short
  Closed closed(replaced(text, "coupler = 0.35", "coupler = 0.15"));
  const State before = closed.state;
  for (const Method method : {Method::automatic, Method::ceres, Method::newton}) {
    CloseOptions options;
    options.method = method;
    EXPECT_EQ(closed.close(options), KOPPEL_NOT_CLOSED);
    EXPECT_GT(closed.report.residual, 0.1);
    EXPECT_TRUE(same_bits(closed.state, before));
  }
}

}  // namespace
}  // namespace koppel::test
