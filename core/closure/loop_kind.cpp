#include "closure/loop_kind.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

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

/// The direction that all translations are across; zero if they go all ways.
Vector3 across_translations(std::span<const Column> motions) {
  Eigen::Matrix3Xd directions(3, static_cast<Eigen::Index>(std::max<std::size_t>(motions.size(), 3)));
  directions.setZero();
  for (std::size_t i = 0; i < motions.size(); ++i) {
    directions.col(static_cast<Eigen::Index>(i)) = motions[i].linear.normalized();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3Xd> svd(directions, Eigen::ComputeFullU);
  return svd.singularValues()[2] <= tolerance ? Vector3(svd.matrixU().col(2)) : Vector3::Zero();
}

/// The normal of the planes in which everything moves; zero if there is none.
Vector3 plane_normal(std::span<const Column> motions, double length) {
  Vector3 normal = Vector3::Zero();
  for (const Column& motion : motions) {
    const Elementary e = elementary(motion, length);
    if (e.axis && normal.isZero()) normal = *e.axis;
  }
  if (normal.isZero()) return across_translations(motions);
  for (const Column& motion : motions) {
    const Elementary e = elementary(motion, length);
    const double off = e.axis ? normal.cross(*e.axis).norm() : std::abs(normal.dot(e.direction));
    if (e.slides || off > tolerance) return Vector3::Zero();
  }
  return normal;
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
  const Vector3 normal = plane_normal(motions, length);
  if (!normal.isZero()) return {LoopKind::planar, normal, Vector3::Zero()};
  if (const auto centre = common_point(motions, length)) return {LoopKind::spherical, Vector3::Zero(), *centre};
  return {};
}

}  // namespace koppel
