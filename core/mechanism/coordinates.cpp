#include "mechanism/coordinates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "spatial/rotation_vector.hpp"
#include "spatial/unit_vector.hpp"

namespace koppel {
namespace {

Vector4 quaternion(const double* q) { return {q[0], q[1], q[2], q[3]}; }
Vector3 vector(const double* q) { return {q[0], q[1], q[2]}; }

template <typename Vector>
void store(const Vector& from, double* to) {
  std::copy(from.data(), from.data() + from.size(), to);
}

}  // namespace

void integrate_block(BlockKind kind, const double* q, const double* delta, double* result) {
  switch (kind) {
    case BlockKind::line:
    case BlockKind::angle: result[0] = q[0] + delta[0]; return;
    case BlockKind::quaternion: {
      const Vector4 turn = quaternion_of_rotation_vector<double>(vector(delta));
      store(quaternion_product<double>(quaternion(q), turn).normalized(), result);
      return;
    }
    case BlockKind::unit_vector: {
      const Vector3 n = vector(q);
      const Vector3 step = rate_axes<double>(n) * Eigen::Vector2d(delta[0], delta[1]);
      const double angle = step.norm();
      const double slope = angle > 0.0 ? std::sin(angle) / angle : 1.0;
      store((std::cos(angle) * n + slope * step).normalized(), result);
      return;
    }
  }
}

void difference_block(BlockKind kind, const double* from, const double* to, double* delta) {
  switch (kind) {
    case BlockKind::line:
    case BlockKind::angle: delta[0] = to[0] - from[0]; return;
    case BlockKind::quaternion: {
      const Vector4 inverse(from[0], -from[1], -from[2], -from[3]);
      store(rotation_vector_of_quaternion<double>(quaternion_product<double>(inverse, quaternion(to))), delta);
      return;
    }
    case BlockKind::unit_vector: {
      const Vector3 n = vector(from), m = vector(to);
      const Vector3 across = m - n.dot(m) * n;
      const double sine = across.norm();
      const double angle = std::atan2(sine, n.dot(m));
      if (sine == 0.0) {  // the same, or opposite: then every way is as long
        delta[0] = angle;
        delta[1] = 0.0;
        return;
      }
      const Eigen::Vector2d components = rate_axes<double>(n).transpose() * across;
      store(Eigen::Vector2d(angle / sine * components), delta);
      return;
    }
  }
}

void normalise_block(BlockKind kind, double* q) {
  if (is_scalar(kind)) return;
  const std::size_t n = coordinate_count(kind);
  const double norm = std::sqrt(std::inner_product(q, q + n, q, 0.0));
  if (!(norm > 0.0)) return neutral_block(kind, q);
  // A second division would change bits of what is normal already.
  if (std::abs(norm - 1.0) <= 2.0 * std::numeric_limits<double>::epsilon()) return;
  for (std::size_t i = 0; i < n; ++i) q[i] /= norm;
}

void tangent_block(BlockKind kind, const double* q, double* jacobian) {
  switch (kind) {
    case BlockKind::line:
    case BlockKind::angle: jacobian[0] = 1.0; return;
    case BlockKind::quaternion: {
      const double w = q[0] / 2, x = q[1] / 2, y = q[2] / 2, z = q[3] / 2;
      const double rows[12] = {-x, -y, -z, w, -z, y, z, w, -x, -y, x, w};
      std::copy(rows, rows + 12, jacobian);
      return;
    }
    case BlockKind::unit_vector: {
      const Eigen::Matrix<double, 3, 2> t = rate_axes<double>(vector(q));
      for (Eigen::Index i = 0; i < 3; ++i) {
        jacobian[2 * i] = t(i, 0);
        jacobian[2 * i + 1] = t(i, 1);
      }
      return;
    }
  }
}

void neutral_block(BlockKind kind, double* q) {
  std::fill(q, q + coordinate_count(kind), 0.0);
  if (kind == BlockKind::quaternion) q[0] = 1.0;
  if (kind == BlockKind::unit_vector) q[2] = 1.0;
}

}  // namespace koppel
