// Equations of motion in independent coordinates: loops closed exactly, all other coordinates following from them.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>

#include "closure/elimination.hpp"
#include "closure/equations.hpp"
#include "dynamics/archive.hpp"
#include "dynamics/chart.hpp"
#include "dynamics/closure_rows.hpp"
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
  /// Closure equations (rows) that do not follow from others there, ascending.
  const std::vector<std::uint32_t>& conditions() const { return elimination_.kept(); }
  /// Rates (in v) that are independent, ascending.
  const std::vector<std::uint32_t>& independent() const { return independent_; }

  /// Closes the loops by Newton's method: drives at their values of the time, independent coordinates as they stand in
  /// delta, the others from there on. delta comes out closed, and q belongs to it.
  bool close(const Chart& chart, double time, Eigen::VectorXd& delta);
  /// Least ratio of a pivot to the entries beside it, where it closed last: near 0 the choice is near its limit.
  double conditioning() const { return conditioning_; }
  /// And how far the closure equations are from losing rank there, whatever the choice: 1 far, 0 at a singular
  /// position.
  double margin() const { return elimination_.margin(); }
  const Eigen::VectorXd& q() const { return q_; }
  /// From now on drives stand still where they are at the time, and with them all that depends on time; or move again.
  /// While they are held only a mechanism at rest, or the first order beside that, is right if a constraint depends on
  /// time.
  void hold_drives(bool held) { held_ = held; }
  /// Value, rate and acceleration that are added to those of a drive.
  void offset_drive(std::size_t input, const Vector3& offset) {
    offsets_.col(static_cast<Eigen::Index>(input)) = offset;
  }
  /// Efforts (nv) beside those of the forces [N m, N]; on joints at which loops are cut they are left out.
  void push(const Eigen::VectorXd& efforts) { pushed_ = efforts; }

  /// All rates from the independent ones (in their order); after close().
  bool velocities(const Eigen::VectorXd& independent_rates);
  const Eigen::VectorXd& v() const { return v_; }

  /// Instead of close() and velocities(): takes position and rates of the tree (v) as they are, whether or not they
  /// close the loops and fit the drives.
  bool stand(const Chart& chart, double time, const Eigen::VectorXd& delta, const Eigen::VectorXd& v);
  /// Before stand(): puts driven coordinates and their rates where the drives want them at a time.
  bool drive(const Chart& chart, double time, Eigen::VectorXd& delta, Eigen::VectorXd& v);
  /// After stand(): how far each closure equation is open (rows, scaled), and at which rates they open [1/s].
  const Eigen::VectorXd& closure() const { return equations_.residual; }
  bool opening_rates(Eigen::VectorXd& rates);
  /// Baumgarte's stabilisation of what stands so: from now on accelerations() let every closure equation r, and every
  /// drive's, fade as r'' + 2 pull r' + pull^2 r = 0. pull [1/s]; 0: not at all.
  void stabilise(double pull) { pull_ = pull; }

  /// All accelerations, by the forces that act; after velocities(). states: of the forces, and their rates.
  bool accelerations(const double* states, double* state_rates);
  const Eigen::VectorXd& a() const { return a_; }
  /// After accelerations() or imbalance(): efforts for one of each closure equation with which the loops, and the
  /// drives, balance the tree (rows); 0 of those that follow from others.
  const Eigen::VectorXd& multipliers();
  /// Subtracts from efforts (nv) what the loops do to the tree with such multipliers.
  void subtract_loops(const Eigen::VectorXd& multipliers, Eigen::VectorXd& efforts) const {
    rows_.subtract_transposed(multipliers, efforts);
  }
  /// After stand(): the efforts (nv) that are missing to accelerations a (nv; those of the drives count as they are
  /// driven) with multipliers of the loops. states: of the forces, and their rates.
  bool imbalance(const double* states, const Eigen::VectorXd& a, const Eigen::VectorXd& multipliers,
                 double* state_rates, Eigen::VectorXd& missing);
  /// What forces, gravity and the motion of the drives do along each independent coordinate while none of these is
  /// accelerated [N m, N]; after velocities(). Needs no mass.
  bool efforts(const double* states, double* state_rates, Eigen::VectorXd& along);
  /// Mass in the independent coordinates, which follow each other's order; after velocities().
  void mass(Eigen::MatrixXd& mass);
  /// After accelerations(): all of them, those of the joints at which loops are cut included.
  bool complete(Eigen::VectorXd& a);
  /// What stands after complete().
  const Kinematics& kinematics() const { return equations_.kinematics; }
  /// After accelerations(): power [W] that drives and forces without a store deliver, less what stores dissipate.
  bool power(const double* states, double& power);

  /// After velocities(): kinetic energy, and potential energy of gravity and of the forces that store it [J].
  struct Energy {
    double kinetic = 0.0, potential = 0.0;
  };
  bool energy(const double* states, Energy& energy);

  /// After velocities(): the switches of the forces (Forces::switches).
  bool switches(const double* states, double* values);

  /// After velocities(): the greatest scaled rate at which a closure equation opens [1/s].
  double opening();
  /// The greatest scaled closure residual at the position closed last.
  double residual() const { return equations_.error(); }

  /// After choose(): tells where cut joints turn on from. False: what is read does not fit.
  bool exchange(Archive& archive);

  Obstacle obstacle() const { return obstacle_; }
  std::string culprit() const;
  Forces& forces() { return forces_; }

 private:
  bool fail(Obstacle obstacle);
  bool take_inputs(double time);
  void find_shared_blocks();
  void hold_shared(const Chart& chart, const Eigen::VectorXd& delta);
  void scatter(const Eigen::VectorXd& columns, Eigen::VectorXd& rates) const;
  bool leave_unaccelerated(const double* states, double* state_rates);
  bool take_forces(const double* states, double* state_rates);
  void add_pull();
  void take_inverse_dynamics();
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
  State inputs_;              ///< only its inputs count
  Eigen::Matrix3Xd offsets_;  ///< of the inputs
  Eigen::VectorXd pushed_;
  std::vector<std::uint32_t> independent_;
  double time_ = 0.0, conditioning_ = 1.0, pull_ = 0.0;
  Obstacle obstacle_ = Obstacle::none;
  bool force_failed_ = false, held_ = false;
  std::uint32_t loose_ = 0;  ///< a rate without resistance

  std::vector<std::uint32_t> cut_;  ///< angles of cut joints, in q: they turn on from where they were last
  Eigen::VectorXd last_;            ///< q where it closed last
  Eigen::VectorXd q_, v_, a_, zero_, step_, step_rates_, efforts_, residual_efforts_, force_efforts_;  ///< nq or nv
  Eigen::VectorXd x_, b_, multipliers_;  ///< columns, rows, rows
  Elimination::Transfer transfer_;       ///< columns x independent
  Eigen::MatrixXd inertial_;             ///< nv x independent: efforts for unit accelerations
  Eigen::MatrixXd mass_;                 ///< independent x independent
  Eigen::VectorXd rhs_;
  std::vector<std::uint32_t> shared_;  ///< independent rates of blocks whose other rates depend
  Eigen::MatrixXd by_shared_;
  Eigen::VectorXd held_back_;
  Eigen::PartialPivLU<Eigen::MatrixXd> shared_factors_;
  std::vector<Wrench> on_nodes_, carried_;
};

}  // namespace koppel
