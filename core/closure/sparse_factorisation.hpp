// Factorisation of a large Jacobian whose rows have few entries each, as those of many loops.
#pragma once

#include <optional>

#include "closure/elimination.hpp"
#include "closure/factorisation.hpp"

namespace koppel {

/// By elimination with pivots that keep it sparse; what is left to rows that follow from others, and to columns that
/// are free, is found by conjugate gradients. Allocates.
class SparseFactorisation final : public Factorisation {
 public:
  SparseFactorisation(Eigen::Index rows, Eigen::Index columns);

  void compute(const Eigen::SparseMatrix<double>& matrix) override;
  void solve(Eigen::VectorXd& b, Eigen::VectorXd& x) override;
  Condition condition() override;

  /// After compute().
  Elimination& elimination() { return *elimination_; }

 private:
  void take_out_motions(Eigen::VectorXd& x);
  void take_out_forces(Eigen::VectorXd& b);
  void meet_all(Eigen::VectorXd& b);

  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix_;
  std::optional<Elimination> elimination_;
  Eigen::VectorXd x_, unmet_;  ///< columns, rows
};

}  // namespace koppel
