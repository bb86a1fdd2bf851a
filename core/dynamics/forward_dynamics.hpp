// Forward dynamics of the spanning tree: accelerations from efforts.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "dynamics/articulated_inertia.hpp"
#include "dynamics/inertias.hpp"
#include "dynamics/mass_matrix.hpp"
#include "dynamics/tree_layout.hpp"
#include "mechanism/kinematics.hpp"
#include "spatial/twist.hpp"

namespace koppel {

/// By articulated bodies (Featherstone, Rigid body dynamics algorithms, chapter 7): linear in the number of bodies.
/// Scratch of one thread; nothing is allocated after construction. Borrows the layout and the inertias.
class ArticulatedBodies {
 public:
  ArticulatedBodies(const TreeLayout& layout, const Inertias& inertias);

  /// Accelerations (nv) [rad/s^2, m/s^2] that the efforts (nv) cause, with gravity [m/s^2] and the wrenches on the
  /// nodes (empty: none) as in inverse_dynamics(). The kinematics must hold the motion without accelerations:
  /// forward_motion with a = 0. Accelerations of cut joints come out zero, their efforts do not count.
  ///
  /// False if nothing resists in loose(): its pivot, what resists while all rates beyond give way, is not greater than
  /// its rounding error. That is some 32 2^-52 of the inertias that were added up there, as they were before rates
  /// next beyond gave way: forming, shifting and reducing them takes that many operations at most. Errors from further
  /// out pass through joints as inertias do.
  bool evaluate(const Kinematics& kinematics, const Vector3& gravity, const std::vector<Wrench>& on_nodes,
                const Eigen::VectorXd& efforts, Eigen::VectorXd& accelerations);

  /// The rate (in v) in which nothing resists.
  std::uint32_t loose() const { return loose_; }

 private:
  /// A node with all that hangs on it.
  struct Body {
    ArticulatedInertia inertia;
    PlainWrench bias;                              ///< that keeps accelerations at zero
    double angular_size = 0.0, linear_size = 0.0;  ///< of what was added up
    Plain3 angular, linear;                        ///< acceleration beyond that of the given motion
  };
  struct Rate {
    Plain3 angular, linear;              ///< its column at the child's origin
    PlainWrench resistance;              ///< to its unit acceleration
    double inverse = 0.0, effort = 0.0;  ///< of the pivot; what is left to accelerate it
  };
  void start(const Kinematics& kinematics, const Vector3& gravity, const std::vector<Wrench>& on_nodes);
  bool inwards(const Kinematics& kinematics, const Eigen::VectorXd& efforts);
  bool give_way(const Column& column, const Plain3& origin, double effort, Body& body, Rate& rate) const;
  void outwards(const Kinematics& kinematics, Eigen::VectorXd& accelerations);

  const TreeLayout& layout_;
  const Inertias& inertias_;
  std::vector<Body> bodies_;  ///< of each node
  std::vector<Rate> rates_;   ///< by number
  std::uint32_t loose_ = 0;
};

/// By the mass matrix and its factors: quicker where no rate has many ancestors, and leaves the factors for more
/// right-hand sides. Scratch of one thread; nothing is allocated after construction. Borrows the layout and the
/// inertias.
class FactoredDynamics {
 public:
  FactoredDynamics(const TreeLayout& layout, const Inertias& inertias);

  /// As ArticulatedBodies::evaluate(), with the tolerance of TreeFactors::factorise().
  bool evaluate(const Kinematics& kinematics, const Vector3& gravity, const std::vector<Wrench>& on_nodes,
                const Eigen::VectorXd& efforts, Eigen::VectorXd& accelerations);

  /// The mass matrix and its factors alone. False as above.
  bool factorise(const Kinematics& kinematics);
  /// Of the mass matrix; after one of the functions above.
  const TreeFactors& factors() const { return factors_; }
  std::uint32_t loose() const { return factors_.loose(); }

 private:
  const TreeLayout& layout_;
  const Inertias& inertias_;
  MassMatrix mass_matrix_;
  TreeMatrix matrix_;
  TreeFactors factors_;
  std::vector<Wrench> carried_;
};

}  // namespace koppel
