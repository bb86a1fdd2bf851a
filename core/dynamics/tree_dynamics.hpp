// The algorithms of the spanning tree, ready to be asked for one state after another.
#pragma once

#include <memory>
#include <optional>

#include <Eigen/Core>

#include "base/error.hpp"
#include "dynamics/energy.hpp"
#include "dynamics/forward_dynamics.hpp"
#include "dynamics/tree_derivatives.hpp"

namespace koppel {

/// Of the bodies on their tree joints under gravity: loops are open where they are cut, [[force]]s and drives do not
/// act. Scratch of one thread; nothing is allocated after construction but for errors.
///
/// Arrays: q holds nq numbers, v, a and efforts nv [rad/s and so on, N m or N]; a null v or a stands for zero.
/// Quaternions and unit vectors in q are normalised. What belongs to cut joints does not count, and comes out zero.
/// Functions give what stood in the way, or nothing; then their results stand in the members named with them.
class TreeDynamics {
 public:
  TreeDynamics(std::shared_ptr<const Mechanism> mechanism, Inertias inertias);

  using Obstacle = std::optional<Error>;  ///< plugin_misbehaved; massless, of forward dynamics

  /// efforts() that the motion takes.
  Obstacle inverse(const double* q, const double* v, const double* a);
  /// accelerations() that efforts cause; null efforts stand for zero.
  Obstacle forward(const double* q, const double* v, const double* efforts);
  /// mass_matrix().
  Obstacle mass(const double* q);
  /// mechanical().
  Obstacle energy(const double* q, const double* v);
  /// by_q() and by_v() of the efforts of inverse(), as TreeDerivatives tells.
  Obstacle inverse_derivatives(const double* q, const double* v, const double* a);
  /// by_q(), by_v() and by_effort() of the accelerations of forward(): by the implicit function theorem, what the
  /// efforts of inverse dynamics change by at these accelerations, over the mass matrix with the sign turned.
  Obstacle forward_derivatives(const double* q, const double* v, const double* efforts);

  const Eigen::VectorXd& efforts() const { return efforts_; }              ///< nv
  const Eigen::VectorXd& accelerations() const { return accelerations_; }  ///< nv
  const Eigen::MatrixXd& mass_matrix() const { return dense_; }            ///< nv x nv
  const MechanicalState& mechanical() const { return mechanical_; }
  const RowMatrix& by_q() const { return by_q_; }            ///< nv x nv, columns by displacements along the rates
  const RowMatrix& by_v() const { return by_v_; }            ///< nv x nv
  const RowMatrix& by_effort() const { return by_effort_; }  ///< nv x nv
  const Mechanism& mechanism() const { return *mechanism_; }

 private:
  bool place(const double* q);
  bool move(const double* q, const double* v, const double* a);
  const double* given(const double* rates) const { return rates == nullptr ? rest_.data() : rates; }
  Error plugin_error(JointId joint) const;
  Error loose(std::uint32_t rate) const;

  std::shared_ptr<const Mechanism> mechanism_;
  Inertias inertias_;
  TreeLayout layout_;
  Kinematics kinematics_;
  std::vector<Wrench> carried_;
  TreeMatrix matrix_;
  MassMatrix mass_matrix_;
  ArticulatedBodies articulated_;
  FactoredDynamics factored_;
  TreeDerivatives derivatives_;
  Eigen::VectorXd q_, rest_, efforts_, accelerations_;
  Eigen::MatrixXd dense_;
  RowMatrix by_q_, by_v_, by_effort_, solved_;
  MechanicalState mechanical_;
};

}  // namespace koppel
