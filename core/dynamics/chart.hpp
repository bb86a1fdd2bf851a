// Local coordinates about a position: what integrators add up, on manifolds of quaternions and unit vectors too.
#pragma once

#include <Eigen/Core>

#include "mechanism/mechanism.hpp"

namespace koppel {

/// Coordinates delta (nv) about a base position: q = integrate(base, delta). Of quaternions a rotation vector, good to
/// less than one turn; others without a limit.
class Chart {
 public:
  explicit Chart(const Mechanism& mechanism);

  void set_base(const Eigen::VectorXd& q) { base_ = q; }
  const Eigen::VectorXd& base() const { return base_; }

  /// q at delta.
  void position(const Eigen::VectorXd& delta, Eigen::VectorXd& q) const;
  /// delta at q.
  void coordinates(const Eigen::VectorXd& q, Eigen::VectorXd& delta) const;
  /// Time derivative of delta where the mechanism has the rates v.
  void rates(const Eigen::VectorXd& delta, const Eigen::VectorXd& v, Eigen::VectorXd& delta_rate) const;

  /// All coordinates are lines and angles: delta_rate = v.
  bool is_flat() const { return curved_.empty(); }
  /// The greatest turn from the base, in quaternions and unit vectors [rad].
  double greatest_turn(const Eigen::VectorXd& delta) const;

 private:
  const Mechanism& mechanism_;
  std::vector<StateBlock> curved_;
  Eigen::VectorXd base_;
};

}  // namespace koppel
