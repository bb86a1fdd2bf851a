// Rank-revealing factorisation of a scaled Jacobian and minimum-norm least-squares solutions with it. Storage is made
// once; only a change of rank makes some anew.
#pragma once

#include <Eigen/Core>
#include <Eigen/QR>

namespace koppel {

/// Singular values, or pivots, up to this count as zero: 10 max(m, n) eps times the largest.
double rank_tolerance(Eigen::Index rows, Eigen::Index columns, double largest);

/// A P = Q [T; 0] with column pivoting and T of full row rank; where T is wide, T' is factorised too (a complete
/// orthogonal decomposition), so that solutions have the least norm.
class Factorisation {
 public:
  Factorisation(Eigen::Index rows, Eigen::Index columns);

  /// Factorises. Rank: pivots above rank_tolerance().
  void compute(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

  Eigen::Index rank() const { return rank_; }

  /// x of least norm among those that minimise |A x - b|. b is used as scratch.
  void solve(Eigen::VectorXd& b, Eigen::VectorXd& x);

  struct Condition {
    double smallest = 0.0;  ///< singular value that counts; 0 if the rank is 0
    double ratio = 1.0;     ///< of the largest to it
  };
  /// Estimated by a few inverse iterations on the triangular factor; the smallest comes out too large, if anything.
  Condition condition();

 private:
  using Qr = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;

  bool full_column_rank() const { return rank_ == left_.cols(); }
  const Qr& triangular() const { return full_column_rank() ? left_ : right_; }
  void apply_q(const Qr& qr, bool transposed, Eigen::VectorXd& x);

  Qr left_, right_;
  Eigen::MatrixXd trapezoid_;  ///< T', as large as it can get
  Eigen::VectorXd high_, low_;
  Eigen::Index rank_ = 0;
};

}  // namespace koppel
