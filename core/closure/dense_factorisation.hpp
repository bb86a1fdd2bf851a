// Factorisation of a small Jacobian.
#pragma once

#include "closure/decompositions.hpp"
#include "closure/factorisation.hpp"

namespace koppel {

/// A P = Q [T; 0] with column pivoting and T of full row rank; where T is wide, T' is factorised too (a complete
/// orthogonal decomposition), so that solutions have the least norm. Storage is made once; only a change of rank makes
/// some anew.
class DenseFactorisation final : public Factorisation {
 public:
  DenseFactorisation(Eigen::Index rows, Eigen::Index columns);

  void compute(const Eigen::SparseMatrix<double>& matrix) override;
  void solve(Eigen::VectorXd& b, Eigen::VectorXd& x) override;
  Condition condition() override;

 private:
  using Qr = Eigen::ColPivHouseholderQR<Eigen::MatrixXd>;

  bool full_column_rank() const { return rank_ == columns_; }
  const Qr& triangular() const { return full_column_rank() ? left_ : right_; }
  void apply_q(const Qr& qr, bool transposed, Eigen::VectorXd& x);

  Eigen::MatrixXd matrix_;
  Qr left_, right_;
  Eigen::MatrixXd trapezoid_;  ///< T', as large as it can get
  Eigen::VectorXd high_, low_;
};

/// Writes the first columns of a sparse matrix, as many as `dense` has.
void spread_columns(const Eigen::SparseMatrix<double>& matrix, Eigen::MatrixXd& dense);

}  // namespace koppel
