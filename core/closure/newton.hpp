// Newton's method on the closure equations: rank-revealing, minimum-norm steps, halved until the residual falls.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "closure/work.hpp"

namespace koppel {

/// Residuals above this are never called closed; between rounding and this only where no further progress is possible.
inline constexpr double closed_limit = 1e-10;

enum class InputsAre { held, free };

struct NewtonOptions {
  std::uint32_t max_iterations = 50;
  double tolerance = 1e-14;  ///< of the greatest scaled residual; below it nothing more is gained
  InputsAre inputs = InputsAre::held;
};

struct NewtonResult {
  bool converged = false;
  bool plugin_failed = false;
  std::uint32_t iterations = 0;
};

/// Moves work.q to a closed position near it. Afterwards work.equations stand at work.q.
NewtonResult newton(Work& work, double time, const NewtonOptions& options);

}  // namespace koppel
