// Every shipped scene goes through the whole of its own run.
#include <gtest/gtest.h>

#include "model.hpp"

namespace koppel::test {
namespace {

struct WholeRun : testing::TestWithParam<std::string> {
  const Model model{shipped_scene(GetParam())};
};

TEST_P(WholeRun, ClosesToRoundingAndMovesAtEveryStep) {
  Motion motion(model);
  for (std::size_t i = 0; i <= model.settings().steps; ++i) {
    const Outcome outcome = motion.move(model.time(i));
    ASSERT_TRUE(outcome) << "step " << i << ": " << outcome.message;
    EXPECT_EQ(outcome.report.verdict, model.sizes().equations > 0 ? KOPPEL_VERDICT_CLOSED : KOPPEL_VERDICT_OPEN);
    EXPECT_LT(outcome.report.residual, 1e-13) << "step " << i;
    EXPECT_TRUE(motion.velocities().allFinite() && motion.accelerations().allFinite()) << "step " << i;
  }
}

TEST_P(WholeRun, NeverChangesTheBranch) {
  Motion motion(model);
  for (std::size_t i = 0; i <= model.settings().steps; ++i) {
    EXPECT_EQ(motion.move(model.time(i)).status & KOPPEL_BRANCH_CHANGED, 0) << "step " << i;
  }
}

// Assembled anew at the last position of the run, with the end of the run as start, the state stands where it was.
TEST_P(WholeRun, EndsWhereItCouldHaveBeenAssembled) {
  Motion motion(model);
  motion.run_to(model.settings().steps);
  const Eigen::VectorXd q = motion.positions();
  motion.set_positions(q);
  const Outcome outcome = motion.close();
  ASSERT_TRUE(outcome) << outcome.message;
  // Both are closed; they differ by no more than either may be wrong.
  const double allowed = 4.0 * outcome.report.coordinate_error * std::max(1.0, model.settings().length);
  EXPECT_LE((motion.positions() - q).lpNorm<Eigen::Infinity>(), allowed);
}

INSTANTIATE_TEST_SUITE_P(Scenes, WholeRun, testing::ValuesIn(shipped_scenes()),
                         [](const auto& test) { return test_name(test.param); });

}  // namespace
}  // namespace koppel::test
