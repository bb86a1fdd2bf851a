// What joints and drives bear when a mechanism moves as it does: inverse dynamics of trees and loops. The joints at
// which loops are cut are as good as all others.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "closure/elimination.hpp"
#include "closure/equations.hpp"
#include "closure/load_paths.hpp"
#include "dynamics/closure_rows.hpp"
#include "dynamics/forces.hpp"
#include "dynamics/inertias.hpp"
#include "mechanism/loads.hpp"
#include "mechanism/state.hpp"

namespace koppel {

/// Scratch of one thread. Nothing is allocated after the first evaluation, but for mechanisms with redundant equations.
///
/// Where these leave loads undetermined, those are given whose squares, moments taken over the mechanism's length, have
/// the least sum over all joints and all constraints on coordinates: whichever joints loops are cut at.
class Reactions {
 public:
  Reactions(std::shared_ptr<const Mechanism> mechanism, Inertias inertias);

  /// At a closed state with its rates and accelerations, under its forces. False: a plugin failed; culprit() tells
  /// which.
  bool evaluate(const State& state);
  const Loads& loads() const { return loads_; }

  /// Components [moment; force] of each joint's load, and efforts (by rate), that the motion determines.
  struct Determined {
    std::vector<std::array<bool, 6>> joints;
    std::vector<bool> efforts;
  };
  /// After evaluate().
  Determined determined() const;

  std::string culprit() const;

 private:
  bool tree_efforts(const State& state);
  void choose();
  bool is_chosen_well();
  void find_stresses();
  void relieve();
  Eigen::VectorXd stacked(const std::vector<Wrench>& joints, const Eigen::VectorXd& multipliers) const;

  std::shared_ptr<const Mechanism> mechanism_;
  Inertias inertias_;
  Equations equations_;
  Forces forces_;
  ClosureRows rows_;
  Elimination elimination_;
  LoadPaths paths_;
  bool chosen_ = false, force_failed_ = false;
  Loads loads_;
  std::vector<Pose> outlets_;
  std::vector<Wrench> on_nodes_, carried_, of_steps_;
  Eigen::VectorXd efforts_, columns_, multipliers_, state_rates_;

  /// States of self-stress, one for each redundant equation: the multipliers, and what they do to what stacked() lists.
  Eigen::SparseMatrix<double> stresses_, effects_;
};

}  // namespace koppel
