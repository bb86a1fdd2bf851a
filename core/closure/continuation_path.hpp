// Following one solution of a ContinuationProblem while its parameters run along a curve on a complex line.
#pragma once

#include <array>

#include <Eigen/Core>

#include "closure/continuation.hpp"
#include "closure/continuation_lu.hpp"

namespace koppel {

/// Parameters from + s (to - from) with s = w t / (1 - t + w t): for real t an arc of a circle from 0 to 1 in the plane
/// of s, for w = 1 the straight line. Unless `turn` is 0: t = centre - radius exp(i turn u), round a circle in the
/// plane of t along real u.
struct Route {
  const ComplexVector* from = nullptr;
  const ComplexVector* to = nullptr;
  Complex w = 1.0;
  int turn = 0;  ///< or 1, -1
  double centre = 0.0, radius = 0.0;

  struct At {
    Complex s, rate;  ///< its derivative by t or u
  };
  At at(double t_or_u) const;
};

/// Bounds of a step, relative to the largest entry of the point (or 1, if that is larger).
struct StepBounds {
  double contraction = 0.05;  ///< second Newton step to first: keeps to the region of quadratic convergence
  double error = 0.03;        ///< first Newton step: prediction to solution
  double turn = 0.1;          ///< error of the predicted tangent, to the tangent: another path's differs
  double aim = 0.2;           ///< steps aim at this part of the bounds
  double shortest = 1e-11;    ///< step in t
  std::int32_t steps = 1500;
  double escape = 1e9;  ///< a point this large is followed no further

  /// Bounds times `factor` (below 1: tighter).
  StepBounds tightened(double factor) const;
};

/// Predictor: Hermite interpolation of up to three points with their tangents, order 6, in the numbers that store a
/// point. Corrector: two or three Newton steps, which also yield the next tangent. All memory is made once.
class Tracker {
 public:
  enum class Outcome { arrived, short_step, many_steps, escaped };

  explicit Tracker(ContinuationProblem& problem);

  /// Moves x, a solution at t, along the route to t_end. On failure x and t stand where the last good step led.
  Outcome track(const Route& route, double& t, double t_end, ComplexVector& x, const StepBounds& bounds);

  /// The same, with detours: where track() gets stuck, as when the solution runs past infinity nearby, half circles to
  /// both sides of the place are tried. Equal ends tell that the path does not branch between them, and lead on.
  Outcome follow(const Route& route, double& t, double t_end, ComplexVector& x, const StepBounds& bounds);

  /// Newton to rounding. Returns the size of the last step, relative as in StepBounds; above 1 if it fails.
  double refine(const ComplexVector& p, ComplexVector& x);
  /// The same at a point of a route.
  double refine(const Route& route, double t, ComplexVector& x);

  /// max |a - b| / max(1, max |b|); infinite if not finite.
  static double distance(const ComplexVector& a, const ComplexVector& b);

  ContinuationProblem& problem() { return problem_; }
  ContinuationCost cost;

 private:
  struct Knot {
    double t = 0.0;
    ComplexVector x, rate;
  };

  bool pass_by(const Route& route, double stuck, double radius, ComplexVector& x, const StepBounds& bounds);
  double refine(ComplexVector& x);
  void set_parameters(const Route& route, double t);
  bool tangent(const ComplexVector& x, ComplexVector& rate);
  void predict(double t);
  bool newton_step(const ComplexVector& x, bool with_rate, ComplexVector& result, double& size);
  double correct(const StepBounds& bounds, double h);

  ContinuationProblem& problem_;
  SmallLu lu_;
  ComplexVector p_, dp_, residual_, along_, zero_;
  ComplexVector raw_, predicted_, slope_, first_, second_, rate_, scratch_;
  std::array<Knot, 3> knots_;  ///< newest first
  std::size_t count_ = 0;
};

}  // namespace koppel
