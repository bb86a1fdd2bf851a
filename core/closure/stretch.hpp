// A stretch of a curve between two of its points, and the singular positions on it.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "closure/curve.hpp"

namespace koppel {

/// A place on a curve with its derivatives by the arc length, in the scaled unknowns and parameter of CurvePoint.
struct CurvePlace {
  CurvePoint point;
  Eigen::VectorXd second;  ///< derivative of the tangent; empty unless the place is beside a change point
  bool beside_change_point = false;
};

/// Where branches of the curve meet. The equations do not tell positions beside it from one another to more than half
/// the digits; there they are interpolated along a branch between positions that stand far enough away.
struct ChangePoint {
  CurvePoint point;                       ///< its tangent is that of the branch on which it was reached
  std::vector<Eigen::VectorXd> branches;  ///< tangents of all branches, the one that was come upon first
  double at = 0.0;                        ///< where on the stretch
};

class Stretch {
 public:
  Stretch(Curve& curve, CurvePoint a, CurvePoint b, double length);
  /// That leaves a change point along another of its branches. Null: no closed positions were found there.
  static std::optional<Stretch> on_branch(Curve& curve, const ChangePoint& from, const Eigen::VectorXd& tangent);

  const CurvePoint& a() const { return a_; }
  const CurvePoint& b() const { return b_; }
  /// A place is given by its distance from a along a's tangent.
  double length() const { return length_; }

  /// The place at a distance. False: no closed position was found.
  bool at(double distance, CurvePlace& place);
  /// Arc length from a to a distance; not a number if a place between was not found.
  double arc(double distance);

  /// Where the parameter turns back.
  std::optional<double> find_limit();
  /// Where the rank drops; from then on at() knows it.
  const std::optional<ChangePoint>& find_change_point();
  /// The ends are differently oriented although no rank drops between them: they belong to different branches, which
  /// come near one another without meeting.
  bool hopped() const { return hopped_; }

 private:
  static constexpr int count = 6;  ///< of the nodes that a change point is interpolated from
  struct Node {
    double at;
    CurvePoint point;
  };

  Eigen::VectorXd guess(double distance, Eigen::VectorXd* slope) const;
  bool close_at(double distance, CurvePoint& point);
  bool take_nodes(double middle);
  double root_of_rank(bool crossed);
  bool find_nodes(double middle, bool crossed);
  bool interpolate(double distance, CurvePlace& place);
  bool settle(CurvePoint& point);
  void find_branches(ChangePoint& change);
  Eigen::MatrixXd second_order_form(const CurvePoint& at, const Eigen::MatrixXd& motions,
                                    const Eigen::MatrixXd& stresses);

  Curve& curve_;
  CurvePoint a_, b_;
  Eigen::VectorXd end_, slope_;  ///< of b: offset from a, and its derivative by the distance
  double length_;
  std::vector<Node> nodes_;
  double middle_ = 0.0;  ///< of the nodes
  std::optional<ChangePoint> change_;
  bool searched_ = false, hopped_ = false;
};

/// A root of a continuous function between two arguments at which it has opposite signs, to rounding. Not a number: the
/// function is not one somewhere.
template <typename Function>
double root_between(const Function& f, double a, double fa, double b, double fb) {
  // Regula falsi with the Illinois weights, and a bisection every fourth time.
  for (int i = 0; i < 100 && fa != 0.0 && fb != 0.0; ++i) {
    double x = i % 4 == 3 ? 0.5 * (a + b) : (a * fb - b * fa) / (fb - fa);
    if (!(std::min(a, b) < x && x < std::max(a, b))) x = 0.5 * (a + b);
    if (x == a || x == b) break;
    const double fx = f(x);
    if (std::isnan(fx)) return fx;
    if ((fx < 0.0) == (fb < 0.0)) {
      fa *= 0.5;
    } else {
      a = b;
      fa = fb;
    }
    b = x;
    fb = fx;
    if (std::abs(a - b) <= 1e-16) break;
  }
  return fa == 0.0 ? a : b;
}

}  // namespace koppel
