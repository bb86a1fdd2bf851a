#include "dynamics/chart.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "mechanism/state.hpp"
#include "spatial/rotation_vector.hpp"
#include "spatial/unit_vector.hpp"

namespace koppel {
namespace {

/// Rates along the tangents at n(delta) = cos|w| n0 + sin|w|/|w| w, w = rate_axes(n0) delta, from those of delta.
Eigen::Matrix2d unit_vector_rates(const Vector3& base, const Eigen::Vector2d& delta) {
  const Eigen::Matrix<double, 3, 2> t = rate_axes<double>(base);
  const Vector3 w = t * delta;
  const double angle = w.norm(), square = angle * angle;
  const bool small = angle < 1e-3;
  const double sinc = small ? 1.0 - square / 6.0 : std::sin(angle) / angle;
  const double sinc_slope = small ? -1.0 / 3.0 + square / 30.0 : (std::cos(angle) - sinc) / square;  // over the angle
  const Vector3 n = std::cos(angle) * base + sinc * w;
  const Eigen::RowVector2d along = w.transpose() * t;
  const Eigen::Matrix<double, 3, 2> slope = -sinc * base * along + sinc * t + sinc_slope * w * along;
  return rate_axes<double>(n.normalized()).transpose() * slope;
}

}  // namespace

Chart::Chart(const Mechanism& mechanism) : mechanism_(mechanism), base_(Eigen::VectorXd::Zero(mechanism.nq)) {
  for (const StateBlock& block : mechanism.blocks) {
    if (!is_scalar(block.kind)) curved_.push_back(block);
  }
}

void Chart::position(const Eigen::VectorXd& delta, Eigen::VectorXd& q) const { integrate(mechanism_, base_, delta, q); }

void Chart::coordinates(const Eigen::VectorXd& q, Eigen::VectorXd& delta) const {
  difference(mechanism_, base_, q, delta);
}

void Chart::rates(const Eigen::VectorXd& delta, const Eigen::VectorXd& v, Eigen::VectorXd& delta_rate) const {
  delta_rate = v;
  for (const StateBlock& block : curved_) {
    if (block.kind == BlockKind::quaternion) {
      delta_rate.segment<3>(block.v) =
          right_jacobian_inverse<double>(Vector3(delta.segment<3>(block.v))) * v.segment<3>(block.v);
    } else {
      const Eigen::Matrix2d to_rates = unit_vector_rates(base_.segment<3>(block.q), delta.segment<2>(block.v));
      delta_rate.segment<2>(block.v) = to_rates.inverse() * v.segment<2>(block.v);
    }
  }
}

double Chart::greatest_turn(const Eigen::VectorXd& delta) const {
  double greatest = 0.0;
  for (const StateBlock& block : curved_) {
    greatest = std::max(greatest, delta.segment(block.v, static_cast<Eigen::Index>(rate_count(block.kind))).norm());
  }
  return greatest;
}

}  // namespace koppel
