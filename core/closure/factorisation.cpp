#include "closure/factorisation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace koppel {

double rank_tolerance(Eigen::Index rows, Eigen::Index columns, double largest) {
  return 10.0 * static_cast<double>(std::max(rows, columns)) * std::numeric_limits<double>::epsilon() * largest;
}

Factorisation::Factorisation(Eigen::Index rows, Eigen::Index columns)
    : left_(rows, columns), right_(columns, std::min(rows, columns)) {
  high_.resize(std::max(rows, columns));
  low_.resize(std::max(rows, columns));
}

void Factorisation::compute(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  if (matrix.size() == 0) {
    rank_ = 0;
    return;
  }
  left_.compute(matrix);
  const double threshold = rank_tolerance(matrix.rows(), matrix.cols(), std::abs(left_.maxPivot()));
  const auto pivots = left_.matrixQR().diagonal();
  rank_ = 0;
  while (rank_ < pivots.size() && std::abs(pivots[rank_]) > threshold) ++rank_;
  if (full_column_rank() || rank_ == 0) return;
  // Only a loss of rank needs this; the storage is then kept as long as the rank stays.
  trapezoid_.resize(matrix.cols(), rank_);
  trapezoid_ = left_.matrixQR().topRows(rank_).triangularView<Eigen::Upper>().transpose();
  right_.compute(trapezoid_);
}

void Factorisation::apply_q(const Qr& qr, bool transposed, Eigen::VectorXd& x) {
  const Eigen::Index n = qr.rows(), count = rank_;
  double scratch = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index k = transposed ? i : count - 1 - i;
    x.segment(k, n - k).applyHouseholderOnTheLeft(qr.matrixQR().col(k).tail(n - k - 1), qr.hCoeffs()[k], &scratch);
  }
}

void Factorisation::solve(Eigen::VectorXd& b, Eigen::VectorXd& x) {
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
  const Eigen::Index n = left_.cols();
  high_.segment(rank_, n - rank_).setZero();
  apply_q(right_, false, high_);
  for (Eigen::Index i = 0; i < n; ++i) x[left_.colsPermutation().indices()[i]] = high_[i];
}

Factorisation::Condition Factorisation::condition() {
  if (rank_ == 0) return {};
  constexpr int iterations = 4;
  const auto r = triangular().matrixQR().topLeftCorner(rank_, rank_).triangularView<Eigen::Upper>();
  const auto x = high_.head(rank_);
  const auto y = low_.head(rank_);
  // The pivoted triangle's last column points nearly along the weakest direction; start there, and with the first for
  // the strongest.
  double inverse_square = 0.0, square = 0.0;
  high_.head(rank_).setConstant(1e-3);
  high_[rank_ - 1] = 1.0;
  high_.head(rank_).normalize();
  for (int i = 0; i < iterations; ++i) {
    r.transpose().solveInPlace(high_.head(rank_));
    r.solveInPlace(high_.head(rank_));
    inverse_square = x.norm();
    high_.head(rank_) /= inverse_square;
  }
  high_.head(rank_).setConstant(1.0);
  high_.head(rank_).normalize();
  for (int i = 0; i < iterations; ++i) {
    low_.head(rank_).noalias() = r * x;
    high_.head(rank_).noalias() = r.transpose() * y;
    square = x.norm();
    high_.head(rank_) /= square;
  }
  const double smallest = 1.0 / std::sqrt(inverse_square), largest = std::sqrt(square);
  return {smallest, std::max(1.0, largest / smallest)};
}

}  // namespace koppel
