// Walking along a curve of closed positions: to a value of its parameter, or a length; past singular positions on the
// branch that is asked for.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "closure/branch.hpp"
#include "closure/stretch.hpp"

namespace koppel {

enum class SingularKind { limit, change_point };

/// A singular position that a walk came upon.
struct SingularPosition {
  SingularKind kind = SingularKind::limit;
  CurvePoint point;
  std::size_t branches = 1;  ///< that meet there
};

enum class WalkEnd {
  arrived,
  limit,  ///< the parameter goes no further: the walk stands there
  lost,   ///< no closed position was found that surely belongs to the branch
  plugin_failed
};

struct Walk {
  WalkEnd end = WalkEnd::lost;
  CurvePlace place;  ///< where it ended
  double length = 0.0;
  std::vector<SingularPosition> passed;  ///< in this order; a limit at which it ended is the last
};

/// From a closed position to a value of the parameter; a limit ends it. `along`: the tangent so far; empty: not known.
Walk walk_to(Curve& curve, const Eigen::VectorXd& q, double parameter, const Eigen::VectorXd& along, double target,
             Branch branch);

/// From a closed position by an arc length [scaled: an angle], past limits. `along`: the direction.
Walk walk_by(Curve& curve, const Eigen::VectorXd& q, double parameter, const Eigen::VectorXd& along, double length,
             Branch branch);

/// The input that a limit stops: that which would stretch the equations most.
std::size_t stopped_input(Curve& curve, const CurvePoint& limit);

}  // namespace koppel
