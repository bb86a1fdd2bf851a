// How a closure went.
#pragma once

#include <cstdint>

namespace koppel {

enum class Verdict { open, closed, not_found, retry, limit, unreachable };
enum class SolverUsed { none, newton, ceres, flow };

struct Report {
  Verdict verdict = Verdict::open;
  SolverUsed solver = SolverUsed::none;  ///< the last that was used
  std::uint32_t iterations = 0;          ///< of all solvers together
  std::uint32_t rank = 0;                ///< of the equations with respect to the unknowns
  double residual = 0.0;                 ///< greatest scaled equation; of a failure: the least that was reached
  std::uint32_t open_row = 0;            ///< of a failure: the equation that stayed open most there; rows: none of them
  double condition = 1.0;                ///< ratio of extreme singular values that count, estimated
  double coordinate_error = 0.0;         ///< estimated greatest error of an unknown, in radians' size
  std::uint32_t change_points = 0;       ///< that were passed
  double change_point_time = 0.0;        ///< of the last of them
  std::int32_t limit_input = -1;         ///< of the verdict limit: the input that goes no further
  double limit_time = 0.0;               ///< when the drives reach it
  double limit_value = 0.0;              ///< of the input
  std::int32_t drive_instead = -1;       ///< the coordinate that moves most there, in q
  std::uint32_t limits = 0;              ///< that were passed
  double pace = 1.0;                     ///< time of the drives by path parameter
};

}  // namespace koppel
