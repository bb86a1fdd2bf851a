// Rank-revealing factorisation of a scaled Jacobian and minimum-norm least-squares solutions with it.
#pragma once

#include <memory>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace koppel {

/// Singular values, or pivots, up to this count as zero: 10 max(m, n) eps times the largest.
double rank_tolerance(Eigen::Index rows, Eigen::Index columns, double largest);

/// Columns up to which a Jacobian is taken as a dense matrix.
inline constexpr Eigen::Index largest_dense = 150;

class Factorisation {
 public:
  /// Of matrices of this shape: dense, with column pivoting and storage made once, or sparse.
  static std::unique_ptr<Factorisation> of(Eigen::Index rows, Eigen::Index columns);
  virtual ~Factorisation() = default;

  /// Factorises the first columns of a matrix, as many as it is made for. Rank: pivots above rank_tolerance().
  virtual void compute(const Eigen::SparseMatrix<double>& matrix) = 0;

  Eigen::Index rank() const { return rank_; }

  /// x of least norm among those that minimise |A x - b|; its first entries, one for each column. b is used as scratch.
  virtual void solve(Eigen::VectorXd& b, Eigen::VectorXd& x) = 0;

  struct Condition {
    double smallest = 0.0;  ///< singular value that counts; 0 if the rank is 0
    double ratio = 1.0;     ///< of the largest to it
  };
  /// Estimated by a few inverse iterations on the triangular factor; the smallest comes out too large, if anything.
  virtual Condition condition() = 0;

 protected:
  Factorisation(Eigen::Index rows, Eigen::Index columns) : rows_(rows), columns_(columns) {}

  Eigen::Index rows_, columns_;
  Eigen::Index rank_ = 0;
};

}  // namespace koppel
