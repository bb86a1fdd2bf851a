// Closure as a Ceres least-squares problem: one residual block for each loop and constraint with analytic Jacobians,
// manifolds for quaternions and unit vectors, driven coordinates held constant. Assembles from far away
// and copes with redundant and singular cases; the verdict on its result is not Ceres' but the residual's.
#pragma once

#include <cstdint>
#include <memory>

#include "closure/newton.hpp"
#include "closure/work.hpp"

namespace koppel {

class CeresClosure {
 public:
  explicit CeresClosure(Work& work);
  ~CeresClosure();

  struct Result {
    bool plugin_failed = false;
    std::uint32_t iterations = 0;
  };
  /// Moves work.q to the nearest least-squares minimum. Afterwards work.equations stand at work.q.
  Result solve(double time, std::uint32_t max_iterations, InputsAre inputs);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace koppel
