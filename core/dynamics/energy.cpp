#include "dynamics/energy.hpp"

namespace koppel {
namespace {

/// Calls visit(inertia, pose, motion, arm from the node's origin to its centre of mass) for all nodes with mass.
template <typename Visit>
void for_each_body(const Inertias& inertias, const Kinematics& kinematics, const Visit& visit) {
  for (std::size_t node = 0; node < inertias.of_node.size(); ++node) {
    if (!inertias.has_mass[node]) continue;
    const Pose& pose = kinematics.poses[node];
    const Vector3 arm = pose.rotation * inertias.of_node[node].centre;
    visit(inertias.of_node[node], pose, kinematics.motions[node], arm);
  }
}

Vector3 velocity_at_centre(const FrameMotion& motion, const Vector3& arm) {
  return motion.velocity + motion.angular_velocity.cross(arm);
}

/// The centre of mass. Places are taken from the first body on: a far origin costs no digits of the sum.
Vector3 centre_of_mass(const Inertias& inertias, const Kinematics& kinematics, double& mass) {
  Vector3 first = Vector3::Zero(), moment = Vector3::Zero();
  mass = 0.0;
  for_each_body(inertias, kinematics,
                [&](const SpatialInertia& body, const Pose& pose, const FrameMotion&, const Vector3& arm) {
                  if (!(body.mass > 0.0)) return;
                  if (mass == 0.0) first = pose.position;
                  moment += body.mass * (pose.position - first + arm);
                  mass += body.mass;
                });
  if (mass == 0.0) return first;
  return first + moment / mass;
}

}  // namespace

double kinetic_energy(const Inertias& inertias, const Kinematics& kinematics) {
  double twice = 0.0;
  for_each_body(inertias, kinematics,
                [&](const SpatialInertia& body, const Pose& pose, const FrameMotion& motion, const Vector3& arm) {
                  const Vector3 turn = pose.rotation.transpose() * motion.angular_velocity;
                  const Vector3 spin = body.about_centre * turn;
                  twice += body.mass * velocity_at_centre(motion, arm).squaredNorm() + turn.dot(spin);
                });
  return 0.5 * twice;
}

double potential_energy(const Inertias& inertias, const Kinematics& kinematics, const Vector3& gravity) {
  double mass = 0.0;
  const Vector3 centre = centre_of_mass(inertias, kinematics, mass);
  return -mass * gravity.dot(centre);
}

MechanicalState mechanical_state(const Inertias& inertias, const Kinematics& kinematics, const Vector3& gravity) {
  MechanicalState state;
  state.kinetic = kinetic_energy(inertias, kinematics);
  state.centre = centre_of_mass(inertias, kinematics, state.mass);
  state.potential = -state.mass * gravity.dot(state.centre);
  for_each_body(inertias, kinematics,
                [&](const SpatialInertia& body, const Pose&, const FrameMotion& motion, const Vector3& arm) {
                  state.momentum += body.mass * velocity_at_centre(motion, arm);
                });
  if (state.mass > 0.0) state.velocity = state.momentum / state.mass;
  for_each_body(inertias, kinematics,
                [&](const SpatialInertia& body, const Pose& pose, const FrameMotion& motion, const Vector3& arm) {
                  const Vector3 spin = body.about_centre * (pose.rotation.transpose() * motion.angular_velocity);
                  const Vector3 apart = pose.position - state.centre + arm;
                  const Vector3 drift = velocity_at_centre(motion, arm) - state.velocity;
                  state.angular_momentum += pose.rotation * spin + body.mass * apart.cross(drift);
                });
  return state;
}

}  // namespace koppel
