// A joint as core evaluates it: a program of elementary motions, or the callbacks of its plugin. The same steps serve
// forward kinematics (where the near frame stands somewhere in the world) and a joint on its own (near frame =
// identity).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/id.hpp"
#include "plugin/type.hpp"
#include "scene/scene.hpp"
#include "spatial/pose.hpp"

namespace koppel {

inline constexpr std::size_t max_joint_rates = 6;
inline constexpr std::size_t max_joint_coordinates = 9;  // three unit vectors
inline constexpr double angle_difference_step = 0.01;    // rad: truncation 1e-14 of smooth functions, rounding 1e-14

/// The motion that one rate makes, as a field: a point x of the far side has the velocity
/// linear + angular x (x - point), times the rate. World axes.
struct Column {
  Vector3 angular;
  Vector3 linear;
  Vector3 point;  ///< on the axis, [m]
};

/// Time derivatives of a Column's parts; `point` is the velocity of the point, as one that is fixed before the motion.
using ColumnRate = Column;

/// How a frame moves: twist and acceleration, world axes, taken at the point `at` that is fixed in the frame.
struct FrameMotion {
  Vector3 at = Vector3::Zero();
  Vector3 angular_velocity = Vector3::Zero();
  Vector3 velocity = Vector3::Zero();
  Vector3 angular_acceleration = Vector3::Zero();
  Vector3 acceleration = Vector3::Zero();

  /// The same motion, taken at another point of the frame (K-I-3.3.2b, K-I-3.3.3).
  void shift(const Vector3& to) {
    const Vector3 d = to - at;
    acceleration += angular_acceleration.cross(d) + angular_velocity.cross(angular_velocity.cross(d));
    velocity += angular_velocity.cross(d);
    at = to;
  }
};

enum class ElementaryMotionKind { rotation, translation, screw, free_rotation };

/// An elementary motion with everything that evaluation needs. Axis and point are constant in the frame before it.
struct ElementaryMotion {
  ElementaryMotionKind kind = ElementaryMotionKind::rotation;
  std::uint32_t q = 0;  ///< first coordinate and first rate, counted within the joint
  std::uint32_t v = 0;
  double zero = 0.0;  ///< the coordinate's value at which nothing has moved
  Vector3 axis = Vector3::UnitZ();
  Vector3 point = Vector3::Zero();
  double pitch = 0.0;
};

struct JointBlock {
  BlockKind kind = BlockKind::angle;
  std::uint32_t q = 0, v = 0;  ///< first coordinate and rate, within the joint
  CoordinateDescription described;
};

/// The relative velocity [angular; linear] of the outlet against the inlet, in outlet axes at the outlet origin, has
/// the columns of S as basis.
using Subspace = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::ColMajor, 6, max_joint_rates>;

/// A joint ready for evaluation. Const while evaluating.
class Joint {
 public:
  /// Asks the plugin for an instance and, of product joints, for the motions.
  static Result<Joint> build(const JointDescription& description);

  std::string name;
  const JointType* type = nullptr;
  Attachment inlet, outlet;
  std::vector<JointBlock> blocks;
  std::uint32_t nq = 0, nv = 0;
  std::uint32_t q = 0, v = 0;  ///< first coordinate and rate in the state

  bool is_product() const { return type->is_product(); }
  const std::vector<ElementaryMotion>& motions() const { return motions_; }
  /// Names of what the plugin does not provide and core forms numerically; empty for products.
  std::vector<std::string> numerical_parts() const;

  /// The size of the mechanism, from which steps of numerical derivatives along lengths are taken.
  void set_length(double length) { line_step_ = angle_difference_step * length; }

  /// Moves `frame` from the near to the far side of the joint (near = inlet, or outlet if reversed) and writes nv
  /// columns. False: the plugin failed or returned something not finite.
  bool step(const double* joint_q, bool reversed, Pose& frame, Column* columns) const;

  /// Carries a motion over the joint, given the columns of step() and rates and accelerations of the coordinates.
  /// `near` and `far`: the poses before and after step().
  bool step_motion(const double* joint_q, const double* joint_v, const double* joint_a, bool reversed, const Pose& near,
                   const Pose& far, const Column* columns, FrameMotion& motion) const;

  /// Time derivatives of the columns of step(); `motion`: of the near side.
  bool column_rates(const double* joint_q, const double* joint_v, bool reversed, const Pose& near, const Pose& far,
                    const Column* columns, FrameMotion motion, ColumnRate* rates) const;

  /// Pose of the outlet in the inlet.
  bool pose(const double* joint_q, Pose& pose) const;
  /// S at joint_q.
  bool subspace(const double* joint_q, Subspace& s) const;
  /// (dS/dt) v: what the relative acceleration has beyond S a.
  bool bias(const double* joint_q, const double* joint_v, Vector6& bias) const;

  /// dS(q; u, w): the derivative of S w along the rates u. Of joints with callbacks only, as the next.
  bool subspace_rate(const double* joint_q, const double* u, const double* w, Vector6& rate) const {
    return callback_bias(joint_q, u, w, rate);
  }
  /// How the bias at the rates joint_v changes along each rate (columns); by central differences.
  bool bias_by_q(const double* joint_q, const double* joint_v, Subspace& slopes) const;

  /// Plugin-given implicit face: residual and derivative (6 columns) of a relative pose. Only if type->rows is not
  /// empty.
  bool plugin_residual(const Pose& pose, double* residual, double* jacobian) const;
  bool plugin_coordinates(const Pose& pose, double* joint_q) const;

  /// result = joint_q moved by delta, block by block.
  void integrate(const double* joint_q, const double* delta, double* result) const;

 private:
  bool callback_pose(const double* joint_q, Pose& pose) const;
  bool callback_subspace(const double* joint_q, Subspace& s) const;
  /// dS(q; u, w).
  bool callback_bias(const double* joint_q, const double* u, const double* w, Vector6& bias) const;
  void without_zero(const double* joint_q, double* shifted) const;

  Instance instance_;
  std::vector<ElementaryMotion> motions_;
  double line_step_ = angle_difference_step;  ///< [m]
};

}  // namespace koppel
