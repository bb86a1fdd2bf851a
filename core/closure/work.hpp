// Scratch memory of the solvers: one for each thread. Made once; stepping allocates nothing.
#pragma once

#include <memory>

#include <Eigen/Core>

#include "closure/equations.hpp"
#include "closure/factorisation.hpp"
#include "closure/orientation.hpp"
#include "mechanism/mechanism.hpp"
#include "mechanism/state.hpp"

namespace koppel {

class CeresClosure;
class FlowTracker;

/// Rates at a position where not the equations but only the branch tells them.
struct BranchRates {
  Eigen::VectorXd v, a;  ///< nv
};

struct Work {
  explicit Work(std::shared_ptr<const Mechanism> mechanism);
  ~Work();
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  std::shared_ptr<const Mechanism> mechanism;
  Equations equations;
  std::unique_ptr<Factorisation> factorisation;  ///< of the columns of the unknowns
  bool factorised = false;                       ///< equations stand, and `factorisation` holds, at the position below
  Eigen::VectorXd factorised_at;                 ///< nq
  double factorised_time = 0.0;
  Factorisation::Condition condition;  ///< there

  Eigen::VectorXd q, q_trial, q_start;  ///< nq
  Eigen::VectorXd delta, v, a;          ///< nv
  Eigen::VectorXd rhs, rhs_copy;        ///< rows
  Eigen::VectorXd step;                 ///< columns
  Eigen::VectorXd rest;                 ///< nv zeros
  Orientation orientation;              ///< of the columns of the unknowns
  State saved;                          ///< what a failed move goes back to
  std::unique_ptr<State> by_one;        ///< moved by one input alone, for transfer functions; made on first need

  /// Jacobian and factorisation where the equations stand, which is at q.
  void factorise(const Eigen::VectorXd& at, double time);

  std::unique_ptr<BranchRates> branch_rates;  ///< of the last closure, if it ended beside a change point
  std::unique_ptr<CeresClosure> ceres;        ///< built on first need
  std::unique_ptr<FlowTracker> tracker;       ///< built with the first step of a motion, if the mechanism has one
  bool tracker_sought = false;
  std::unique_ptr<Factorisation> all_columns;  ///< when the inputs are free too; built on first need
};

}  // namespace koppel
