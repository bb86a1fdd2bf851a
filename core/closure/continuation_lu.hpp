// Small systems of complex linear equations, without allocation.
#pragma once

#include <complex>

#include <Eigen/Core>

namespace koppel {

/// LU factorisation with partial pivoting in fixed storage, for few unknowns.
class SmallLu {
 public:
  explicit SmallLu(Eigen::Index n) : matrix(n, n), pivots_(n) {}
  Eigen::MatrixXcd matrix;  ///< to be set before factorise(), which overwrites it
  /// False: a pivot is zero or not finite.
  bool factorise();
  void solve(Eigen::VectorXcd& b) const;  ///< in place

 private:
  Eigen::VectorX<Eigen::Index> pivots_;
};

}  // namespace koppel
