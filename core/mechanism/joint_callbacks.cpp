// Joints whose motion their plugin computes: every answer is checked, what the plugin leaves out is formed numerically.
#include <algorithm>
#include <array>
#include <cmath>

#include "mechanism/coordinates.hpp"
#include "mechanism/difference.hpp"
#include "mechanism/joint.hpp"
#include "spatial/rotation_vector.hpp"

namespace koppel {
namespace {

using JointVector = std::array<double, max_joint_coordinates>;

bool all_finite(const double* values, std::size_t count) {
  return std::all_of(values, values + count, [](double x) { return std::isfinite(x); });
}

/// A pose as plugin.h lays it out.
std::array<double, 12> pose_array(const Pose& pose) {
  std::array<double, 12> out;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(out.data()) = pose.rotation;
  std::copy(pose.position.data(), pose.position.data() + 3, out.begin() + 9);
  return out;
}

}  // namespace

void Joint::without_zero(const double* joint_q, double* shifted) const {
  std::copy(joint_q, joint_q + nq, shifted);
  for (const JointBlock& block : blocks) {
    if (is_scalar(block.kind)) shifted[block.q] -= block.described.zero;
  }
}

bool Joint::callback_pose(const double* joint_q, Pose& result) const {
  JointVector q_shifted;
  without_zero(joint_q, q_shifted.data());
  std::array<double, 12> out;
  out.fill(std::nan(""));
  const void* instance = instance_.get();
  if (type->calls.pose(1, &instance, q_shifted.data(), out.data()) < 0 || !all_finite(out.data(), 12)) return false;
  result.rotation = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(out.data());
  result.position = Vector3(out[9], out[10], out[11]);
  return true;
}

bool Joint::callback_subspace(const double* joint_q, Subspace& s) const {
  if (type->calls.subspace == nullptr) {
    Pose here;
    if (!callback_pose(joint_q, here)) return false;
    const auto twist_to = [&](const double* delta, Vector6& out) {
      JointVector moved;
      integrate(joint_q, delta, moved.data());
      Pose there;
      if (!callback_pose(moved.data(), there)) return false;
      const Pose step = relative_pose(here, there);
      out << rotation_vector_of_rotation<double>(step.rotation), step.position;
      return true;
    };
    return differentiate_along_rates(*this, line_step_, twist_to, s);
  }
  JointVector q_shifted;
  without_zero(joint_q, q_shifted.data());
  s.setConstant(std::nan(""));
  const void* instance = instance_.get();
  return type->calls.subspace(1, &instance, q_shifted.data(), s.data()) >= 0 &&
         all_finite(s.data(), static_cast<std::size_t>(s.size()));
}

bool Joint::callback_bias(const double* joint_q, const double* u, const double* w, Vector6& result) const {
  if (type->calls.bias == nullptr) {
    const auto momentary = [&](double time, Vector6& out) {
      std::array<double, max_joint_rates> delta;
      for (std::uint32_t i = 0; i < nv; ++i) delta[i] = time * u[i];
      JointVector moved;
      integrate(joint_q, delta.data(), moved.data());
      Subspace s(6, nv);
      if (!callback_subspace(moved.data(), s)) return false;
      out = s * Eigen::Map<const Eigen::VectorXd>(w, nv);
      return true;
    };
    return differentiate_along_motion(*this, line_step_, u, momentary, result);
  }
  JointVector q_shifted;
  without_zero(joint_q, q_shifted.data());
  result.setConstant(std::nan(""));
  const void* instance = instance_.get();
  return type->calls.bias(1, &instance, q_shifted.data(), u, w, result.data()) >= 0 && all_finite(result.data(), 6);
}

bool Joint::bias_by_q(const double* joint_q, const double* joint_v, Subspace& slopes) const {
  const auto bias_at = [&](const double* delta, Vector6& out) {
    JointVector moved;
    integrate(joint_q, delta, moved.data());
    return callback_bias(moved.data(), joint_v, joint_v, out);
  };
  return differentiate_along_rates(*this, line_step_, bias_at, slopes);
}

bool Joint::plugin_residual(const Pose& relative, double* residual, double* jacobian) const {
  const std::array<double, 12> in = pose_array(relative);
  const std::size_t rows = type->rows.size();
  std::fill(residual, residual + rows, std::nan(""));
  std::fill(jacobian, jacobian + 6 * rows, std::nan(""));
  const void* instance = instance_.get();
  return type->calls.implicit(1, &instance, in.data(), residual, jacobian) >= 0 && all_finite(residual, rows) &&
         all_finite(jacobian, 6 * rows);
}

bool Joint::plugin_coordinates(const Pose& relative, double* joint_q) const {
  const std::array<double, 12> in = pose_array(relative);
  JointVector q_shifted;
  without_zero(joint_q, q_shifted.data());
  const void* instance = instance_.get();
  if (type->calls.coordinates_of(1, &instance, in.data(), q_shifted.data()) < 0) return false;
  if (!all_finite(q_shifted.data(), nq)) return false;
  for (const JointBlock& block : blocks) {
    if (is_scalar(block.kind)) q_shifted[block.q] += block.described.zero;
    normalise_block(block.kind, q_shifted.data() + block.q);
  }
  std::copy(q_shifted.begin(), q_shifted.begin() + nq, joint_q);
  return true;
}

}  // namespace koppel
