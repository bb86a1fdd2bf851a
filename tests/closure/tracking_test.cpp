// Following a closed mechanism: large steps, dead centres, redundancy, limits, extrapolation.
#include <numbers>

#include <gtest/gtest.h>

#include "closed.hpp"
#include "closure/analysis.hpp"

namespace koppel::test {
namespace {

constexpr double degree = std::numbers::pi / 180;

const Replacements long_crank{{"crank = 0.10", "crank = 0.30"},
                              {"slope = \"360 deg\"", "start = \"100 deg\"\nslope = \"10 deg\""}};

TEST(LargeStep, IsLedInSmallerOnesAndStaysOnTheBranch) {
  for (const double jump : {0.5, 1.0, 2.0, -2.5}) {
    Closed by_jump(shipped("rstr")), by_steps(shipped("rstr"));
    ASSERT_GE(by_jump.close(), 0);
    ASSERT_GE(by_steps.close(), 0);
    by_jump.state.input[0] += jump;
    EXPECT_EQ(by_jump.close(), KOPPEL_OK) << jump;
    for (int i = 0; i < 250; ++i) {
      by_steps.state.input[0] += jump / 250;
      ASSERT_EQ(by_steps.close(), KOPPEL_OK);
    }
    by_steps.state.input[0] = by_jump.state.input[0];
    ASSERT_EQ(by_steps.close(), KOPPEL_OK);
    EXPECT_LE((by_jump.state.q - by_steps.state.q).norm(), 1e-11) << jump;
  }
}

TEST(DeadCentre, StopsTheDriveAndLeavesTheStateUntouched) {
  Closed closed(shipped("rstr", long_crank));
  double time = 0;
  for (; time <= 6.9; time += 0.1) ASSERT_EQ(closed.move(time), KOPPEL_OK) << time;  // up to 169 deg
  const State before = closed.state;
  EXPECT_EQ(closed.move(6.96), KOPPEL_NOT_CLOSED);  // 169.6 deg; the end is at 169.4868 deg
  EXPECT_GT(closed.report.residual, 1e-10);
  EXPECT_TRUE(same_bits(closed.state, before));
  EXPECT_EQ(closed.move(8.0), KOPPEL_NOT_CLOSED);
  EXPECT_TRUE(same_bits(closed.state, before));
  EXPECT_EQ(closed.move(6.9), KOPPEL_OK) << "the way back is open";
}

TEST(DeadCentre, IsReachedToWithinAHairsBreadth) {
  Closed closed(shipped("rstr", long_crank));
  ASSERT_EQ(closed.move(6.9), KOPPEL_OK);
  EXPECT_EQ(closed.move(6.94867) & ~KOPPEL_NEAR_SINGULAR, KOPPEL_OK);
  EXPECT_LE(closed.residual(), 1e-13);
  EXPECT_EQ(closed.move(6.94868), KOPPEL_NOT_CLOSED);
}

TEST(Redundancy, IsReportedAndCounted) {
  struct Known {
    std::string scene;
    std::uint32_t rank;
    std::int32_t count, mobility;
  };
  for (const Known& known : {Known{"4bar", 3, -2, 1}, Known{"bennett", 3, -2, 1}, Known{"sph4", 3, -2, 1},
                             Known{"7b10j", 9, -8, 1}, Known{"slidercrank", 3, -2, 1}}) {
    Closed closed(shipped(known.scene));
    ASSERT_GE(closed.move(0.05), 0) << known.scene;
    EXPECT_NE(closed.close() & KOPPEL_REDUNDANT, 0) << known.scene;
    EXPECT_LE(closed.residual(), 1e-13);
    Analysis analysis;
    ASSERT_TRUE(analyse(closed.work, closed.state, analysis));
    EXPECT_EQ(analysis.mobility_count, known.count) << known.scene;
    EXPECT_EQ(analysis.mobility_rank, known.mobility) << known.scene;
    // Freedoms of cut joints are no columns: each takes a rank of its own with it.
    std::uint32_t at_cuts = 0;
    for (std::uint32_t i = 0; i < closed.built->loops; ++i) {
      const Relation& loop = closed.built->relations[i];
      if (loop.kind == RelationKind::cut_joint) at_cuts += closed.built->joints[loop.joint.index()].nv;
    }
    EXPECT_EQ(analysis.rank + at_cuts, known.rank) << known.scene;
    EXPECT_GT(analysis.gap, 1e8) << known.scene;
  }
}

TEST(Redundancy, IsNotReportedWhereThereIsNone) {
  Closed closed(shipped("rstr"));
  EXPECT_EQ(closed.close(), KOPPEL_OK);
  EXPECT_EQ(closed.report.rank, closed.built->rows);
}

TEST(Limits, AreReportedAndNotEnforced) {
  Closed closed(shipped("rstr", {{"start = { angle = \"71.8 deg\" }",
                                  "start = { angle = \"71.8 deg\" }\nlimits = { angle = [0, \"73 deg\"] }"}}));
  ASSERT_EQ(closed.close(), KOPPEL_OK);
  koppel_status status = KOPPEL_OK;
  for (int i = 1; i <= 30 && status == KOPPEL_OK; ++i) status = closed.move(0.01 * i);
  EXPECT_EQ(status, KOPPEL_LIMIT_EXCEEDED);
  EXPECT_GT(closed.at("rocker.angle"), 73 * degree);
  EXPECT_EQ(limits_exceeded(*closed.built, closed.state), std::vector<std::string>{"rocker.angle"});
}

/// Newton iterations over a run; without extrapolation each step starts from the last position.
std::uint32_t iterations_of_a_run(const std::string& scene, bool extrapolate) {
  Closed closed(shipped(scene));
  std::uint32_t sum = 0;
  for (int i = 0; i <= 100; ++i) {
    if (extrapolate) {
      EXPECT_GE(closed.move(i * 2e-3), 0);
    } else {
      EXPECT_EQ(set_time(*closed.built, i * 2e-3, closed.state), nullptr);
      EXPECT_GE(closed.close(), 0);
    }
    if (i > 0) sum += closed.report.iterations;
  }
  return sum;
}

TEST(Extrapolation, SavesIterations) {
  for (const std::string scene : {"rstr", "multilink", "4bar", "stewart"}) {
    const std::uint32_t with = iterations_of_a_run(scene, true), without = iterations_of_a_run(scene, false);
    EXPECT_LE(4 * with, 3 * without) << scene << ": " << with << " and " << without;
  }
}

TEST(SameInput, MakesTheSameBits) {
  Closed one(shipped("multilink")), other(shipped("multilink"));
  for (int i = 0; i < 50; ++i) {
    ASSERT_EQ(one.move(0.01 * i), other.move(0.01 * i));
    ASSERT_TRUE(same_bits(one.state, other.state));
  }
  // All history that matters is in the state: another's work continues just the same.
  Closed third(shipped("multilink"));
  third.state = one.state;
  ASSERT_EQ(one.move(0.505), third.move(0.505));
  EXPECT_TRUE(same_bits(one.state, third.state));
}

}  // namespace
}  // namespace koppel::test
