#include "closure/sparse_factorisation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace koppel {
namespace {

RowPattern pattern_of(const Eigen::SparseMatrix<double, Eigen::RowMajor>& rows) {
  RowPattern pattern;
  pattern.columns = static_cast<std::uint32_t>(rows.cols());
  pattern.first.assign(rows.outerIndexPtr(), rows.outerIndexPtr() + rows.rows() + 1);
  pattern.column.assign(rows.innerIndexPtr(), rows.innerIndexPtr() + rows.nonZeros());
  return pattern;
}

/// Takes A y out of r, so that r becomes as small as it can, by conjugate gradients; A, given by what it and its
/// transposed make of a vector, must be well conditioned. scale: the size of A' r at which rounding is judged. Returns
/// y, of the given size.
template <typename Apply, typename Gather>
Eigen::VectorXd take_out(const Apply& apply, const Gather& gather, Eigen::Index size, double scale,
                         Eigen::VectorXd& r) {
  constexpr int most = 100;
  Eigen::VectorXd y = Eigen::VectorXd::Zero(size), gradient = gather(r), step = gradient, along;
  double square = gradient.squaredNorm();
  const double enough = std::pow(8.0 * std::numeric_limits<double>::epsilon() * scale, 2);
  for (Eigen::Index i = 0; i < most && square > enough; ++i) {
    along = apply(step);
    const double factor = square / along.squaredNorm();
    if (!std::isfinite(factor)) break;
    r -= factor * along;
    y += factor * step;
    gradient = gather(r);
    const double next = gradient.squaredNorm();
    // In exact arithmetic all is done after as many steps as there are unknowns; from there it begins anew.
    step = (i + 1) % (size + 1) == 0 ? gradient : Eigen::VectorXd(gradient + next / square * step);
    square = next;
  }
  return y;
}

}  // namespace

SparseFactorisation::SparseFactorisation(Eigen::Index rows, Eigen::Index columns)
    : Factorisation(rows, columns), x_(columns) {}

void SparseFactorisation::compute(const Eigen::SparseMatrix<double>& matrix) {
  matrix_ = matrix.leftCols(columns_);
  const std::vector<double> values(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros());
  const std::vector<double> scale(static_cast<std::size_t>(columns_), 1.0);
  elimination_.emplace(pattern_of(matrix_), static_cast<std::uint32_t>(columns_));
  elimination_->choose(values, scale, rank_tolerance(rows_, columns_, 1.0));
  elimination_->factorise(values);
  rank_ = elimination_->rank();
}

/// Takes out of x (columns) what lies in the null space, that is K y for some y of the independent columns, where K
/// tells how all columns follow from these.
void SparseFactorisation::take_out_motions(Eigen::VectorXd& x) {
  const std::vector<std::uint32_t>& independent = elimination_->independent();
  if (independent.empty()) return;
  const auto follow = [&](const Eigen::VectorXd& y) {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(columns_);
    all(independent) = y;
    elimination_->follow(all);
    return all;
  };
  const auto gather = [&](Eigen::VectorXd all) {
    elimination_->gather(all);
    return Eigen::VectorXd(all(independent));
  };
  take_out(follow, gather, static_cast<Eigen::Index>(independent.size()), gather(x).norm(), x);
}

/// Takes out of b (rows) what the rows can meet, whatever their right-hand sides: [1; W] y for some y of the rows that
/// were kept (Peters and Wilkinson, The least squares problem and pseudo-inverses, 1970).
void SparseFactorisation::take_out_forces(Eigen::VectorXd& b) {
  const std::vector<std::uint32_t>& kept = elimination_->kept();
  const std::vector<std::uint32_t>& left_out = elimination_->left_out();
  const auto pass_on = [&](const Eigen::VectorXd& of_kept) {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(rows_), at = Eigen::VectorXd::Zero(columns_);
    all(kept) = of_kept;
    elimination_->solve(all, at);
    all(left_out) = (matrix_ * at)(left_out);
    return all;
  };
  const auto gather = [&](const Eigen::VectorXd& all) {
    Eigen::VectorXd others = all, multipliers(rows_);
    others(kept).setZero();
    elimination_->solve_transposed(matrix_.transpose() * others, multipliers);
    return Eigen::VectorXd(multipliers(kept) + all(kept));
  };
  const double scale = gather(b).norm();
  b -= pass_on(b(kept));
  take_out(pass_on, gather, static_cast<Eigen::Index>(kept.size()), scale, b);
}

void SparseFactorisation::solve(Eigen::VectorXd& b, Eigen::VectorXd& x) {
  x_.setZero();
  if (rank_ > 0) {
    meet_all(b);
    elimination_->solve(b, x_);
    take_out_motions(x_);
  }
  x.head(columns_) = x_;
}

/// Of right-hand sides, the part that the rows can meet.
void SparseFactorisation::meet_all(Eigen::VectorXd& b) {
  if (elimination_->left_out().empty()) return;
  unmet_ = b;
  take_out_forces(unmet_);
  b -= unmet_;
}

/// By inverse iterations.
Factorisation::Condition SparseFactorisation::condition() {
  if (rank_ == 0) return {};
  constexpr int iterations = 6;
  double inverse = 0.0, square = 0.0;
  const auto direction = [](Eigen::Index i) { return std::cos(1.0 + 2.7 * static_cast<double>(i)); };
  Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(rows_, direction), x(columns_);
  for (int i = 0; i < iterations; ++i) {
    meet_all(b);
    b.normalize();
    solve(b, x);
    inverse = x.norm();
    elimination_->solve_transposed(x, b);
  }
  x = Eigen::VectorXd::NullaryExpr(columns_, direction);
  for (int i = 0; i < iterations; ++i) {
    x.normalize();
    b = matrix_ * x;
    square = b.squaredNorm();
    x = matrix_.transpose() * b;
  }
  const double smallest = 1.0 / inverse, largest = std::sqrt(square);
  return {smallest, std::max(1.0, largest / smallest)};
}

}  // namespace koppel
