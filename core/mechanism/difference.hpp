// Numerical derivatives for joints whose plugin leaves them out: central differences of sixth order.
#pragma once

#include <array>
#include <cmath>

#include "mechanism/joint.hpp"

namespace koppel {

/// Steps of 1, 2 and 3 times h with these weights give f'(0) with an error of order h^6; odd parts only.
inline constexpr std::array<double, 3> difference_weights{45.0 / 60.0, -9.0 / 60.0, 1.0 / 60.0};

/// Columns of ds/d(delta_i) of `s(delta, out)`, one for each rate of the joint.
template <typename Function>
bool differentiate_along_rates(const Joint& joint, double line_step, const Function& s, Subspace& result) {
  for (const JointBlock& block : joint.blocks) {
    const double h = block.kind == BlockKind::line ? line_step : angle_difference_step;
    for (std::uint32_t i = block.v; i < block.v + rate_count(block.kind); ++i) {
      result.col(i).setZero();
      for (std::size_t k = 0; k < difference_weights.size(); ++k) {
        std::array<double, max_joint_rates> delta{};
        Vector6 ahead, behind;
        delta[i] = h * static_cast<double>(k + 1);
        if (!s(delta.data(), ahead)) return false;
        delta[i] = -delta[i];
        if (!s(delta.data(), behind)) return false;
        result.col(i) += difference_weights[k] / h * (ahead - behind);
      }
    }
  }
  return true;
}

/// df/dt at 0 of `f(t, out)`, where t moves the joint with the rates u; the step is chosen by the fastest of them.
template <typename Function>
bool differentiate_along_motion(const Joint& joint, double line_step, const double* u, const Function& f,
                                Vector6& result) {
  double fastest = 0.0;
  for (const JointBlock& block : joint.blocks) {
    const double step = block.kind == BlockKind::line ? line_step : angle_difference_step;
    for (std::uint32_t i = block.v; i < block.v + rate_count(block.kind); ++i) {
      fastest = std::max(fastest, std::abs(u[i]) / step);
    }
  }
  result.setZero();
  if (!(fastest > 0.0)) return true;
  const double h = 1.0 / fastest;
  for (std::size_t k = 0; k < difference_weights.size(); ++k) {
    Vector6 ahead, behind;
    if (!f(h * static_cast<double>(k + 1), ahead) || !f(-h * static_cast<double>(k + 1), behind)) return false;
    result += difference_weights[k] / h * (ahead - behind);
  }
  return true;
}

}  // namespace koppel
