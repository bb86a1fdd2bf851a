// What joints and drives bear.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "spatial/twist.hpp"

namespace koppel {

struct Loads {
  /// What each joint, with the drive and the forces on its coordinates, puts on the body at its outlet (on that at its
  /// inlet: the opposite): axes and origin of the outlet frame.
  std::vector<Wrench> joints;
  /// nv [N m, N]: what drives deliver; along rates that nothing drives what is missing to their accelerations, zero
  /// where these are those of the forces.
  Eigen::VectorXd efforts;
};

}  // namespace koppel
