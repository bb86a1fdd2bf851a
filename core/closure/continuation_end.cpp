#include "closure/continuation_end.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/SVD>

namespace koppel {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();
// The last part of the way, where the target's nature may show.
constexpr double first_radius = 0.05, shrink = 0.4, last_radius = 1e-10;
constexpr double shortest_direct = 1e-7;
constexpr Eigen::Index samples_per_turn = 16;
constexpr int most_turns = 12;
// With other branch points D away from the target, coefficients fall like (radius / D)^k: where those at half the
// samples' number are this small, the mean is wrong by about their square.
constexpr double fine = 1e-6;
constexpr double closed_gap = 1e-6;  // of the loop's extent: the path has come back to its start
// Divergence: coefficients of negative powers this large, against the point, and followed by ones that are so much
// smaller than they: otherwise the infinity may be one near the target only.
constexpr double pole = 1e-2, no_more = 1e-3;
constexpr std::int32_t round_steps = 300;  // between samples

double largest(const ComplexVector& x) { return x.size() == 0 ? 0.0 : std::sqrt(x.cwiseAbs2().maxCoeff()); }

}  // namespace

PointState inspect(ContinuationProblem& problem, const ComplexVector& p, const ComplexVector& x) {
  const Eigen::Index n = problem.unknowns();
  ComplexVector residual(n);
  ComplexMatrix jacobian(n, n);
  problem.evaluate(x, p, residual, &jacobian, nullptr, nullptr);
  if (n == 0) return {};
  if (!residual.allFinite() || !jacobian.allFinite()) return {infinity, infinity};
  const Eigen::JacobiSVD<ComplexMatrix> svd(jacobian);
  const auto& values = svd.singularValues();
  return {largest(residual), values[n - 1] > 0.0 ? std::max(1.0, values[0]) / values[n - 1] : infinity};
}

double rounding_error(Eigen::Index n, double condition) { return 10.0 * static_cast<double>(n) * eps * condition; }

Endgame::Endgame(Tracker& tracker, const ComplexVector& base, const ComplexVector& target)
    : tracker_(tracker), target_(target), straight_{&base, &target}, circle_{&base, &target, 1.0,
                                                                             1,     1.0,     first_radius} {
  const Eigen::Index size = tracker.problem().point_size();
  for (ComplexVector* v : {&x_, &y_, &mean_}) v->setZero(size);
  zero_.setZero(tracker.problem().unknowns());
  samples_.setZero(size, samples_per_turn * most_turns);
}

/// Refines x, at the target, if it is a regular solution; else x is not changed.
bool Endgame::regular(ComplexVector& x, double& accuracy) {
  y_ = x;
  const double step = tracker_.refine(target_, y_);
  if (!(step < 1.0)) return false;
  const PointState state = inspect(tracker_.problem(), target_, y_);
  accuracy = rounding_error(zero_.size(), state.condition);
  if (state.condition >= singular_condition || step > accuracy) return false;
  x = y_;
  return true;
}

PathLimit Endgame::follow(const ComplexVector& start, const StepBounds& bounds) {
  double t = 0.0;
  x_ = start;
  if (tracker_.follow(straight_, t, 1.0 - first_radius, x_, bounds) != Tracker::Outcome::arrived) return {};
  StepBounds direct = bounds;
  direct.shortest = shortest_direct;
  PathLimit limit;
  limit.point = x_;
  if (tracker_.track(straight_, t, 1.0, limit.point, direct) == Tracker::Outcome::arrived &&
      regular(limit.point, limit.accuracy)) {
    limit.end = PathEnd::regular;
    return limit;
  }
  return approach(bounds);
}

/// Loops round the target, nearer and nearer until one tells the limit. x_: the solution at first_radius.
PathLimit Endgame::approach(const StepBounds& bounds) {
  PathLimit limit;
  limit.point = x_;
  double radius = first_radius / shrink;
  while ((radius *= shrink) > last_radius) {
    const Loop loop = go_round(radius, bounds, limit);
    if (loop == Loop::diverging) {
      limit.end = PathEnd::diverging;
      return limit;
    }
    if (loop == Loop::finite) {
      // Newton must lead to the limit itself; from near a singular one it may go to a regular solution elsewhere.
      limit.point = mean_;
      double accuracy = 0.0;
      const bool good = regular(limit.point, accuracy);
      if (good && Tracker::distance(limit.point, mean_) <= std::max(accuracy, 10.0 * limit.accuracy)) {
        limit.end = PathEnd::regular;
        limit.accuracy = accuracy;
      } else {
        limit.end = PathEnd::singular;
        limit.point = mean_;
      }
      return limit;
    }
    double t = 1.0 - radius;
    StepBounds radial = bounds;
    radial.shortest = 1e-5 * radius;
    const Tracker::Outcome outcome = tracker_.track(straight_, t, 1.0 - shrink * radius, x_, radial);
    if (outcome == Tracker::Outcome::escaped) limit.end = PathEnd::diverging;
    if (outcome != Tracker::Outcome::arrived) return limit;
  }
  return limit;
}

/// Follows x_ round the target until it comes back.
Endgame::Loop Endgame::go_round(double radius, const StepBounds& bounds, PathLimit& limit) {
  constexpr double angle = 2.0 * std::numbers::pi / static_cast<double>(samples_per_turn);
  circle_.radius = radius;
  StepBounds round = bounds;
  round.shortest = 1e-5;
  round.steps = round_steps;
  (void)tracker_.refine(circle_, 0.0, x_);
  limit.point = x_;
  double extent = 0.0;
  for (int turn = 0; turn < most_turns; ++turn) {
    for (Eigen::Index i = 0; i < samples_per_turn; ++i) {
      samples_.col(turn * samples_per_turn + i) = limit.point;
      double t = angle * static_cast<double>(i);
      const double end = angle * static_cast<double>(i + 1);
      if (tracker_.track(circle_, t, end, limit.point, round) != Tracker::Outcome::arrived) return Loop::unclear;
      if (!(tracker_.refine(circle_, end, limit.point) < 1.0)) return Loop::unclear;
      extent = std::max(extent, Tracker::distance(limit.point, x_));
    }
    const double gap = Tracker::distance(limit.point, x_);
    if (gap <= std::max(closed_gap * extent, 100.0 * eps)) {
      return judge((turn + 1) * samples_per_turn, turn + 1, gap, limit);
    }
  }
  return Loop::unclear;
}

/// Coefficient of power k (in radius^(1 / winding), times the power) of the Laurent series. Returns its largest entry.
double Endgame::coefficient(Eigen::Index samples, Eigen::Index k, ComplexVector& value) const {
  value.setZero();
  const double step = -2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(samples);
  for (Eigen::Index i = 0; i < samples; ++i) value += samples_.col(i) * std::polar(1.0, step * static_cast<double>(i));
  value /= static_cast<double>(samples);
  return largest(value);
}

Endgame::Loop Endgame::judge(Eigen::Index samples, int winding, double gap, PathLimit& limit) {
  double negative = 0.0, middle = 0.0, highest = 0.0;
  const Eigen::Index quarter = samples / 4, half = samples / 2;
  for (Eigen::Index k = 1; k <= quarter; ++k) negative = std::max(negative, coefficient(samples, -k, y_));
  for (Eigen::Index k = quarter + 1; k < samples - quarter; ++k) {
    const double size = coefficient(samples, k, y_);
    middle = std::max(middle, size);
    if (std::abs(k - half) <= 1) highest = std::max(highest, size);
  }
  const double scale = std::max(1.0, std::sqrt(samples_.leftCols(samples).cwiseAbs2().maxCoeff()));
  limit.winding = winding;
  if (negative > pole * scale && middle < no_more * negative) return Loop::diverging;
  if (std::max(negative, highest) > fine * scale) return Loop::unclear;
  (void)coefficient(samples, 0, y_);
  tracker_.problem().move(y_, zero_, mean_);
  limit.accuracy = std::max({highest * highest / (scale * scale), gap, negative / scale, 100.0 * eps});
  return Loop::finite;
}

}  // namespace koppel
