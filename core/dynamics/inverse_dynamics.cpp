#include "dynamics/inverse_dynamics.hpp"

#include "dynamics/composite_inertia.hpp"

namespace koppel {

namespace {

PlainWrench cost(const SpatialInertia& inertia, const Matrix3& of_node, const FrameMotion& motion,
                 const Plain3& gravity) {
  const PlainMatrix3 rotation(of_node);
  const Plain3 turn(motion.angular_velocity), turn_rate(motion.angular_acceleration);
  const Plain3 centre = rotation * Plain3(inertia.centre);
  const Plain3 acceleration =
      Plain3(motion.acceleration) + turn_rate.cross(centre) + turn.cross(turn.cross(centre)) - gravity;
  const Plain3 force = inertia.mass * acceleration;
  // Euler's equations in body axes: there the tensor is constant.
  const PlainSymmetric3 tensor = PlainSymmetric3::of(inertia.about_centre);
  const Plain3 body_turn = rotation.transposed_times(turn);
  const Plain3 moment = tensor * rotation.transposed_times(turn_rate) + body_turn.cross(tensor * body_turn);
  return {rotation * moment + centre.cross(force), force};
}

/// What the motion of each node costs by itself, less what acts on it.
void start(const Mechanism& mechanism, const Inertias& inertias, const Kinematics& kinematics, const Vector3& g,
           const std::vector<Wrench>& on_nodes, std::vector<Wrench>& carried) {
  const Plain3 gravity(g);
  for (Node node = 0; node < mechanism.nodes; ++node) {
    PlainWrench wrench;
    if (inertias.has_mass[node]) {
      wrench = cost(inertias.of_node[node], kinematics.poses[node].rotation, kinematics.motions[node], gravity);
    }
    if (!on_nodes.empty()) wrench -= PlainWrench(on_nodes[node]);
    wrench.store(carried[node]);
  }
}

}  // namespace

Wrench inertial_wrench(const SpatialInertia& inertia, const Matrix3& rotation, const FrameMotion& motion,
                       const Vector3& gravity) {
  Wrench result;
  cost(inertia, rotation, motion, Plain3(gravity)).store(result);
  return result;
}

void inverse_dynamics(const Mechanism& mechanism, const Inertias& inertias, const Kinematics& kinematics,
                      const Vector3& gravity, const std::vector<Wrench>& on_nodes, std::vector<Wrench>& carried,
                      Eigen::VectorXd& efforts) {
  efforts.setZero();
  start(mechanism, inertias, kinematics, gravity, on_nodes, carried);
  for (std::size_t i = mechanism.steps.size(); i-- > 0;) {
    const TreeStep& step = mechanism.steps[i];
    const PlainWrench wrench(carried[step.child]);
    const Plain3 origin(kinematics.poses[step.child].position);
    const Joint& joint = mechanism.joints[step.joint.index()];
    for (std::uint32_t k = joint.v; k < joint.v + joint.nv; ++k) {
      const Column& column = kinematics.columns[k];
      const Plain3 moment = wrench.moment + (origin - Plain3(column.point)).cross(wrench.force);
      efforts[k] = Plain3(column.angular).dot(moment) + Plain3(column.linear).dot(wrench.force);
    }
    PlainWrench parent(carried[step.parent]);
    parent += wrench.moved(origin - Plain3(kinematics.poses[step.parent].position));
    parent.store(carried[step.parent]);
  }
}

void joint_wrenches(const Mechanism& mechanism, const Kinematics& kinematics, const std::vector<Wrench>& carried,
                    std::vector<Wrench>& of_steps) {
  for (std::size_t i = 0; i < mechanism.steps.size(); ++i) {
    const TreeStep& step = mechanism.steps[i];
    const Vector3& outlet = (step.reversed ? kinematics.near[i] : kinematics.far[i]).position;
    const Wrench on_child = shifted<>(carried[step.child], Vector3(outlet - kinematics.poses[step.child].position));
    of_steps[i] = step.reversed ? -on_child : on_child;
  }
}

}  // namespace koppel
