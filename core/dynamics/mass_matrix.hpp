// The mass matrix of the spanning tree by the composite rigid body algorithm.
#pragma once

#include <vector>

#include "dynamics/composite_inertia.hpp"
#include "dynamics/inertias.hpp"
#include "dynamics/tree_matrix.hpp"
#include "mechanism/kinematics.hpp"

namespace koppel {

/// Scratch of one thread; nothing is allocated after construction. Borrows the layout and the inertias.
class MassMatrix {
 public:
  MassMatrix(const TreeLayout& layout, const Inertias& inertias);

  /// M of the position that stands in the kinematics (forward_position): M a are the efforts that accelerations cost,
  /// v^T M v / 2 the kinetic energy.
  void evaluate(const Kinematics& kinematics, TreeMatrix& matrix);

  /// Of each node with all beyond, world axes, about its origin; after evaluate(). That of the ground is not formed.
  const std::vector<CompositeInertia>& composites() const { return composites_; }

 private:
  void compose(const Kinematics& kinematics);
  void spread_columns(const Kinematics& kinematics);
  void fill_row(std::uint32_t p, const Plain3& origin, const PlainWrench& momentum, double* row) const;

  const TreeLayout& layout_;
  const Inertias& inertias_;
  std::vector<CompositeInertia> composites_;
  std::vector<double> columns_;  ///< by component (angular, linear, point), then by number: rows are filled along them
};

}  // namespace koppel
