#include "closure/loop_kind.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "closure/decompositions.hpp"

namespace koppel {
namespace {

const double tolerance = std::sqrt(std::numeric_limits<double>::epsilon());

/// A motion as a screw in the world: with an axis, or a direction only.
struct Elementary {
  std::optional<Vector3> axis;  ///< direction, if it turns
  Vector3 direction;            ///< of the translation, if it does not turn
  bool slides = false;          ///< turns and moves along its axis, too
};

Elementary elementary(const Column& motion, double length) {
  const double turning = motion.angular.norm() * length, sliding = motion.linear.norm();
  if (!(turning > tolerance * sliding)) return {std::nullopt, motion.linear.normalized(), false};
  const Vector3 axis = motion.angular.normalized();
  return {axis, Vector3::Zero(), std::abs(axis.dot(motion.linear)) > tolerance * turning};
}

/// Of directions: how many are independent, and the one that all are across if not all three are.
struct Directions {
  int rank = 0;
  Vector3 across = Vector3::Zero();
};

Directions translations(std::span<const Column> motions) {
  const auto count = static_cast<Eigen::Index>(std::max<std::size_t>(motions.size(), 3));
  Eigen::MatrixXd directions = Eigen::MatrixXd::Zero(3, count);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    directions.col(static_cast<Eigen::Index>(i)) = motions[i].linear.normalized();
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(directions, Eigen::ComputeFullU);
  const auto rank = static_cast<int>((svd.singularValues().array() > tolerance).count());
  return {rank, rank < 3 ? Vector3(svd.matrixU().col(2)) : Vector3::Zero()};
}

/// Loops in which all axes are parallel, or nothing turns; nothing of others.
std::optional<LoopFreedoms> parallel(std::span<const Column> motions, double length) {
  const Column* first = nullptr;
  for (const Column& motion : motions) {
    if (first == nullptr && elementary(motion, length).axis) first = &motion;
  }
  if (first == nullptr) {
    const Directions directions = translations(motions);
    const LoopKind kind = directions.rank < 3 ? LoopKind::planar : LoopKind::spatial;
    return LoopFreedoms{kind, directions.rank, directions.across, Vector3::Zero()};
  }
  const Vector3 normal = first->angular.normalized();
  bool along = false, across = false;
  for (const Column& motion : motions) {
    const Elementary e = elementary(motion, length);
    if (e.axis && normal.cross(*e.axis).norm() > tolerance) return std::nullopt;
    along |= e.slides || (!e.axis && std::abs(normal.dot(e.direction)) > tolerance);
    across |= e.axis ? normal.cross(motion.point - first->point).norm() > tolerance * length
                     : normal.cross(e.direction).norm() > tolerance;
  }
  const int conditions = (across ? 3 : 1) + (along ? 1 : 0);
  if (along) return LoopFreedoms{LoopKind::spatial, conditions, Vector3::Zero(), Vector3::Zero()};
  return LoopFreedoms{LoopKind::planar, conditions, normal, Vector3::Zero()};
}

/// The point that all axes meet in.
std::optional<Vector3> common_point(std::span<const Column> motions, double length) {
  // The sum of the squared distances from the axes is least where M p = b.
  Matrix3 m = Matrix3::Zero();
  Vector3 b = Vector3::Zero();
  for (const Column& motion : motions) {
    const Elementary e = elementary(motion, length);
    if (!e.axis || e.slides) return std::nullopt;
    const Matrix3 across = Matrix3::Identity() - *e.axis * e.axis->transpose();
    m += across;
    b += across * motion.point;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(m);
  if (!(solver.eigenvalues()[0] > tolerance * solver.eigenvalues()[2])) return std::nullopt;
  const Vector3 p = m.ldlt().solve(b);
  for (const Column& motion : motions) {
    if (motion.angular.normalized().cross(p - motion.point).norm() > tolerance * length) return std::nullopt;
  }
  return p;
}

}  // namespace

LoopFreedoms loop_kind(std::span<const Column> motions, double length) {
  if (motions.empty()) return {};
  if (const auto found = parallel(motions, length)) return *found;
  if (const auto centre = common_point(motions, length)) return {LoopKind::spherical, 3, Vector3::Zero(), *centre};
  return {};
}

}  // namespace koppel
