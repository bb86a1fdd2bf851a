#include "mechanism/face.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/LU>
#include <Eigen/QR>

#include "spatial/rotation_vector.hpp"
#include "spatial/vector.hpp"

namespace koppel {
namespace {

constexpr double parallel_tolerance = 1e-12;  // sine of the angle between axes that count as parallel

using JacobianRows = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>>;

bool parallel(const Vector3& a, const Vector3& b) { return a.cross(b).norm() <= parallel_tolerance; }

/// Angle by which r turns about the unit vector u, where r keeps u. (K-II-3.4.4b, with both normals of u.)
double angle_about(const Vector3& u, const Matrix3& r) {
  const Eigen::Matrix<double, 3, 2> t = tangents<double>(u);
  const Vector3 t1 = t.col(0), t2 = t.col(1);
  const Vector3 r1 = r * t1, r2 = r * t2;
  return std::atan2(t2.dot(r1) - t1.dot(r2), t1.dot(r1) + t2.dot(r2));
}

/// The same angle, whole turns added so that it comes nearest to `last`.
double unwrapped(double angle, double last) {
  constexpr double turn = 2.0 * std::numbers::pi;
  return angle + turn * std::round((last - angle) / turn);
}

/// theta / sin(theta) and its derivative by theta, over sin(theta): what turns a cross product into angle times axis.
struct SineRatio {
  double value;
  double slope;
};

SineRatio sine_ratio(double sine, double cosine) {
  const double theta = std::atan2(sine, cosine);
  if (theta < 1e-3) {
    const double square = theta * theta;
    return {1.0 + square * (1.0 / 6.0 + square * 7.0 / 360.0), 1.0 / 3.0 + square * (2.0 / 15.0)};
  }
  return {theta / sine, (sine - theta * cosine) / (sine * sine * sine)};
}

// Below it the cross product of two unit vectors is rounding, and says nothing of its direction.
constexpr double no_direction = 1e-14;

/// Across u, where nothing tells which way: along no axis that a scene is likely to have.
Vector3 any_way(const Vector3& u) { return tangents<double>(u) * Eigen::Vector2d(0.8, 0.6); }

}  // namespace

std::optional<Face> Face::of(const Joint& joint) {
  Face face;
  if (!joint.is_product()) {
    if (joint.type->rows.empty()) return std::nullopt;
    face.from_plugin_ = true;
    face.rows_ = joint.type->rows;
    return face;
  }
  for (const ElementaryMotion& motion : joint.motions()) {
    if (motion.kind == ElementaryMotionKind::screw || !motion.point.isZero()) return std::nullopt;
    if (motion.kind != ElementaryMotionKind::translation) {
      face.rotations_.push_back(motion);
      continue;
    }
    // A translation after a rotation is one before it only if it runs along the axis.
    for (const ElementaryMotion& before : face.rotations_) {
      if (before.kind == ElementaryMotionKind::free_rotation || !parallel(before.axis, motion.axis))
        return std::nullopt;
    }
    face.translations_.push_back(motion);
  }

  const auto& turns = face.rotations_;
  if (turns.empty()) {
    face.turning_ = Turning::none;
  } else if (turns.size() == 1) {
    face.turning_ = turns[0].kind == ElementaryMotionKind::free_rotation ? Turning::free : Turning::axis;
  } else if (turns.size() == 2 && turns[0].kind == ElementaryMotionKind::rotation &&
             turns[1].kind == ElementaryMotionKind::rotation && !parallel(turns[0].axis, turns[1].axis)) {
    face.turning_ = Turning::cross;
  } else {
    return std::nullopt;
  }

  Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 3> along(3, face.translations_.size());
  for (std::size_t i = 0; i < face.translations_.size(); ++i) {
    along.col(static_cast<Eigen::Index>(i)) = face.translations_[i].axis;
  }
  if (along.cols() == 0) {
    for (int i = 0; i < 3; ++i) face.fixed_directions_.emplace_back(Vector3::Unit(i));
  } else {
    const Eigen::ColPivHouseholderQR<Matrix3> qr(
        (Matrix3() << along, Eigen::MatrixXd::Zero(3, 3 - along.cols())).finished());
    if (qr.rank() < along.cols()) return std::nullopt;
    const Matrix3 basis = qr.householderQ();
    for (Eigen::Index i = along.cols(); i < 3; ++i) face.fixed_directions_.emplace_back(basis.col(i));
    face.translation_inverse_ = (along.transpose() * along).inverse() * along.transpose();
  }

  static const char* const place[] = {"position 1", "position 2", "position 3"};
  static const char* const turn[] = {"direction 1", "direction 2", "direction 3"};
  for (std::size_t i = 0; i < face.fixed_directions_.size(); ++i) face.rows_.push_back({place[i], "m"});
  const std::size_t directions = face.turning_ == Turning::none    ? 3
                                 : face.turning_ == Turning::axis  ? 2
                                 : face.turning_ == Turning::cross ? 1
                                                                   : 0;
  for (std::size_t i = 0; i < directions; ++i) face.rows_.push_back({turn[i], "rad"});
  return face;
}

bool Face::evaluate(const Joint& joint, const Pose& pose, double* residual, double* jacobian) const {
  if (from_plugin_) return joint.plugin_residual(pose, residual, jacobian);
  JacobianRows rows(jacobian, static_cast<Eigen::Index>(rows_.size()), 6);
  rows.setZero();
  Eigen::Index i = 0;
  for (const Vector3& e : fixed_directions_) {
    residual[i] = e.dot(pose.position);
    rows.row(i).tail<3>() = pose.rotation.transpose() * e;
    ++i;
  }
  turning_rows(pose, residual + i, jacobian + 6 * i);
  return true;
}

void Face::turning_rows(const Pose& pose, double* residual, double* jacobian) const {
  const Matrix3& r = pose.rotation;
  switch (turning_) {
    case Turning::free: return;
    case Turning::none: {
      const Vector3 phi = rotation_vector_of_rotation<double>(r);
      Eigen::Map<Vector3>(residual, 3) = phi;
      JacobianRows(jacobian, 3, 6).leftCols<3>() = right_jacobian_inverse<double>(phi);
      return;
    }
    case Turning::axis: {
      // Angle times axis of the smallest turn that brings u back; both components across u.
      const Vector3& u = rotations_[0].axis;
      const Eigen::Matrix<double, 3, 2> t = tangents<double>(u);
      const Vector3 w = r * u;
      const Vector3 across = u.cross(w);
      const double sine = across.norm(), cosine = u.dot(w);
      Eigen::Map<Eigen::Vector2d> out(residual);
      JacobianRows rows(jacobian, 2, 6);
      if (cosine < 0.0 && sine < no_direction) {  // upside down: every way back is half a turn
        out = std::numbers::pi * t.transpose() * any_way(u);
        rows.leftCols<3>() = t.transpose() * r;
        return;
      }
      const SineRatio ratio = sine_ratio(sine, cosine);
      const Eigen::Vector2d components = t.transpose() * across;
      out = ratio.value * components;
      // Along a turn omega (inlet axes): dw = omega x w, d(u x w) = -skew(u) skew(w) omega,
      // d(theta) = across/sine . omega.
      const Matrix3 turn_across = -skew(u) * skew(w);
      Eigen::Matrix<double, 2, 3> by_turn = ratio.value * t.transpose() * turn_across;
      by_turn += ratio.slope * components * across.transpose();
      rows.leftCols<3>() = by_turn * r;
      return;
    }
    case Turning::cross: {
      const Vector3 &u = rotations_[0].axis, &second = rotations_[1].axis;
      const Vector3 w = r * second;
      const Vector3 across = u.cross(w);
      const double sine = across.norm();
      residual[0] = std::atan2(sine, u.dot(w)) - std::atan2(u.cross(second).norm(), u.dot(second));
      const Vector3 axis = sine > no_direction ? Vector3(across / sine) : any_way(u);
      JacobianRows(jacobian, 1, 6).leftCols<3>() = axis.transpose() * r;
      return;
    }
  }
}

bool Face::coordinates(const Joint& joint, const Pose& pose, double* joint_q) const {
  if (from_plugin_) return joint.plugin_coordinates(pose, joint_q);
  if (!translations_.empty()) {
    const Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 3, 1> s = translation_inverse_ * pose.position;
    for (std::size_t i = 0; i < translations_.size(); ++i) {
      joint_q[translations_[i].q] = s[static_cast<Eigen::Index>(i)] + translations_[i].zero;
    }
  }
  const auto set_angle = [joint_q](const ElementaryMotion& motion, double angle) {
    joint_q[motion.q] = unwrapped(angle + motion.zero, joint_q[motion.q]);
  };
  switch (turning_) {
    case Turning::none: return true;
    case Turning::axis: set_angle(rotations_[0], angle_about(rotations_[0].axis, pose.rotation)); return true;
    case Turning::cross: {
      const Vector3 &u = rotations_[0].axis, &second = rotations_[1].axis;
      const Vector3 w = pose.rotation * second;
      const double first_angle = std::atan2(u.dot(second.cross(w)), second.dot(w) - u.dot(second) * u.dot(w));
      set_angle(rotations_[0], first_angle);
      const Matrix3 rest = rotation_about<double>(u, -first_angle) * pose.rotation;
      set_angle(rotations_[1], angle_about(second, rest));
      return true;
    }
    case Turning::free: {
      Vector4 q = quaternion_of_rotation<double>(pose.rotation);
      Eigen::Map<Vector4> last(joint_q + rotations_[0].q);
      if (q.dot(last) < 0.0) q = -q;  // of the two quaternions of a rotation the one nearer to the last
      last = q;
      return true;
    }
  }
  return true;
}

}  // namespace koppel
