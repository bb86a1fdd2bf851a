#include "dynamics/forward_dynamics.hpp"

#include <limits>

#include "dynamics/inverse_dynamics.hpp"

namespace koppel {

ArticulatedBodies::ArticulatedBodies(const TreeLayout& layout, const Inertias& inertias)
    : layout_(layout), inertias_(inertias), bodies_(layout.mechanism().nodes), rates_(layout.rates()) {}

bool ArticulatedBodies::evaluate(const Kinematics& kinematics, const Vector3& gravity,
                                 const std::vector<Wrench>& on_nodes, const Eigen::VectorXd& efforts,
                                 Eigen::VectorXd& accelerations) {
  start(kinematics, gravity, on_nodes);
  if (!inwards(kinematics, efforts)) return false;
  accelerations.setZero();
  outwards(kinematics, accelerations);
  return true;
}

void ArticulatedBodies::start(const Kinematics& kinematics, const Vector3& gravity,
                              const std::vector<Wrench>& on_nodes) {
  for (const TreeLayout::Step& step : layout_.steps()) {
    const Node node = step.child;
    Body body;
    if (inertias_.has_mass[node]) {
      const PlainMatrix3 rotation(kinematics.poses[node].rotation);
      const CompositeInertia inertia = CompositeInertia::of(inertias_.of_node[node], rotation);
      const FrameMotion& motion = kinematics.motions[node];
      const Plain3 turn(motion.angular_velocity);
      body.inertia = ArticulatedInertia::of(inertia);
      body.bias = inertia(Plain3(motion.angular_acceleration), Plain3(motion.acceleration) - Plain3(gravity));
      // The centrifugal part, about the origin as well (Newton, Euler).
      body.bias += {turn.cross(inertia.tensor * turn), turn.cross(turn.cross(inertia.first_moment))};
      body.angular_size = inertia.tensor.trace();
      body.linear_size = 3.0 * inertia.mass;
    }
    if (!on_nodes.empty()) body.bias -= PlainWrench(on_nodes[node]);
    bodies_[node] = body;
  }
}

bool ArticulatedBodies::inwards(const Kinematics& kinematics, const Eigen::VectorXd& efforts) {
  for (std::size_t i = layout_.steps().size(); i-- > 0;) {
    const TreeLayout::Step& step = layout_.steps()[i];
    Body body = bodies_[step.child];
    const Plain3 origin(kinematics.poses[step.child].position);
    const double angular_size = body.inertia.angular.trace(), linear_size = body.inertia.linear.trace();
    for (std::uint32_t p = step.first + step.rates; p-- > step.first;) {
      const std::uint32_t k = layout_.rate(p);
      if (give_way(kinematics.columns[k], origin, efforts[k], body, rates_[p])) continue;
      loose_ = k;
      return false;
    }
    if (step.parent == 0) continue;
    Body& parent = bodies_[step.parent];
    const Plain3 arm = origin - Plain3(kinematics.poses[step.parent].position);
    parent.inertia.add(body.inertia, arm);
    parent.bias += body.bias.moved(arm);
    parent.angular_size += 2.0 * (angular_size + linear_size * arm.squared_norm());
    parent.linear_size += linear_size;
  }
  return true;
}

/// Lets a rate go: what is left resists in all other directions only.
inline bool ArticulatedBodies::give_way(const Column& column, const Plain3& origin, double effort, Body& body,
                                        Rate& rate) const {
  const Plain3 angular(column.angular);
  const Plain3 linear = Plain3(column.linear) + angular.cross(origin - Plain3(column.point));
  const PlainWrench resistance = body.inertia(angular, linear);
  const double pivot = angular.dot(resistance.moment) + linear.dot(resistance.force);
  const double size = body.angular_size * angular.squared_norm() + body.linear_size * linear.squared_norm();
  if (!(pivot > 32.0 * std::numeric_limits<double>::epsilon() * size)) return false;
  const double inverse = 1.0 / pivot;
  const double left = effort - angular.dot(body.bias.moment) - linear.dot(body.bias.force);
  rate = {angular, linear, resistance, inverse, left};
  body.inertia.reduce(inverse, resistance);
  body.bias += (inverse * left) * resistance;
  return true;
}

void ArticulatedBodies::outwards(const Kinematics& kinematics, Eigen::VectorXd& accelerations) {
  for (const TreeLayout::Step& step : layout_.steps()) {
    Plain3 angular, linear;
    if (step.parent != 0) {
      const Body& parent = bodies_[step.parent];
      const Plain3 arm = Plain3(kinematics.poses[step.child].position) - Plain3(kinematics.poses[step.parent].position);
      angular = parent.angular;
      linear = parent.linear + angular.cross(arm);
    }
    for (std::uint32_t p = step.first; p < step.first + step.rates; ++p) {
      const Rate& rate = rates_[p];
      const double taken = rate.resistance.moment.dot(angular) + rate.resistance.force.dot(linear);
      const double acceleration = rate.inverse * (rate.effort - taken);
      angular += acceleration * rate.angular;
      linear += acceleration * rate.linear;
      accelerations[layout_.rate(p)] = acceleration;
    }
    bodies_[step.child].angular = angular;
    bodies_[step.child].linear = linear;
  }
}

FactoredDynamics::FactoredDynamics(const TreeLayout& layout, const Inertias& inertias)
    : layout_(layout),
      inertias_(inertias),
      mass_matrix_(layout, inertias),
      matrix_(layout),
      factors_(layout),
      carried_(layout.mechanism().nodes) {}

bool FactoredDynamics::factorise(const Kinematics& kinematics) {
  mass_matrix_.evaluate(kinematics, matrix_);
  return factors_.factorise(matrix_);
}

bool FactoredDynamics::evaluate(const Kinematics& kinematics, const Vector3& gravity,
                                const std::vector<Wrench>& on_nodes, const Eigen::VectorXd& efforts,
                                Eigen::VectorXd& accelerations) {
  if (!factorise(kinematics)) return false;
  inverse_dynamics(layout_.mechanism(), inertias_, kinematics, gravity, on_nodes, carried_, accelerations);
  for (std::uint32_t p = 0; p < layout_.rates(); ++p) {
    const std::uint32_t k = layout_.rate(p);
    accelerations[k] = efforts[k] - accelerations[k];
  }
  factors_.solve(accelerations.data());
  return true;
}

}  // namespace koppel
