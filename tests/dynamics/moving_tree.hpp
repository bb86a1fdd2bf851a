// A tree with masses that moves: what tests of dynamics start from.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "../mechanism/tree.hpp"
#include "dynamics/energy.hpp"
#include "dynamics/forward_dynamics.hpp"
#include "dynamics/inverse_dynamics.hpp"
#include "dynamics/mass_matrix.hpp"
#include "dynamics/tree_layout.hpp"
#include "dynamics/tree_matrix.hpp"
#include "mechanism/kinematics.hpp"

namespace koppel::test {

constexpr double eps = std::numeric_limits<double>::epsilon();

/// Five points of random mass within half a metre.
inline SpatialInertia random_inertia(Random& random) {
  std::vector<PointMass> points(5);
  for (PointMass& point : points) point = {random.between(0.05, 0.5), 0.5 * random.vector()};
  return inertia_from_points<double>(points);
}

/// A body at every node but the ground; none where `massless` says so.
template <typename Massless>
Inertias random_inertias(const Mechanism& mechanism, Random& random, const Massless& massless) {
  Inertias result;
  result.of_node.resize(mechanism.nodes);
  result.has_mass.assign(mechanism.nodes, false);
  for (Node node = 1; node < mechanism.nodes; ++node) {
    if (massless(node)) continue;
    result.of_node[node] = random_inertia(random);
    result.has_mass[node] = true;
    result.mass += result.of_node[node].mass;
  }
  return result;
}

/// A random tree without the joint of two coaxial rotations: it has a direction in which nothing resists.
inline std::string resisting_tree(std::size_t n, unsigned seed) {
  std::string text = random_tree(n, seed);
  const std::string loose = "odd.parallel";
  for (std::size_t at; (at = text.find(loose)) != std::string::npos;) text.replace(at, loose.size(), "odd.slide");
  return text;
}

/// n bodies in a row on revolute joints.
inline std::string chain_text(std::size_t n, unsigned seed) {
  Random random(seed);
  std::string text = "[scene]\nlength = 1\n";
  for (std::size_t i = 1; i <= n; ++i) {
    const std::string body = numbered("b", i), before = i == 1 ? "ground" : numbered("b", i - 1);
    text += "[[body]]\nname = '" + body + "'\n[[joint]]\nname = '" + numbered("j", i) +
            "'\ntype = 'revolute'\ninlet = " + random_place(random, before) + "\noutlet = '" + body + "'\n";
  }
  return text;
}

/// The size of a wrench: sums of what adds up to it, without regard of signs.
struct WrenchSize {
  double moment = 0.0, force = 0.0;
};

/// A tree in motion under gravity and wrenches.
class MovingTree {
 public:
  template <typename Massless>
  MovingTree(const std::string& text, unsigned seed, const Massless& massless)
      : random(seed),
        built(text),
        mechanism(*built),
        inertias(random_inertias(mechanism, random, massless)),
        layout(mechanism),
        q(random_position(mechanism, random)),
        v(random_rates(mechanism.nv, random)),
        a(random_rates(mechanism.nv, random)),
        on_nodes(mechanism.nodes),
        kinematics(mechanism),
        carried(mechanism.nodes) {
    for (Wrench& wrench : on_nodes) wrench = {random.vector(), random.vector()};
  }
  MovingTree(const std::string& text, unsigned seed) : MovingTree(text, seed, [](Node) { return false; }) {}

  Eigen::VectorXd zero() const { return Eigen::VectorXd::Zero(mechanism.nv); }

  const Kinematics& move(const Eigen::VectorXd& at, const Eigen::VectorXd& rates,
                         const Eigen::VectorXd& accelerations) {
    if (!forward_position(mechanism, at.data(), kinematics) ||
        !forward_motion(mechanism, at.data(), rates.data(), accelerations.data(), kinematics)) {
      throw std::runtime_error("a joint fails");
    }
    return kinematics;
  }
  Eigen::VectorXd efforts(const Eigen::VectorXd& rates, const Eigen::VectorXd& accelerations, const Vector3& g,
                          const std::vector<Wrench>& wrenches) {
    Eigen::VectorXd result(mechanism.nv);
    inverse_dynamics(mechanism, inertias, move(q, rates, accelerations), g, wrenches, carried, result);
    return result;
  }
  Eigen::VectorXd efforts(const Eigen::VectorXd& accelerations) { return efforts(v, accelerations, gravity, on_nodes); }

  TreeMatrix mass_matrix() {
    TreeMatrix result(layout);
    MassMatrix(layout, inertias).evaluate(move(q, v, a), result);
    return result;
  }

  /// How much of each effort (nv) rounding may change, for the motion with given accelerations: unit rounding errors
  /// in every operation, on every term by its size. Motions and wrenches are sums along paths of `depth` bodies.
  Eigen::VectorXd rounding(const Eigen::VectorXd& accelerations);

  Random random;
  const Built built;
  const Mechanism& mechanism;
  Inertias inertias;
  const TreeLayout layout;
  Vector3 gravity{1.0, -2.0, -9.0};
  Eigen::VectorXd q, v, a;
  std::vector<Wrench> on_nodes;
  Kinematics kinematics;
  std::vector<Wrench> carried;
};

/// The size of the motion of every node: sums of what its joints add to it, without regard of signs.
struct MotionSize {
  double turn = 0.0, velocity = 0.0, turn_rate = 0.0, acceleration = 0.0;

  void shift(double arm) {
    acceleration += (turn_rate + turn * turn) * arm;
    velocity += turn * arm;
  }
};

inline Eigen::VectorXd MovingTree::rounding(const Eigen::VectorXd& accelerations) {
  move(q, v, accelerations);
  std::vector<MotionSize> motions(mechanism.nodes);
  std::vector<int> depth(mechanism.nodes, 0);
  int deepest = 0;
  for (const TreeStep& step : mechanism.steps) {
    MotionSize& motion = motions[step.child] = motions[step.parent];
    const Joint& joint = mechanism.joints[step.joint.index()];
    deepest = std::max(deepest, depth[step.child] = depth[step.parent] + 1);
    const Vector3 &from = kinematics.poses[step.parent].position, &to = kinematics.poses[step.child].position;
    motion.shift((to - from).norm());
    MotionSize relative;
    for (std::uint32_t k = joint.v; k < joint.v + joint.nv; ++k) {
      const Column& c = kinematics.columns[k];
      const double arm = std::max((to - c.point).norm(), (from - c.point).norm());
      const double slide = c.linear.norm() + c.angular.norm() * arm;
      relative.turn += std::abs(v[k]) * c.angular.norm();
      relative.velocity += std::abs(v[k]) * slide;
      relative.turn_rate += std::abs(accelerations[k]) * c.angular.norm();
      relative.acceleration += std::abs(accelerations[k]) * slide;
    }
    motion.turn_rate += relative.turn_rate + (motion.turn + relative.turn) * relative.turn;
    motion.acceleration += relative.acceleration + 2 * (motion.turn + relative.turn) * relative.velocity;
    motion.turn += relative.turn;
    motion.velocity += relative.velocity;
  }
  std::vector<WrenchSize> sizes(mechanism.nodes);
  for (Node node = 1; node < mechanism.nodes; ++node) {
    const SpatialInertia& body = inertias.of_node[node];
    const MotionSize& m = motions[node];
    const double arm = body.centre.norm(), tensor = body.about_centre.norm();
    const double force = body.mass * (m.acceleration + (m.turn_rate + m.turn * m.turn) * arm + gravity.norm());
    sizes[node].force = force + on_nodes[node].force.norm();
    sizes[node].moment = force * arm + tensor * (m.turn_rate + m.turn * m.turn) + on_nodes[node].moment.norm();
  }
  Eigen::VectorXd result = zero();
  for (std::size_t i = mechanism.steps.size(); i-- > 0;) {
    const TreeStep& step = mechanism.steps[i];
    const Joint& joint = mechanism.joints[step.joint.index()];
    const WrenchSize& size = sizes[step.child];
    const Vector3& to = kinematics.poses[step.child].position;
    for (std::uint32_t k = joint.v; k < joint.v + joint.nv; ++k) {
      const Column& c = kinematics.columns[k];
      result[k] = c.angular.norm() * (size.moment + (to - c.point).norm() * size.force) + c.linear.norm() * size.force;
    }
    sizes[step.parent].moment += size.moment + size.force * (to - kinematics.poses[step.parent].position).norm();
    sizes[step.parent].force += size.force;
  }
  // Rotations, motions and wrenches each take a few operations for every body on the way.
  return 8.0 * deepest * eps * result;
}

}  // namespace koppel::test
