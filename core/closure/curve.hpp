// The curve of closed positions that a mechanism goes through while its inputs move along a way: points of it, reached
// from one another by arc length, so that it can be followed where the inputs turn back.
//
// Its unknowns are those of the closure and the parameter of the way, scaled as the equations are: all have the size of
// an angle. A motion of the curve is in the null space of the extended Jacobian, that of the unknowns with one more
// column for the parameter. Where its rank drops, branches of the curve meet.
#pragma once

#include <optional>

#include <Eigen/Core>

#include "closure/input_way.hpp"
#include "closure/work.hpp"

namespace koppel {

/// A closed position, and what the extended Jacobian is there.
struct CurvePoint {
  Eigen::VectorXd q;                         ///< nq, inputs and cut joints included
  double parameter = 0.0;                    ///< of the way
  Eigen::VectorXd tangent;                   ///< unknowns, then the parameter; length one
  Eigen::VectorXd curvature;                 ///< change of the tangent with the arc length, roughly; empty: not known
  Eigen::MatrixXd motions;                   ///< null space: the tangent, and what moves without it (isolated freedoms)
  Eigen::MatrixXd stresses;                  ///< left null space: redundant equations
  Eigen::VectorXd weak_motion, weak_stress;  ///< singular vectors of the value below
  double weakest = 0.0;                      ///< the smallest singular value that is not zero everywhere
  double largest = 0.0;                      ///< singular value
};

class Curve {
 public:
  Curve(Work& work, InputWay way);

  /// The point at a closed position. Its tangent is the direction `along` (as CurvePoint::tangent; any length) as far
  /// as the mechanism can follow it. False: a plugin failed, or nothing moves along it.
  bool begin(const Eigen::VectorXd& q, double parameter, const Eigen::VectorXd& along, CurvePoint& point);
  /// A step of a given length along the tangent of `from`. False: no closed position was found that is surely of the
  /// same branch.
  bool step(const CurvePoint& from, double length, CurvePoint& to);
  /// A closed position near q and parameter (both are changed) in the plane across a direction at a distance from
  /// `base`.
  bool close_across(const CurvePoint& base, const Eigen::VectorXd& direction, double distance, Eigen::VectorXd& q,
                    double& parameter);
  /// Fills in a point whose q and parameter are closed.
  bool look(CurvePoint& point, const Eigen::VectorXd& along);

  /// Residuals, in the work's equations, and the extended Jacobian at a position; its inputs are set by the parameter.
  bool linearise(Eigen::VectorXd& q, double parameter);
  const Eigen::MatrixXd& extended() const { return extended_; }

  /// From one position to another, as a tangent is laid out.
  Eigen::VectorXd offset(const CurvePoint& from, const Eigen::VectorXd& q, double parameter) const;
  /// The position at an offset; not closed.
  void displace(const CurvePoint& from, const Eigen::VectorXd& offset, Eigen::VectorXd& q, double& parameter);

  /// Sign of the extended Jacobian at `at`, bordered by motions and stresses of `reference`: between two points in one
  /// step it changes where its rank drops.
  double orientation(const CurvePoint& reference, const CurvePoint& at);
  /// A smooth function of the position that vanishes where the rank drops; `reference` is a point near by.
  double rank_function(const CurvePoint& reference, const CurvePoint& at);

  Work& work() { return work_; }
  const Mechanism& mechanism() const { return *work_.mechanism; }
  InputWay& way() { return way_; }
  /// Of the extended Jacobian in a position that is not singular, as far as has been seen.
  Eigen::Index rank() const { return rank_; }
  Eigen::Index unknowns() const { return unknowns_; }
  bool plugin_failed() const { return plugin_failed_; }

 private:
  bool failed();
  Eigen::MatrixXd bordered(const CurvePoint& reference, bool with_weak) const;

  Work& work_;
  InputWay way_;
  Eigen::Index rows_, unknowns_;
  Eigen::Index rank_ = 0;
  Eigen::MatrixXd extended_;
  bool plugin_failed_ = false;
};

}  // namespace koppel
