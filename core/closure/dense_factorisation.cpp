#include "closure/dense_factorisation.hpp"

#include <algorithm>
#include <cmath>

namespace koppel {

void spread_columns(const Eigen::SparseMatrix<double>& matrix, Eigen::MatrixXd& dense) {
  dense.setZero();
  for (Eigen::Index column = 0; column < dense.cols(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, column); entry; ++entry) {
      dense(entry.row(), column) = entry.value();
    }
  }
}

DenseFactorisation::DenseFactorisation(Eigen::Index rows, Eigen::Index columns)
    : Factorisation(rows, columns),
      matrix_(rows, columns),
      left_(rows, columns),
      right_(columns, std::min(rows, columns)),
      high_(std::max(rows, columns)),
      low_(std::max(rows, columns)) {}

void DenseFactorisation::compute(const Eigen::SparseMatrix<double>& matrix) {
  rank_ = 0;
  if (matrix_.size() == 0) return;
  spread_columns(matrix, matrix_);
  left_.compute(matrix_);
  const double threshold = rank_tolerance(rows_, columns_, std::abs(left_.maxPivot()));
  const auto pivots = left_.matrixQR().diagonal();
  while (rank_ < pivots.size() && std::abs(pivots[rank_]) > threshold) ++rank_;
  if (full_column_rank() || rank_ == 0) return;
  // Only a loss of rank needs this; the storage is then kept as long as the rank stays.
  trapezoid_.resize(columns_, rank_);
  trapezoid_ = left_.matrixQR().topRows(rank_).triangularView<Eigen::Upper>().transpose();
  right_.compute(trapezoid_);
}

void DenseFactorisation::apply_q(const Qr& qr, bool transposed, Eigen::VectorXd& x) {
  const Eigen::Index n = qr.rows(), count = rank_;
  double scratch = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index k = transposed ? i : count - 1 - i;
    x.segment(k, n - k).applyHouseholderOnTheLeft(qr.matrixQR().col(k).tail(n - k - 1), qr.hCoeffs()[k], &scratch);
  }
}

void DenseFactorisation::solve(Eigen::VectorXd& b, Eigen::VectorXd& x) {
  if (rank_ == 0) {
    x.setZero();
    return;
  }
  apply_q(left_, true, b);
  if (full_column_rank()) {
    left_.matrixQR().topLeftCorner(rank_, rank_).triangularView<Eigen::Upper>().solveInPlace(b.head(rank_));
    for (Eigen::Index i = 0; i < rank_; ++i) x[left_.colsPermutation().indices()[i]] = b[i];
    return;
  }
  // T y = b with T' P2 = Q2 R2: R2' z = P2' b, y = Q2 z.
  for (Eigen::Index i = 0; i < rank_; ++i) high_[i] = b[right_.colsPermutation().indices()[i]];
  right_.matrixQR()
      .topLeftCorner(rank_, rank_)
      .triangularView<Eigen::Upper>()
      .transpose()
      .solveInPlace(high_.head(rank_));
  high_.segment(rank_, columns_ - rank_).setZero();
  apply_q(right_, false, high_);
  for (Eigen::Index i = 0; i < columns_; ++i) x[left_.colsPermutation().indices()[i]] = high_[i];
}

Factorisation::Condition DenseFactorisation::condition() {
  if (rank_ == 0) return {};
  constexpr int iterations = 4;
  const auto r = triangular().matrixQR().topLeftCorner(rank_, rank_).triangularView<Eigen::Upper>();
  auto x = high_.head(rank_);
  auto y = low_.head(rank_);
  // The pivoted triangle's last column points nearly along the weakest direction; start there, and with the first for
  // the strongest.
  double inverse_square = 0.0, square = 0.0;
  x.setConstant(1e-3);
  x[rank_ - 1] = 1.0;
  x.normalize();
  for (int i = 0; i < iterations; ++i) {
    r.transpose().solveInPlace(x);
    r.solveInPlace(x);
    inverse_square = x.norm();
    x /= inverse_square;
  }
  x.setConstant(1.0);
  x.normalize();
  for (int i = 0; i < iterations; ++i) {
    y.noalias() = r * x;
    x.noalias() = r.transpose() * y;
    square = x.norm();
    x /= square;
  }
  const double smallest = 1.0 / std::sqrt(inverse_square), largest = std::sqrt(square);
  return {smallest, std::max(1.0, largest / smallest)};
}

}  // namespace koppel
