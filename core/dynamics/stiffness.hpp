// What holds a mechanism where it rests: the stiffness in its independent coordinates, and which way it gives.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "dynamics/derivative.hpp"
#include "dynamics/statics.hpp"

namespace koppel {

enum class Holding { stable, unstable, indifferent };

struct Stiffness {
  /// Force against a displacement, independent coordinates by independent coordinates [N m, N by rad, m]. Internal
  /// states of forces have come to rest, if those alone would; else they stand as they are.
  Derivative matrix;
  bool states_held = false;
  bool circulatory = false;  ///< not symmetric by more than its error: no energy belongs to it
  /// Of the matrix in scaled coordinates, real parts, ascending [J]; a scaled line is over the mechanism's length.
  Eigen::VectorXd eigenvalues;
  double error = 0.0;  ///< of an eigenvalue; below it, indifferent
  std::vector<Holding> holding;
  Eigen::MatrixXd directions;  ///< nv x eigenvalues: rates, in their own units, greatest scaled one 1

  std::uint32_t count(Holding kind) const;
};

/// Where the statics stand. force_scale: size of the forces [J], of which rounding counts for nothing. False: nothing
/// could be evaluated beside it.
bool find_stiffness(const Mechanism& mechanism, Statics& statics, double force_scale, Stiffness& stiffness);

}  // namespace koppel
