// Where a path ends when its parameters reach the target, which may be a special one.
// Morgan, Sommese, Wampler, Computing singular solutions to nonlinear analytic systems, Numer. Math. 58, 1991 (Cauchy
// integrals, winding numbers).
#pragma once

#include "closure/continuation_path.hpp"

namespace koppel {

/// The system at a point.
struct PointState {
  double residual = 0.0;   ///< greatest entry; infinite if not finite
  double condition = 1.0;  ///< of the Jacobian: largest singular value, at least 1, to the smallest
};
PointState inspect(ContinuationProblem& problem, const ComplexVector& p, const ComplexVector& x);

/// Error of a point that Newton has refined, relative to its largest entry: condition times rounding in n equations.
double rounding_error(Eigen::Index n, double condition);

struct PathLimit {
  PathEnd end = PathEnd::lost;
  ComplexVector point;    ///< if regular or singular
  int winding = 1;        ///< of the path round the target
  double accuracy = 0.0;  ///< relative to the point's largest entry
};

class Endgame {
 public:
  Endgame(Tracker& tracker, const ComplexVector& base, const ComplexVector& target);

  /// The end of the path from `start`, a solution at base.
  PathLimit follow(const ComplexVector& start, const StepBounds& bounds);

 private:
  enum class Loop { finite, diverging, unclear };

  bool regular(ComplexVector& x, double& accuracy);
  PathLimit approach(const StepBounds& bounds);
  Loop go_round(double radius, const StepBounds& bounds, PathLimit& limit);
  Loop judge(Eigen::Index samples, int winding, double gap, PathLimit& limit);
  double coefficient(Eigen::Index samples, Eigen::Index k, ComplexVector& value) const;

  Tracker& tracker_;
  const ComplexVector& target_;
  Route straight_, circle_;
  ComplexVector x_, y_, mean_, zero_;
  ComplexMatrix samples_;  ///< points on the circle, a column each
};

}  // namespace koppel
