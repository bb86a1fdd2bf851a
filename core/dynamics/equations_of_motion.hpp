// Equations of motion in independent coordinates: loops closed exactly, all other coordinates following from them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "closure/equations.hpp"
#include "dynamics/chart.hpp"
#include "dynamics/closure_rows.hpp"
#include "dynamics/elimination.hpp"
#include "dynamics/forces.hpp"
#include "dynamics/forward_dynamics.hpp"
#include "dynamics/inertias.hpp"
#include "dynamics/mass_matrix.hpp"
#include "dynamics/tree_layout.hpp"
#include "dynamics/tree_matrix.hpp"
#include "mechanism/state.hpp"

namespace koppel {

/// Why a function below has returned false.
enum class Obstacle {
  none,
  plugin,    ///< a plugin failed; culprit() tells which
  open,      ///< the loops do not close with the independent coordinates where they are
  singular,  ///< the others do not follow from the independent ones: a singular position of this choice
  massless,  ///< nothing resists in some freedom; culprit() tells a coordinate of it
};

/// A mechanism's motion, one position after another. Scratch of one thread; nothing is allocated after choose().
class EquationsOfMotion {
 public:
  EquationsOfMotion(std::shared_ptr<const Mechanism> mechanism, Inertias inertias);

  const Mechanism& mechanism() const { return *mechanism_; }
  const Inertias& inertias() const { return inertias_; }

  /// Chooses independent coordinates by their values at a position, which need not be closed. False: a plugin failed.
  bool choose(const Eigen::VectorXd& q, double time);
  /// Rates (in v) that are independent, ascending.
  const std::vector<std::uint32_t>& independent() const { return independent_; }

  /// Closes the loops by Newton's method: drives at their values of the time, independent coordinates as they stand in
  /// delta, the others from there on. delta comes out closed, and q belongs to it.
  bool close(const Chart& chart, double time, Eigen::VectorXd& delta);
  /// Least ratio of a pivot to the entries beside it, where it closed last: near 0 the choice is near its limit.
  double conditioning() const { return conditioning_; }
  const Eigen::VectorXd& q() const { return q_; }

  /// All rates from the independent ones (in their order); after close().
  bool velocities(const Eigen::VectorXd& independent_rates);
  const Eigen::VectorXd& v() const { return v_; }

  /// All accelerations, by the forces that act; after velocities(). states: of the forces, and their rates.
  bool accelerations(const double* states, double* state_rates);
  const Eigen::VectorXd& a() const { return a_; }
  /// After accelerations(): all of them, those of the joints at which loops are cut included.
  bool complete(Eigen::VectorXd& a);
  /// After accelerations(): power [W] that drives and forces without a store deliver, less what stores dissipate.
  bool power(const double* states, double& power);

  /// After velocities(): kinetic energy, and potential energy of gravity and of the forces that store it [J].
  struct Energy {
    double kinetic = 0.0, potential = 0.0;
  };
  bool energy(const double* states, Energy& energy);

  /// After velocities(): the greatest scaled rate at which a closure equation opens [1/s].
  double opening();
  /// The greatest scaled closure residual at the position closed last.
  double residual() const { return equations_.error(); }

  Obstacle obstacle() const { return obstacle_; }
  std::string culprit() const;
  Forces& forces() { return forces_; }

 private:
  bool fail(Obstacle obstacle);
  bool take_inputs(double time);
  void scatter(const Eigen::VectorXd& columns, Eigen::VectorXd& rates) const;
  void reduce_mass();
  bool solve_reduced();
  bool tree_accelerations();
  double along_independent(Eigen::Index i, const Eigen::VectorXd& efforts) const;

  std::shared_ptr<const Mechanism> mechanism_;
  Inertias inertias_;
  TreeLayout layout_;
  MassMatrix mass_matrix_;
  TreeMatrix tree_mass_;
  ArticulatedBodies articulated_;
  Equations equations_;
  Forces forces_;
  ClosureRows rows_;
  Elimination elimination_;
  State inputs_;  ///< only its inputs count
  std::vector<std::uint32_t> independent_;
  double time_ = 0.0, conditioning_ = 1.0;
  Obstacle obstacle_ = Obstacle::none;
  bool force_failed_ = false;
  std::uint32_t loose_ = 0;  ///< a rate without resistance

  std::vector<std::uint32_t> cut_;  ///< angles of cut joints, in q: they turn on from where they were last
  Eigen::VectorXd last_;            ///< q where it closed last
  Eigen::VectorXd q_, v_, a_, zero_, step_, step_rates_, efforts_, residual_efforts_, force_efforts_;  ///< nq or nv
  Eigen::VectorXd x_, b_, multipliers_;  ///< columns, rows, rows
  Elimination::Transfer transfer_;       ///< columns x independent
  Eigen::MatrixXd inertial_;             ///< nv x independent: efforts for unit accelerations
  Eigen::MatrixXd mass_;                 ///< independent x independent
  Eigen::VectorXd rhs_;
  std::vector<Wrench> on_nodes_, carried_;
};

}  // namespace koppel
