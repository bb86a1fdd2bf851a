// First derivatives of the inverse dynamics of the spanning tree, without differences: by one recursion outwards and
// one inwards (Carpentier, Mansard, Analytical derivatives of rigid body dynamics algorithms, 2018; Singh, Russo,
// Wensing, Efficient analytical derivatives of rigid-body dynamics using spatial vector algebra, 2022), extended to
// joints with several rates whose columns move within the joint.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "dynamics/inertias.hpp"
#include "dynamics/plain_twist.hpp"
#include "dynamics/tree_layout.hpp"
#include "mechanism/kinematics.hpp"

namespace koppel {

/// Row by row.
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Scratch of one thread; nothing is allocated after construction. Borrows the layout and the inertias. Time goes with
/// the number of pairs of rates of which one rests on the other, and with that of all entries, which are cleared.
///
/// Exact to rounding for products of elementary motions. For joints with callbacks the slope of the bias along the
/// coordinates, which no plugin gives, comes from central differences of the bias of that joint alone, as does all else
/// that its plugin leaves out; the rest of the tree takes no part in them.
class TreeDerivatives {
 public:
  TreeDerivatives(const TreeLayout& layout, const Inertias& inertias);

  /// Efforts (rows, nv) [N m, N] of inverse_dynamics() without wrenches on the nodes, by displacements along the rates
  /// (columns of by_q; integrate() tells what they do to q, the components of v and a stay) and by the rates (columns
  /// of by_v), for the position that stands in the kinematics (forward_position at q), rates v and accelerations a.
  /// Both are nv x nv, zero for cut joints. By accelerations it is the mass matrix.
  ///
  /// False: the plugin of the joint culprit() failed.
  bool evaluate(const Kinematics& kinematics, const Vector3& gravity, const double* q, const double* v, const double* a,
                RowMatrix& by_q, RowMatrix& by_v);
  JointId culprit() const { return culprit_; }

 private:
  /// A node; on the way inwards with all nodes beyond.
  struct Body {
    PlainTwist velocity, acceleration;  ///< acceleration: rate of the velocity field, as seen in free fall
    CompositeInertia inertia;
    CoriolisInertia coriolis;
    PlainWrench force;
  };
  /// A rate with its column s, and what it changes beyond. A displacement along it carries all motions beyond along,
  /// and leaves them behind: velocities v change by s x v + velocity_by_q, accelerations a by
  /// s x a + velocity_by_q x v + acceleration_by_q. The rate changes v by s, and a by s x v + acceleration_by_v.
  struct Rate {
    PlainTwist column, velocity_by_q, acceleration_by_q, acceleration_by_v;
  };
  struct Given {
    const double *q, *v, *a;
  };
  /// A joint while it is walked.
  struct Passage {
    const TreeLayout::Step& step;
    const Joint& joint;
    bool reversed;
    const Pose& outlet;  ///< in the world
    Rate* rates;         ///< of the joint
    Given given;         ///< of the joint
  };

  void choose_origin(const Kinematics& kinematics);
  bool outwards(const Kinematics& kinematics, const Given& given);
  void pass_product(const Passage& passage, PlainTwist& velocity, PlainTwist& acceleration) const;
  bool pass_callbacks(const Passage& passage, PlainTwist& velocity, PlainTwist& acceleration, PlainTwist* slopes) const;
  void place_body(const Kinematics& kinematics, Node node);
  PlainTwist from_outlet(const Passage& passage, const Vector6& twist) const;
  void spread(std::uint32_t p);
  static PlainWrench left_behind(const Body& body, const Rate& rate);
  static PlainWrench by_rate(const Body& body, const Rate& rate);
  void inwards(RowMatrix& by_q, RowMatrix& by_v);
  void fill_ancestors(std::uint32_t p, const Body& body, RowMatrix& by_q, RowMatrix& by_v);
  void fill_own(std::size_t step, const Body& body, RowMatrix& by_q, RowMatrix& by_v) const;

  const TreeLayout& layout_;
  const Inertias& inertias_;
  Plain3 origin_;  ///< amid the nodes: what all twists are taken about, so that no digits are lost to a far origin
  std::vector<Body> bodies_;                ///< of each node
  std::vector<Rate> rates_;                 ///< by number
  std::vector<std::uint8_t> carriers_;      ///< by number: bits of the rates of its joint that carry its column along
  std::vector<std::uint32_t> first_slope_;  ///< of each step
  std::vector<PlainTwist> slopes_;  ///< of callback joints: how S alone changes a column (second) with a rate (first)
  std::vector<double> spread_;      ///< rates_ by component, then by number: rows are filled along them
  std::vector<double> row_q_, row_v_, column_q_, column_v_;  ///< of one run of ancestors
  JointId culprit_;
};

}  // namespace koppel
