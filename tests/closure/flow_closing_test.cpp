// Closing by the solution flow: it agrees with Newton's method and Ceres, finds what they miss, and knows what cannot
// be closed.
#include "closure/flow_closing.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "closed.hpp"

namespace koppel::test {
namespace {

class Scene : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(FlowClosing, Scene, testing::ValuesIn(closed_form_scenes),
                         [](const auto& test) { return std::string("scene_") + test.param; });

TEST_P(Scene, ClosesAlikeByFlowNewtonAndCeres) {
  Closed by_newton(shipped(GetParam())), by_ceres(shipped(GetParam())), by_flow(shipped(GetParam()));
  CloseOptions options;
  options.method = Method::newton;
  ASSERT_GE(by_newton.close(options), 0);
  options.method = Method::ceres;
  ASSERT_GE(by_ceres.close(options), 0);
  // From beside the position that the others have found, so that it is the nearest.
  by_flow.state.q = by_newton.state.q;
  for (const StateBlock& block : by_flow.built->blocks) {
    if (block.kind == BlockKind::angle) by_flow.state.q[block.q] += 0.01;
  }
  options.method = Method::flow;
  ASSERT_GE(by_flow.close(options), 0);
  EXPECT_EQ(by_flow.report.solver, SolverUsed::flow);
  Eigen::VectorXd delta(by_newton.built->nv);
  // Rounding times the condition of the position. Isolated freedoms are where they were.
  const double allowed = 1e-13 * by_newton.report.condition;
  difference(*by_newton.built, by_newton.state.q, by_ceres.state.q, delta);
  if (by_newton.report.rank == by_newton.built->unknowns) {
    EXPECT_LE(delta.lpNorm<Eigen::Infinity>(), allowed);
    difference(*by_newton.built, by_newton.state.q, by_flow.state.q, delta);
    EXPECT_LE(delta.lpNorm<Eigen::Infinity>(), allowed);
  }
  EXPECT_LE(by_flow.residual(), 1e-13);
}

TEST(FlowClosing, SaysUnreachableWhereThereIsNoPosition) {
  // A four-bar whose coupler is too short to span from the crank to the rocker, wherever they are.
  Closed four_bar(shipped("4bar", {{"coupler = 0.35 ", "coupler = 0.01 "}}));
  EXPECT_EQ(four_bar.close(), KOPPEL_NOT_CLOSED);
  EXPECT_EQ(four_bar.report.verdict, Verdict::unreachable);
  // The spatial one beyond its limit at 40.333054067 degrees.
  Closed spatial(shipped("rstr", {{"crank = 0.10 ", "crank = 0.30 "}}));
  spatial.state.input[0] = 0.7;  // 40.1 degrees
  const State before = spatial.state;
  EXPECT_EQ(spatial.close(), KOPPEL_NOT_CLOSED);
  EXPECT_EQ(spatial.report.verdict, Verdict::unreachable);
  EXPECT_TRUE(same_bits(before, spatial.state));
}

TEST(FlowClosing, IsNotCertainWithoutAFlow) {
  // A ball and a rod of fixed length between points too far apart; the screw beside them leaves no flow.
  Closed screws(
      "[scene]\nlength = 1\n[[body]]\nname = 'nut'\n[[body]]\nname = 'rod'\n"
      "[[joint]]\nname = 'screw'\ntype = 'helical'\npitch = 0.1\ninlet = 'ground'\noutlet = 'nut'\n"
      "[[joint]]\nname = 'ball'\ntype = 'spherical'\ninlet = { on = 'nut', at = [0.1, 0, 0] }\noutlet = 'rod'\n"
      "[[joint]]\nname = 'end'\ntype = 'spherical'\ninlet = { on = 'rod', at = [0.2, 0, 0] }\n"
      "outlet = { on = 'ground', at = [5, 0, 0] }\n"
      "[[drive]]\nof = 'screw.angle'\ntype = 'constant'\nvalue = 0\n");
  ASSERT_EQ(screws.close(), KOPPEL_NOT_CLOSED);
  EXPECT_EQ(screws.report.verdict, Verdict::not_found);
}

/// From anywhere: where Newton's method and Ceres give up, the flow does not.
TEST(FlowClosing, ClosesFromAnyStart) {
  Random random(4);
  for (const char* scene : {"4bar", "rstr", "rscr", "chain", "6r_pose", "3rpr"}) {
    Closed closed(shipped(scene));
    const Eigen::VectorXd start = closed.state.q;
    for (int i = 0; i < 200; ++i) {
      closed.state.stage = Stage::assigned;
      closed.state.q = random_position(*closed.built, random, 3.0);
      ASSERT_GE(closed.close(), 0) << scene << ", start " << i;
      EXPECT_LE(closed.report.residual, 1e-13);
    }
  }
}

/// Simbody's issue 162: a joint turned by half a turn satisfies conditions with products of axes, and is not closed.
TEST(Complaints, ClosedWronglyAtHalfATurn) {
  Closed closed(shipped("4bar"));
  ASSERT_GE(closed.close(), 0);
  closed.state.stage = Stage::assigned;
  // Turned over about an axis in the plane, the rocker's pin would have parallel axes that point the wrong way.
  closed.state.q[closed.built.coordinate("rocker_pin.angle")] += 3.14159;
  ASSERT_GE(closed.close(), 0);
  EXPECT_LE(closed.residual(), 1e-13);
  Closed spherical(shipped("sph4"));
  for (int half = 0; half < 8; ++half) {
    spherical.state.stage = Stage::assigned;
    spherical.state.q.setConstant(3.14159265358979 * half / 4.0);
    ASSERT_GE(spherical.close(), 0) << half;
    EXPECT_LE(spherical.residual(), 1e-13) << half;
  }
}

}  // namespace
}  // namespace koppel::test
