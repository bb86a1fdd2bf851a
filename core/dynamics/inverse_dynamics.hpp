// Inverse dynamics of the spanning tree by the recursive Newton-Euler algorithm: linear in the number of bodies.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "dynamics/inertias.hpp"
#include "mechanism/kinematics.hpp"
#include "mechanism/mechanism.hpp"
#include "spatial/twist.hpp"

namespace koppel {

/// Efforts (nv) [N m, N] of the tree's joints for the motion that stands in the kinematics (forward_motion), against
/// gravity [m/s^2] and the wrenches that act on the nodes (empty: none): world axes, moment about the node's origin.
/// Zero at joints where a loop is cut. `carried`: scratch, one for each node; it comes out as the wrench that each
/// node's joint puts on it, about the node's origin.
void inverse_dynamics(const Mechanism& mechanism, const Inertias& inertias, const Kinematics& kinematics,
                      const Vector3& gravity, const std::vector<Wrench>& on_nodes, std::vector<Wrench>& carried,
                      Eigen::VectorXd& efforts);

/// What each joint of the tree puts on the body at its outlet (on that at its inlet: the opposite), from what
/// inverse_dynamics() has left in `carried`: one for each of Mechanism::steps, world axes, moment about the origin of
/// the outlet frame. Efforts are its parts along the joint's freedoms; the rest is the reaction.
void joint_wrenches(const Mechanism& mechanism, const Kinematics& kinematics, const std::vector<Wrench>& carried,
                    std::vector<Wrench>& of_steps);

/// What a node's own motion costs: the rate of its momentum less its weight, world axes, about its origin (Newton,
/// Euler). motion: taken at the node's origin.
Wrench inertial_wrench(const SpatialInertia& inertia, const Matrix3& rotation, const FrameMotion& motion,
                       const Vector3& gravity);

}  // namespace koppel
