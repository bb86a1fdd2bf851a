// Which joints bear what holds loops and constraints together.
#pragma once

#include <cstdint>
#include <vector>

#include "closure/equations.hpp"
#include "spatial/twist.hpp"

namespace koppel {

/// The ways through the spanning tree between the two frames of each relation. Borrows the mechanism; nothing is
/// allocated after construction.
class LoadPaths {
 public:
  explicit LoadPaths(const Mechanism& mechanism);

  /// The outlet frames of all joints in the world, where the equations stand.
  void outlets(const Equations& equations, std::vector<Pose>& frames) const;
  /// Adds what every joint bears by multipliers of the closure's scaled rows: on the body at its outlet, world axes,
  /// about the origin of its outlet frame.
  void add(const Equations& equations, const Eigen::VectorXd& multipliers, const std::vector<Pose>& outlets,
           std::vector<Wrench>& of_joints) const;

 private:
  template <typename Visit>
  void for_each_step(const Relation& relation, const Visit& visit) const;

  const Mechanism& mechanism_;
  std::vector<std::uint32_t> step_to_, depth_;  ///< by node
};

}  // namespace koppel
