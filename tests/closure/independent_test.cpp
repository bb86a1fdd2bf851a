// The choice of independent coordinates, and when it is left for another.
#include "closure/independent.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "closure/passage.hpp"
#include "four_bar.hpp"

namespace koppel::test {
namespace {

TEST(Independent, AreAsManyAsThereAreFreedoms) {
  struct Known {
    std::string scene;
    std::size_t freedoms;
  };
  for (const Known& known : {Known{"rstr", 1}, Known{"4bar", 1}, Known{"sar", 2}, Known{"stewart", 6},
                             Known{"6joint", 3}, Known{"arm2", 2}}) {
    Closed closed(shipped(known.scene));
    ASSERT_GE(closed.move(0.1), 0) << known.scene;
    IndependentSet set;
    ASSERT_TRUE(choose_independent(closed.work, closed.state, set));
    EXPECT_EQ(set.rates.size(), known.freedoms) << known.scene;
    EXPECT_GT(set.quality, poor_quality) << known.scene;
  }
}

// The crank's angle is a good one until the dead centre is near; there another takes its place, and stays.
TEST(Independent, IsSwitchedBesideADeadCentreOnceForEach) {
  Closed closed(long_crank("100 deg", "71.8 deg", "10 deg"));
  ASSERT_GE(closed.move(0), 0);
  IndependentSet set{{closed.built.joint("crank").v}, 0};
  bool switched = false;
  int switches = 0;
  std::uint32_t limits = 0;
  for (int i = 0; i < 3000; ++i) {
    ASSERT_GE(follow(closed.work, closed.state, 0.02, 0, Branch::stay, closed.report), 0);
    limits += closed.report.limits;
    const std::uint32_t before = set.rates[0];
    ASSERT_TRUE(update_independent(closed.work, closed.state, set, switched));
    EXPECT_EQ(switched, set.rates[0] != before);
    ASSERT_EQ(set.rates.size(), 1u);
    EXPECT_GT(set.quality, 1e-5);
    switches += switched;
  }
  EXPECT_GE(limits, 2u);
  EXPECT_GE(switches, 1);
  EXPECT_LE(switches, static_cast<int>(limits));
}

TEST(Independent, AreKeptWhileTheyAreGoodAndWhereAllArePoor) {
  Closed closed(parallelogram);
  ASSERT_GE(closed.move(0.2), 0);
  IndependentSet set{{closed.built.joint("crank").v}, 0};
  bool switched = true;
  for (const double time : {0.5, 0.9, 0.999, 1.0, 1.001, 1.5}) {
    ASSERT_GE(closed.move(time), 0);
    ASSERT_TRUE(update_independent(closed.work, closed.state, set, switched));
    EXPECT_FALSE(switched) << time;
  }
}

}  // namespace
}  // namespace koppel::test
