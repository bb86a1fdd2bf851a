// Ranks and null spaces of many loops, by elimination, are those that singular values tell.
#include "closure/rank.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "closed.hpp"
#include "closure/analysis.hpp"
#include "closure/decompositions.hpp"
#include "closure/factorisation.hpp"
#include "row_of_four_bars.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// The Jacobian of a row of four-bars, in a position that is not square.
class ManyLoops : public testing::Test {
 protected:
  ManyLoops() : row_(row_of_four_bars(100)) {
    // Couplers stay as they are, whatever turn the bars take.
    for (std::size_t i = 0; i < row_.built->coordinate_names.size(); ++i) {
      const bool coupler = row_.built->coordinate_names[i].name.rfind("coupler", 0) == 0;
      row_.state.q[static_cast<Eigen::Index>(i)] = coupler ? -0.4 : 0.4;
    }
    EXPECT_GE(row_.close(), 0);
    EXPECT_TRUE(row_.work.equations.evaluate(row_.state.q, 0.0));
    row_.work.equations.evaluate_jacobian();
  }
  const Eigen::SparseMatrix<double>& jacobian() const { return row_.work.equations.jacobian; }

  Closed row_;
};

TEST_F(ManyLoops, HaveTheRankOfTheirSingularValues) {
  ASSERT_GT(jacobian().cols(), largest_dense);
  const Eigen::VectorXd values = Eigen::BDCSVD<Eigen::MatrixXd>(Eigen::MatrixXd(jacobian())).singularValues();
  const Rank rank = rank_of(jacobian());
  EXPECT_EQ(rank.rank, jacobian().cols() - 1);
  EXPECT_EQ(rank.rank, (values.array() > rank_tolerance(jacobian().rows(), jacobian().cols(), values[0])).count());
  // The smallest is estimated from above, by few iterations, the greatest from below.
  EXPECT_GE(rank.smallest, (1.0 - 1e-9) * values[rank.rank - 1]);
  EXPECT_LE(rank.smallest, 2.0 * values[rank.rank - 1]);
  EXPECT_LE(rank.largest, (1.0 + 1e-9) * values[0]);
  EXPECT_GE(rank.largest, 0.5 * values[0]);
  EXPECT_LE(rank.next, rank_tolerance(jacobian().rows(), jacobian().cols(), values[0]));
}

TEST_F(ManyLoops, HaveMotionsThatLeaveThemClosed) {
  const NullSpaces spaces = null_spaces_of(jacobian());
  ASSERT_EQ(spaces.motions.cols(), 1);
  // Rounding of one elimination, in rows of entries of one over few columns each.
  EXPECT_LE((jacobian() * spaces.motions).lpNorm<Eigen::Infinity>(),
            1e3 * eps * spaces.motions.lpNorm<Eigen::Infinity>());
}

TEST_F(ManyLoops, HaveStressesThatLoadNothing) {
  const NullSpaces spaces = null_spaces_of(jacobian());
  ASSERT_EQ(spaces.stresses.cols(), jacobian().rows() - spaces.rank);
  const Eigen::MatrixXd stresses = spaces.stresses;
  EXPECT_LE((jacobian().transpose() * stresses).lpNorm<Eigen::Infinity>(), 1e3 * eps);
  EXPECT_LE((stresses.colwise().norm().array() - 1.0).abs().maxCoeff(), 4.0 * eps);
  EXPECT_EQ(Eigen::ColPivHouseholderQR<Eigen::MatrixXd>(stresses).rank(), stresses.cols());
}

TEST_F(ManyLoops, AreAnalysed) {
  Analysis analysis;
  ASSERT_TRUE(analyse(row_.work, row_.state, analysis));
  EXPECT_EQ(analysis.mobility_rank, 1);
  EXPECT_GT(analysis.gap, 1e6);
}

}  // namespace
}  // namespace koppel::test
