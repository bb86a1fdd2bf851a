// Sparse elimination against dense algebra: on random rows, with rows that follow from others, and at values other than
// those at which the pivots were chosen.
#include "closure/elimination.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "closure/decompositions.hpp"

namespace koppel {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// Loops in a row: each has rows in its own columns and in one that it shares with the next; `drives` columns at the
/// end stand in every third row. Every loop has a row that is the sum of its others.
struct Rows {
  explicit Rows(unsigned seed, std::uint32_t loops = 6, std::uint32_t drives = 2) : random(seed) {
    constexpr std::uint32_t own = 3, rows = 3;  // one more follows from them
    choosable = loops * own + 1;
    pattern.columns = choosable + drives;
    pattern.first.push_back(0);
    for (std::uint32_t loop = 0; loop < loops; ++loop) {
      for (std::uint32_t row = 0; row <= rows; ++row) {
        for (std::uint32_t c = 0; c <= own; ++c) pattern.column.push_back(loop * own + c);
        for (std::uint32_t d = 0; d < drives; ++d) pattern.column.push_back(choosable + d);
        pattern.first.push_back(static_cast<std::uint32_t>(pattern.column.size()));
      }
    }
    rank = loops * rows;
    scale.assign(pattern.columns, 1.0);
    draw();
  }

  void draw() {
    std::uniform_real_distribution<double> entry(-1.0, 1.0);
    values.assign(pattern.column.size(), 0.0);
    dense.setZero(pattern.rows(), pattern.columns);
    for (std::uint32_t row = 0; row < pattern.rows(); ++row) {
      const std::uint32_t width = pattern.first[row + 1] - pattern.first[row];
      for (std::uint32_t k = 0; k < width; ++k) {
        double& value = values[pattern.first[row] + k];
        if (row % 4 < 3) {
          value = entry(random);
        } else {
          for (std::uint32_t above = row - 3; above < row; ++above) value += values[pattern.first[above] + k];
        }
        dense(row, pattern.column[pattern.first[row] + k]) = value;
      }
    }
  }

  /// Of the dependent columns in the rows that were kept: the condition on which all errors depend.
  double condition(const Elimination& elimination) const {
    Eigen::MatrixXd kept(elimination.rank(), elimination.rank());
    Eigen::Index i = 0;
    for (std::uint32_t row = 0; row < pattern.rows(); ++row) {
      const auto& out = elimination.left_out();
      if (std::find(out.begin(), out.end(), row) != out.end()) continue;
      for (std::uint32_t k = 0; k < elimination.rank(); ++k) kept(i, k) = dense(row, elimination.dependent()[k]);
      ++i;
    }
    const Eigen::VectorXd singular = kept.jacobiSvd().singularValues();
    return singular[0] / singular[singular.size() - 1];
  }

  std::mt19937 random;
  RowPattern pattern;
  std::uint32_t choosable = 0, rank = 0;
  std::vector<double> values, scale;
  Eigen::MatrixXd dense;
};

struct RandomRows : testing::TestWithParam<unsigned> {
  Rows rows{GetParam()};
  Elimination elimination{rows.pattern, rows.choosable};

  void SetUp() override {
    elimination.choose(rows.values, rows.scale, 1e-9);
    rows.draw();  // pivots must serve other values too
    ASSERT_GT(elimination.factorise(rows.values), 0.0);
    // Backward errors of elimination grow with the number of rows; pivots are at least a tenth of their rows.
    tolerance = 100.0 * rows.rank * eps * rows.condition(elimination);
  }
  double tolerance = 0.0;
};

TEST_P(RandomRows, LeaveOutWhatFollows) {
  EXPECT_EQ(elimination.rank(), rows.rank);
  EXPECT_EQ(elimination.left_out().size(), rows.pattern.rows() - rows.rank);
  EXPECT_EQ(elimination.independent().size(), rows.choosable - rows.rank);
  for (const std::uint32_t column : elimination.dependent()) EXPECT_LT(column, rows.choosable);
}

TEST_P(RandomRows, TransferSolvesAllRows) {
  Elimination::Transfer k(rows.pattern.columns, elimination.independent().size());
  elimination.transfer(k);
  EXPECT_LE((rows.dense * k).cwiseAbs().maxCoeff(), tolerance * std::max(1.0, k.cwiseAbs().maxCoeff()));
  for (std::size_t i = 0; i < elimination.independent().size(); ++i) {
    EXPECT_EQ(k.row(elimination.independent()[i]), Eigen::RowVectorXd::Unit(k.cols(), static_cast<Eigen::Index>(i)));
  }
}

TEST_P(RandomRows, SolveMeetsRightHandSidesThatFit) {
  const Eigen::VectorXd wanted = Eigen::VectorXd::Random(rows.pattern.columns);
  const Eigen::VectorXd b = rows.dense * wanted;
  Eigen::VectorXd x = wanted;
  for (const std::uint32_t column : elimination.dependent()) x[column] = 7.0;  // must be overwritten
  elimination.solve(b, x);
  EXPECT_LE((x - wanted).cwiseAbs().maxCoeff(), tolerance * (1.0 + b.cwiseAbs().maxCoeff()));
}

TEST_P(RandomRows, MultipliersBalanceTheDependentColumns) {
  const Eigen::VectorXd c = Eigen::VectorXd::Random(rows.pattern.columns);
  Eigen::VectorXd multipliers(rows.pattern.rows());
  elimination.solve_transposed(c, multipliers);
  const Eigen::VectorXd balance = rows.dense.transpose() * multipliers - c;
  const double size = 1.0 + multipliers.cwiseAbs().maxCoeff();
  for (const std::uint32_t column : elimination.dependent()) EXPECT_LE(std::abs(balance[column]), tolerance * size);
  for (const std::uint32_t row : elimination.left_out()) EXPECT_EQ(multipliers[row], 0.0);
}

INSTANTIATE_TEST_SUITE_P(Dynamics, RandomRows, testing::Range(1u, 21u));

TEST(Elimination, TellsThatAPivotVanishes) {
  RowPattern pattern{3, {0, 3}, {0, 1, 2}};
  Elimination elimination(pattern, 3);
  elimination.choose({1.0, 0.5, 0.25}, {1.0, 1.0, 1.0}, 1e-9);
  ASSERT_EQ(elimination.rank(), 1u);
  const std::uint32_t pivot = elimination.dependent()[0];
  std::vector<double> values{1.0, 1.0, 1.0};
  values[pivot] = 1e-3;
  EXPECT_NEAR(elimination.factorise(values), 1e-3, eps);
  values[pivot] = 0.0;
  EXPECT_EQ(elimination.factorise(values), 0.0);
  values[pivot] = std::nan("");
  EXPECT_EQ(elimination.factorise(values), 0.0);
}

TEST(Elimination, HasNothingToSolveWithoutRows) {
  Elimination elimination(RowPattern{4, {0}, {}}, 3);
  elimination.choose({}, {1.0, 1.0, 1.0, 1.0}, 1e-9);
  EXPECT_EQ(elimination.rank(), 0u);
  EXPECT_EQ(elimination.independent(), (std::vector<std::uint32_t>{0, 1, 2}));
  Elimination::Transfer k(4, 3);
  elimination.transfer(k);
  EXPECT_TRUE(k.topRows(3).isIdentity(0.0));
  EXPECT_TRUE(k.row(3).isZero(0.0));
}

}  // namespace
}  // namespace koppel
