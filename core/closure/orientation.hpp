// Whether a Jacobian has kept its orientation between two positions.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <Eigen/SparseCore>

namespace koppel {

/// Of the first columns of a Jacobian, which have full rank at both positions. Storage of small ones is made on first
/// use; large ones are taken as sparse and allocate.
class Orientation {
 public:
  explicit Orientation(Eigen::Index columns) : columns_(columns) {}

  /// The position to compare with.
  void remember(const Eigen::SparseMatrix<double>& jacobian);
  /// Sign of det(before' now): positive if no singular value (or an even number of them) has gone through zero. Of
  /// redundant equations too: their space turns but little.
  bool is_kept(const Eigen::SparseMatrix<double>& jacobian);

 private:
  Eigen::Index columns_;
  Eigen::SparseMatrix<double> sparse_before_;
  Eigen::MatrixXd before_;  ///< rows x columns
  Eigen::MatrixXd turned_;  ///< columns x columns
  Eigen::PartialPivLU<Eigen::MatrixXd> factors_;
};

}  // namespace koppel
