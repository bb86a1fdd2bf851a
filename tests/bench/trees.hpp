// Open trees as the literature times them: an arm, chains, a humanoid; with states at random, and exact answers.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "dynamics/inertias.hpp"
#include "mechanism/mechanism.hpp"
#include "plugin/registry.hpp"

namespace koppel::bench {

/// What one evaluation is given.
struct TreeState {
  Eigen::VectorXd q, v, a, efforts;
};

struct Tree {
  std::string name;
  std::shared_ptr<Registry> registry;  ///< owns the types that the mechanism uses
  std::shared_ptr<const Mechanism> mechanism;
  Inertias inertias;
  std::vector<TreeState> states;
};

/// Seven revolute joints, as of a usual arm.
Tree arm7();
/// n revolute joints in a row, 0.2 m apart, directions at random.
Tree chain(int n);
/// A free trunk, two legs with six joints each, a waist with two that carries two arms with five: 30 rates.
Tree humanoid30();

}  // namespace koppel::bench
