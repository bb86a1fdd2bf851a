// Positions of a random mechanism, told from the frames of its joints alone, without the equations of closure.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "random_mechanism.hpp"

namespace koppel::test {

class RandomPositions {
 public:
  RandomPositions(const RandomMechanism& drawn, const Mechanism& mechanism) : drawn_(drawn), mechanism_(mechanism) {}

  /// Bodies along the tree in which the mechanism was drawn.
  std::vector<Pose> poses(const Eigen::VectorXd& q) const {
    std::vector<Pose> result(drawn_.bodies + 1);
    for (std::size_t i = 0; i < drawn_.bodies; ++i) {
      const RandomJoint& joint = drawn_.joints[i];
      const Pose across = over(i, q);
      const bool forward = joint.outlet == i + 1;
      result[i + 1] = forward ? result[joint.inlet] * across : result[joint.outlet] * across.inverse();
    }
    return result;
  }

  /// The outlet's body in the inlet's.
  Pose over(std::size_t i, const Eigen::VectorXd& q) const {
    const Joint& joint = mechanism_.joints[i];
    Pose moved;
    EXPECT_TRUE(joint.pose(q.data() + joint.q, moved));
    return joint.inlet.pose * moved * joint.outlet.pose.inverse();
  }

  double apart(const Pose& a, const Pose& b) const {
    return std::max((a.rotation - b.rotation).norm(), (a.position - b.position).norm() / mechanism_.length);
  }

  /// How far the origins of bodies lie away, in lengths of the mechanism; at least 1.
  double extent(const std::vector<Pose>& at) const {
    double result = 1.0;
    for (const Pose& pose : at) result = std::max(result, pose.position.norm() / mechanism_.length);
    return result;
  }

  /// How far the loops are open, of the extent of the mechanism where it stands.
  double open(const Eigen::VectorXd& q) const {
    const std::vector<Pose> at = poses(q);
    double result = 0.0;
    for (std::size_t i = drawn_.bodies; i < drawn_.joints.size(); ++i) {
      const RandomJoint& joint = drawn_.joints[i];
      result = std::max(result, apart(at[joint.inlet] * over(i, q), at[joint.outlet]));
    }
    return result / extent(at);
  }

  /// How far bodies stand apart in two positions.
  double between(const Eigen::VectorXd& q, const Eigen::VectorXd& other) const {
    const std::vector<Pose> a = poses(q), b = poses(other);
    double result = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) result = std::max(result, apart(a[i], b[i]));
    return result;
  }

  /// The same with every coordinate changed by up to this, in radians' size.
  Eigen::VectorXd displaced(const Eigen::VectorXd& from, double by, Random& random) const {
    Eigen::VectorXd delta(mechanism_.nv), result = from;
    for (Eigen::Index i = 0; i < delta.size(); ++i) {
      delta[i] = by * mechanism_.rate_scale[static_cast<std::size_t>(i)] * random.between(-1, 1);
    }
    integrate(mechanism_, from, delta, result);
    return result;
  }

  /// Greatest change of a coordinate, in radians' size.
  double way(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
    Eigen::VectorXd delta(mechanism_.nv);
    difference(mechanism_, from, to, delta);
    for (const StateBlock& block : mechanism_.blocks) {
      if (block.kind == BlockKind::angle) delta[block.v] = std::remainder(delta[block.v], 2 * std::numbers::pi);
    }
    double most = 0.0;
    for (Eigen::Index i = 0; i < delta.size(); ++i) {
      most = std::max(most, std::abs(delta[i]) / mechanism_.rate_scale[static_cast<std::size_t>(i)]);
    }
    return most;
  }

 private:
  const RandomMechanism& drawn_;
  const Mechanism& mechanism_;
};

}  // namespace koppel::test
