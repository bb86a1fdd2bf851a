// The implicit face of a joint: the equations that the relative pose of its two frames must satisfy, without the
// joint's coordinates; used where a loop is cut. Derived from the motions of a product joint by what they are, never by
// name: translations along fixed directions, followed by rotations about the common origin.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mechanism/joint.hpp"
#include "plugin/type.hpp"
#include "spatial/pose.hpp"

namespace koppel {

/// How the outlet may turn against the inlet.
enum class Turning { none, axis, cross, free };

/// Equations of a relative pose. Residuals are metres (along directions fixed in the inlet frame) and radians (angle
/// times axis, so that a frame turned by half a turn is as far from closed as it can be).
class Face {
 public:
  /// The face of a joint; nothing if its motion is not of that kind and its plugin offers none.
  static std::optional<Face> of(const Joint& joint);

  const std::vector<Row>& rows() const { return rows_; }

  /// residual: one number for each row. jacobian: 6 numbers for each row, the derivative along the relative twist
  /// [angular; linear] of the outlet, in outlet axes at its origin. False: the plugin failed.
  bool evaluate(const Joint& joint, const Pose& pose, double* residual, double* jacobian) const;

  /// The joint's coordinates at a closed pose; angles continue from the values in joint_q. False: the plugin failed.
  bool coordinates(const Joint& joint, const Pose& pose, double* joint_q) const;

 private:
  void turning_rows(const Pose& pose, double* residual, double* jacobian) const;

  bool from_plugin_ = false;
  std::vector<Row> rows_;
  std::vector<Vector3> fixed_directions_;  ///< of the inlet: no motion along these
  std::vector<ElementaryMotion> translations_;
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, 3, 3> translation_inverse_;
  Turning turning_ = Turning::none;
  std::vector<ElementaryMotion> rotations_;
};

}  // namespace koppel
