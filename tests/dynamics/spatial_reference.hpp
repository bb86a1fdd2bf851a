// Dynamics of trees as textbooks define it, in any precision and without thought of speed: 6-vectors about the world's
// origin, every body with every rate before it. What core computes in other ways must agree.
#pragma once

#include <array>
#include <stdexcept>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "dynamics/inertias.hpp"
#include "mechanism/coordinates.hpp"
#include "mechanism/mechanism.hpp"
#include "spatial/dual.hpp"
#include "spatial/quaternion.hpp"
#include "spatial/rotation.hpp"
#include "spatial/spatial_inertia.hpp"

namespace koppel::test {

/// q displaced along a rate by an infinitesimal.
inline Eigen::Matrix<Dual<long double>, Eigen::Dynamic, 1> displaced(const Mechanism& mechanism,
                                                                     const Eigen::VectorXd& q, std::uint32_t rate) {
  Eigen::Matrix<Dual<long double>, Eigen::Dynamic, 1> result = q.cast<Dual<long double>>();
  for (const StateBlock& block : mechanism.blocks) {
    const auto rates = static_cast<std::uint32_t>(rate_count(block.kind));
    if (rate < block.v || rate >= block.v + rates) continue;
    std::array<double, 12> tangent{};
    tangent_block(block.kind, q.data() + block.q, tangent.data());
    for (std::uint32_t i = 0; i < coordinate_count(block.kind); ++i) {
      result[block.q + i].dual = static_cast<long double>(tangent[i * rates + rate - block.v]);
    }
  }
  return result;
}

/// Only joints that are products of motions.
template <typename T>
class SpatialReference {
 public:
  using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;
  using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;

  SpatialReference(const Mechanism& mechanism, const Inertias& inertias)
      : mechanism_(mechanism), inertias_(inertias), poses_(mechanism.nodes), velocities_(mechanism.nodes, Six::Zero()) {
    accelerations_ = velocities_;
    wrenches_ = velocities_;
    columns_.assign(mechanism.nv, Six::Zero());
    composites_.assign(mechanism.nodes, Matrix6T<T>::Zero());
  }

  /// Efforts for rates v and accelerations a.
  template <typename Q, typename V>
  Vector efforts(const Eigen::MatrixBase<Q>& q, const Eigen::MatrixBase<V>& v, const Eigen::VectorXd& a,
                 const Vector3& gravity) {
    move(q.template cast<T>(), v.template cast<T>(), a.cast<T>(), gravity.cast<T>());
    Vector result = Vector::Zero(mechanism_.nv);
    for (std::size_t i = mechanism_.steps.size(); i-- > 0;) {
      const TreeStep& step = mechanism_.steps[i];
      const Joint& joint = mechanism_.joints[step.joint.index()];
      for (std::uint32_t k = joint.v; k < joint.v + joint.nv; ++k) result[k] = columns_[k].dot(wrenches_[step.child]);
      wrenches_[step.parent] += wrenches_[step.child];
    }
    return result;
  }

  Matrix mass(const Eigen::VectorXd& q) {
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(mechanism_.nv);
    move(q.cast<T>(), rest.cast<T>(), rest.cast<T>(), Vector3T<T>::Zero());
    Matrix result = Matrix::Zero(mechanism_.nv, mechanism_.nv);
    for (std::size_t i = mechanism_.steps.size(); i-- > 0;) {
      composites_[mechanism_.steps[i].parent] += composites_[mechanism_.steps[i].child];
    }
    for (std::size_t i = 0; i < mechanism_.steps.size(); ++i) fill(i, result);
    return result;
  }

  /// Of all nodes in the world, after one of the above.
  const std::vector<PoseT<T>>& poses() const { return poses_; }

 private:
  using Six = Vector6T<T>;

  void fill(std::size_t i, Matrix& result) const {
    const Joint& joint = mechanism_.joints[mechanism_.steps[i].joint.index()];
    const Node child = mechanism_.steps[i].child;
    for (std::uint32_t k = joint.v; k < joint.v + joint.nv; ++k) {
      const Six momentum = composites_[child] * columns_[k];
      Node node = child;
      for (std::size_t j = i + 1; j-- > 0;) {
        if (mechanism_.steps[j].child != node) continue;
        const Joint& before = mechanism_.joints[mechanism_.steps[j].joint.index()];
        for (std::uint32_t l = before.v; l < before.v + before.nv; ++l) {
          result(k, l) = result(l, k) = columns_[l].dot(momentum);
        }
        node = mechanism_.steps[j].parent;
      }
    }
  }

  static Six cross(const Six& a, const Six& b) {
    Six out;
    const Vector3T<T> turn = a.template head<3>(), slide = a.template tail<3>();
    out << turn.cross(b.template head<3>()), slide.cross(b.template head<3>()) + turn.cross(b.template tail<3>());
    return out;
  }
  static Six dual_cross(const Six& a, const Six& f) {
    Six out;
    const Vector3T<T> turn = a.template head<3>(), slide = a.template tail<3>();
    out << turn.cross(f.template head<3>()) + slide.cross(f.template tail<3>()), turn.cross(f.template tail<3>());
    return out;
  }
  static PoseT<T> cast(const Pose& pose) { return {pose.rotation.cast<T>(), pose.position.cast<T>()}; }

  /// A column for a line through a point.
  static Six column(const Vector3T<T>& angular, const Vector3T<T>& linear, const Vector3T<T>& at) {
    Six out;
    out << angular, linear + at.cross(angular);
    return out;
  }

  /// Moves the frame over a motion, or back; the columns are those of the rates as they move the far side.
  void step(const ElementaryMotion& motion, const T* q, bool reversed, PoseT<T>& frame, Six* columns) const {
    const T sign = reversed ? T(-1) : T(1);
    const Vector3T<T> axis = motion.axis.cast<T>(), point = motion.point.cast<T>();
    PoseT<T> move;
    if (motion.kind == ElementaryMotionKind::free_rotation) {
      move.rotation = rotation_of_quaternion<T>(Vector4T<T>(q[0], q[1], q[2], q[3]));
      move.position = point - move.rotation * point;
    } else {
      const T value = q[0] - T(motion.zero);
      if (motion.kind == ElementaryMotionKind::translation) {
        move.position = value * axis;
      } else {
        move.rotation = rotation_about<T>(axis, value);
        move.position = point - move.rotation * point + T(motion.pitch) * value * axis;
      }
    }
    const PoseT<T> before = frame;
    frame = frame * (reversed ? move.inverse() : move);
    const PoseT<T>& outlet = reversed ? before : frame;
    if (motion.kind == ElementaryMotionKind::free_rotation) {
      for (int k = 0; k < 3; ++k)
        columns[k] = sign * column(outlet.rotation.col(k), Vector3T<T>::Zero(), outlet * point);
    } else if (motion.kind == ElementaryMotionKind::translation) {
      columns[0] = sign * column(Vector3T<T>::Zero(), outlet.rotation * axis, outlet.position);
    } else {
      columns[0] = sign * column(outlet.rotation * axis, T(motion.pitch) * (outlet.rotation * axis), outlet * point);
    }
  }

  void move(const Vector& q, const Vector& v, const Vector& a, const Vector3T<T>& gravity) {
    accelerations_[0].template tail<3>() = -gravity;
    wrenches_[0].setZero();
    composites_[0].setZero();
    for (const TreeStep& tree_step : mechanism_.steps) {
      const Joint& joint = mechanism_.joints[tree_step.joint.index()];
      if (!joint.is_product()) throw std::runtime_error("no reference for " + joint.name);
      PoseT<T> frame = poses_[tree_step.parent] * cast(tree_step.to_near);
      Six velocity = velocities_[tree_step.parent], acceleration = accelerations_[tree_step.parent];
      const std::size_t n = joint.motions().size();
      for (std::size_t i = 0; i < n; ++i) {
        const ElementaryMotion& motion = joint.motions()[tree_step.reversed ? n - 1 - i : i];
        const std::uint32_t k = joint.v + motion.v;
        const std::uint32_t count = motion.kind == ElementaryMotionKind::free_rotation ? 3 : 1;
        step(motion, q.data() + joint.q + motion.q, tree_step.reversed, frame, columns_.data() + k);
        Six relative = Six::Zero();
        for (std::uint32_t j = k; j < k + count; ++j) relative += v[j] * columns_[j];
        // Columns are fixed in the outlet's side.
        const Six carrier = tree_step.reversed ? velocity : Six(velocity + relative);
        for (std::uint32_t j = k; j < k + count; ++j) {
          acceleration += a[j] * columns_[j] + v[j] * cross(carrier, columns_[j]);
        }
        velocity += relative;
      }
      finish(tree_step, frame, velocity, acceleration);
    }
  }

  void finish(const TreeStep& step, const PoseT<T>& far, const Six& velocity, const Six& acceleration) {
    const Node node = step.child;
    poses_[node] = far * cast(step.from_far);
    velocities_[node] = velocity;
    accelerations_[node] = acceleration;
    const SpatialInertia& given = inertias_.of_node[node];
    const SpatialInertiaT<T> body{T(given.mass), given.centre.cast<T>(), given.about_centre.cast<T>()};
    composites_[node] = transformed(poses_[node], body).matrix();
    wrenches_[node] = composites_[node] * acceleration + dual_cross(velocity, composites_[node] * velocity);
  }

  const Mechanism& mechanism_;
  const Inertias& inertias_;
  std::vector<PoseT<T>> poses_;
  std::vector<Six> columns_, velocities_, accelerations_, wrenches_;
  std::vector<Matrix6T<T>> composites_;
};

}  // namespace koppel::test
