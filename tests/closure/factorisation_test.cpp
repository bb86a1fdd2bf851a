// Least-squares solutions of least norm and condition numbers, against Eigen's decompositions.
#include "closure/factorisation.hpp"

#include <gtest/gtest.h>

#include "../spatial/directions.hpp"
#include "closure/decompositions.hpp"
#include "closure/dense_factorisation.hpp"
#include "closure/orientation.hpp"
#include "closure/sparse_factorisation.hpp"

namespace koppel::test {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

Matrix random_matrix(Eigen::Index rows, Eigen::Index columns, Random& random) {
  return Matrix::NullaryExpr(rows, columns, [&](Eigen::Index, Eigen::Index) { return random.between(-1, 1); });
}

Matrix of_rank(Eigen::Index rows, Eigen::Index columns, Eigen::Index rank, Random& random) {
  return random_matrix(rows, rank, random) * random_matrix(rank, columns, random);
}

/// Orthogonal times singular values from 1 down to 1/condition times orthogonal.
Matrix graded(Eigen::Index rows, Eigen::Index columns, double condition, Random& random) {
  const Eigen::Index n = std::min(rows, columns);
  const Matrix u = random_matrix(rows, rows, random).householderQr().householderQ();
  const Matrix v = random_matrix(columns, columns, random).householderQr().householderQ();
  const Vector s = Vector::NullaryExpr(n, [&](Eigen::Index i) {
    return n == 1 ? 1.0 : std::pow(condition, -static_cast<double>(i) / static_cast<double>(n - 1));
  });
  return u.leftCols(n) * s.asDiagonal() * v.leftCols(n).transpose();
}

constexpr std::pair<Eigen::Index, Eigen::Index> shapes[] = {{1, 1},   {5, 3},   {3, 5},  {6, 6},
                                                            {30, 30}, {40, 12}, {12, 40}};

template <typename Kind>
class FactorisationOf : public testing::Test {};
using Kinds = testing::Types<DenseFactorisation, SparseFactorisation>;
TYPED_TEST_SUITE(FactorisationOf, Kinds);

TYPED_TEST(FactorisationOf, SolvesAsACompleteOrthogonalDecompositionDoes) {
  Random random(1);
  for (const auto& [rows, columns] : shapes) {
    TypeParam factorisation(rows, columns);
    Vector x(columns);
    for (Eigen::Index rank = 0; rank <= std::min(rows, columns); ++rank) {
      const Matrix a = rank == 0 ? Matrix(Matrix::Zero(rows, columns)) : of_rank(rows, columns, rank, random);
      const Vector b = random_matrix(rows, 1, random);
      factorisation.compute(a.sparseView());
      EXPECT_EQ(factorisation.rank(), rank) << rows << " x " << columns;
      Vector scratch = b;
      factorisation.solve(scratch, x);
      const Vector expected = a.completeOrthogonalDecomposition().solve(b);
      const Vector values = a.bdcSvd().singularValues();
      const double condition = rank == 0 ? 1 : values[0] / values[rank - 1];
      EXPECT_LE((x - expected).norm(), 1e-14 * condition * condition * (1 + expected.norm()))
          << rows << " x " << columns << " of rank " << rank;
    }
  }
}

// Of graded matrices the small residual matters: the error of x is eps times the condition number.
TYPED_TEST(FactorisationOf, SolvesConsistentSystemsToTheirCondition) {
  Random random(2);
  for (const double condition : {1e0, 1e3, 1e6, 1e9}) {
    for (const auto& [rows, columns] : shapes) {
      const Matrix a = graded(rows, columns, condition, random);
      const Vector known = a.transpose() * random_matrix(rows, 1, random);  // no part in the null space
      TypeParam factorisation(rows, columns);
      factorisation.compute(a.sparseView());
      Vector b = a * known, x(columns);
      factorisation.solve(b, x);
      EXPECT_LE((x - known).norm(), 1e-14 * condition * static_cast<double>(rows + columns));
    }
  }
}

TYPED_TEST(FactorisationOf, TakesMatricesWithoutRowsOrColumns) {
  for (const auto& [rows, columns] : {std::pair<Eigen::Index, Eigen::Index>{0, 4}, {4, 0}, {0, 0}}) {
    TypeParam factorisation(rows, columns);
    factorisation.compute(Matrix(rows, columns).sparseView());
    EXPECT_EQ(factorisation.rank(), 0);
    Vector b = Vector::Ones(rows), x = Vector::Ones(columns);
    factorisation.solve(b, x);
    EXPECT_EQ(x, Vector(Vector::Zero(columns)));
    EXPECT_EQ(factorisation.condition().ratio, 1);
    EXPECT_EQ(factorisation.condition().smallest, 0);
  }
}

TYPED_TEST(FactorisationOf, IsNotDisturbedByWhatItFactorisedBefore) {
  Random random(3);
  TypeParam factorisation(6, 9);
  for (int trial = 0; trial < 50; ++trial) {
    const Matrix a = of_rank(6, 9, 1 + trial % 6, random);
    const Vector b = random_matrix(6, 1, random);
    TypeParam fresh(6, 9);
    fresh.compute(a.sparseView());
    factorisation.compute(a.sparseView());
    Vector b1 = b, b2 = b, x1(9), x2(9);
    factorisation.solve(b1, x1);
    fresh.solve(b2, x2);
    EXPECT_EQ(x1, x2);
    EXPECT_EQ(factorisation.condition().ratio, fresh.condition().ratio);
  }
}

TYPED_TEST(FactorisationOf, EstimatesTheConditionWithinAFactorOfTwo) {
  Random random(4);
  for (int trial = 0; trial < 400; ++trial) {
    const auto [rows, columns] = shapes[static_cast<std::size_t>(trial) % std::size(shapes)];
    const bool is_graded = trial % 2 == 0;
    const Matrix a = is_graded ? graded(rows, columns, std::pow(10, random.between(0, 9)), random)
                               : random_matrix(rows, columns, random);
    const Vector values = a.bdcSvd().singularValues();
    TypeParam factorisation(rows, columns);
    factorisation.compute(a.sparseView());
    ASSERT_EQ(factorisation.rank(), values.size());
    const Factorisation::Condition condition = factorisation.condition();
    const double smallest = values[values.size() - 1], ratio = values[0] / smallest;
    EXPECT_GE(condition.smallest, smallest * (1 - 1e-6)) << "too large, if anything";
    EXPECT_LE(condition.smallest, 2 * smallest);
    EXPECT_LE(condition.ratio, ratio * (1 + 1e-6));
    EXPECT_GE(condition.ratio, ratio / 2);
  }
}

TYPED_TEST(FactorisationOf, EstimatesTheConditionOfWhatIsLeftWhenRankIsLost) {
  Random random(5);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Index rank = 1 + trial % 6;
    const Matrix a = of_rank(12, 9, rank, random);
    const Vector values = a.bdcSvd().singularValues();
    TypeParam factorisation(12, 9);
    factorisation.compute(a.sparseView());
    ASSERT_EQ(factorisation.rank(), rank);
    const double smallest = factorisation.condition().smallest;
    EXPECT_GE(smallest, values[rank - 1] * (1 - 1e-6));
    EXPECT_LE(smallest, 2 * values[rank - 1]);
  }
}

// A chain of loops: rows of each in its own columns and one shared with the next; every fourth row follows from others.
Eigen::SparseMatrix<double> chain(Eigen::Index loops, Random& random) {
  Matrix a = Matrix::Zero(4 * loops, 2 * loops + 1);
  for (Eigen::Index i = 0; i < loops; ++i) {
    a.block(4 * i, 2 * i, 4, 3) = of_rank(4, 3, 2, random);
  }
  return a.sparseView();
}

TEST(Factorisation, OfAChainOfLoopsIsTheSameDenseAndSparse) {
  Random random(6);
  for (const Eigen::Index loops : {1, 10, 60}) {
    const auto a = chain(loops, random);
    DenseFactorisation dense(a.rows(), a.cols());
    SparseFactorisation sparse(a.rows(), a.cols());
    dense.compute(a);
    sparse.compute(a);
    ASSERT_EQ(sparse.rank(), dense.rank());
    const Vector b = random_matrix(a.rows(), 1, random);
    Vector of_dense(a.cols()), of_sparse(a.cols()), scratch = b;
    dense.solve(scratch, of_dense);
    scratch = b;
    sparse.solve(scratch, of_sparse);
    const double condition = dense.condition().ratio;
    EXPECT_LE((of_sparse - of_dense).norm(), 1e-14 * condition * condition * (1 + of_dense.norm()));
    EXPECT_GE(sparse.condition().ratio, condition / 2);
    EXPECT_LE(sparse.condition().ratio, condition * 2);
  }
}

TEST(Orientation, TurnsWhereADeterminantChangesItsSign) {
  Random random(7);
  for (const Eigen::Index n : {Eigen::Index(1), Eigen::Index(7), largest_dense, largest_dense + 1}) {
    Matrix before = Matrix::Identity(n + 2, n);
    before.block(0, 0, n, n) += random_matrix(n, n, random) / static_cast<double>(4 * n);
    Matrix turned = before;
    turned.col(n / 2) = -turned.col(n / 2);
    Orientation orientation(n);
    orientation.remember(before.sparseView());
    EXPECT_TRUE(orientation.is_kept(before.sparseView()));
    EXPECT_FALSE(orientation.is_kept(turned.sparseView())) << n;
  }
}

}  // namespace
}  // namespace koppel::test
