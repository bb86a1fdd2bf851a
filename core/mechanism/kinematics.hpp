// Forward kinematics of all nodes along the spanning tree: position, velocity, acceleration (K-II-2.1). Linear in the
// number of joints; nothing is allocated.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "mechanism/mechanism.hpp"
#include "mechanism/state.hpp"

namespace koppel {

/// Results of forward kinematics; scratch of one thread. World axes throughout.
struct Kinematics {
  explicit Kinematics(const Mechanism& mechanism);

  std::vector<Pose> poses;           ///< of each node in the world
  std::vector<Pose> near, far;       ///< of each step: the joint's two frames in the world
  std::vector<Column> columns;       ///< of each rate (those of the tree)
  std::vector<FrameMotion> motions;  ///< of each node, taken at its origin
  JointId culprit;                   ///< the joint whose plugin failed, if a function below returned false
};

/// Poses of all nodes and the columns of all tree rates, at q.
bool forward_position(const Mechanism& mechanism, const double* q, Kinematics& kinematics);

/// Velocities and accelerations of all nodes, for given rates and their derivatives; after forward_position at the same
/// q.
bool forward_motion(const Mechanism& mechanism, const double* q, const double* v, const double* a,
                    Kinematics& kinematics);

/// The world pose of a frame that is fixed on a node.
inline Pose pose_of(const Kinematics& kinematics, Node node, const Pose& in_node) {
  return kinematics.poses[node] * in_node;
}

/// The motion of a frame that is fixed on a node, taken at the frame's origin.
inline FrameMotion motion_of(const Kinematics& kinematics, Node node, const Vector3& in_node) {
  FrameMotion motion = kinematics.motions[node];
  motion.shift(kinematics.poses[node] * in_node);
  return motion;
}

/// How frame b moves relative to frame a, in the axes of b at its origin.
struct RelativeTwist {
  Vector6 twist;  ///< [angular; linear]
  Vector6 rate;   ///< derivative of the twist's components
};
RelativeTwist relative_twist(const Pose& a, const FrameMotion& motion_a, const Pose& b, const FrameMotion& motion_b);

/// Geometric Jacobian of a frame (K-II-2.4.1): 6 x nv, [angular; linear] at its origin, world axes. After
/// forward_position.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;
void frame_jacobian(const Mechanism& mechanism, const Kinematics& kinematics, Node node, const Vector3& in_node,
                    Jacobian& jacobian);

/// Its time derivative (K-II-2.4.3) at the rates v. After forward_motion.
bool frame_jacobian_rate(const Mechanism& mechanism, const double* q, const double* v, Kinematics& kinematics,
                         Node node, const Vector3& in_node, Jacobian& rate);

}  // namespace koppel
