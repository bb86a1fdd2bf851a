// The closure's Jacobian row by row with its few columns, as Elimination takes it.
#pragma once

#include <cstddef>
#include <vector>

#include "closure/elimination.hpp"
#include "closure/equations.hpp"

namespace koppel {

/// Rows of Mechanism::rows, columns of Mechanism::columns; rates are not scaled. Scratch of one thread; nothing is
/// allocated after construction. Borrows the mechanism.
class ClosureRows {
 public:
  explicit ClosureRows(const Mechanism& mechanism);

  const RowPattern& pattern() const { return pattern_; }
  /// Of each column: turns its rate into the size of radians.
  const std::vector<double>& scales() const { return scales_; }
  /// Takes the values over where the equations stand.
  void evaluate(const Equations& equations);
  const std::vector<double>& values() const { return values_; }

  /// Adds J x to result (rows); x by rates (nv).
  void add_product(const Eigen::VectorXd& x, Eigen::VectorXd& result) const;
  /// Subtracts J^T multipliers from the efforts (nv).
  void subtract_transposed(const Eigen::VectorXd& multipliers, Eigen::VectorXd& efforts) const;

 private:
  const Mechanism& mechanism_;
  RowPattern pattern_;
  std::vector<double> values_, scales_;
  std::vector<std::size_t> order_;  ///< where each entry of each relation's block goes, one relation after another
  std::vector<double> block_;
};

}  // namespace koppel
