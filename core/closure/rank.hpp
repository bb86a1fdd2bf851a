// The rank of closure equations where they stand, and what it leaves: motions that keep the loops closed, and stresses
// without a load.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace koppel {

/// Singular values around the rank of a scaled Jacobian, which counts those above rank_tolerance().
struct Rank {
  Eigen::Index rank = 0;
  double largest = 0.0, smallest = 0.0;  ///< of those that count; 0 if none does
  double next = 0.0;                     ///< the greatest that does not count; 0 if all do
};

struct NullSpaces {
  Eigen::Index rank = 0;
  Eigen::MatrixXd motions;               ///< columns, a basis: scaled rates that keep all loops closed
  Eigen::SparseMatrix<double> stresses;  ///< columns, a basis of length one each: multipliers that load no rate
};

/// By singular values up to largest_dense columns. Beyond, where the rows have few entries each, by elimination: the
/// rank by its pivots, and the values estimated.
Rank rank_of(const Eigen::SparseMatrix<double>& jacobian);
NullSpaces null_spaces_of(const Eigen::SparseMatrix<double>& jacobian);

}  // namespace koppel
