#include "closure/continuation_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace koppel {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double tiny = 1e-9;   // Newton steps below this are good whatever their contraction: rounding is near
constexpr double good = 1e-5;   // a second Newton step above this is followed by a third
constexpr double still = 1e-3;  // motions in a step below this part of the point do not count as tangents
constexpr double largest_growth = 3.0, first_growth = 8.0;
constexpr int most_detours = 4;
constexpr double detours[] = {0.01, 0.03, 0.003};  // radii, in t
constexpr double alike = 1e-6;                     // ends of both sides of a detour
constexpr int refinements = 10;

double size_of(const ComplexVector& x) {
  double square = 0.0;
  for (const Complex& value : x) {
    const double s = std::norm(value);
    if (!(s <= square)) square = s;  // takes NaN over, too
    if (!std::isfinite(s)) return infinity;
  }
  return std::sqrt(square);
}

}  // namespace

Route::At Route::at(double t_or_u) const {
  Complex t = t_or_u, rate = 1.0;
  if (turn != 0) {
    const Complex offset = std::polar(radius, turn * t_or_u);
    t = centre - offset;
    rate = Complex(0.0, -turn) * offset;
  }
  const Complex d = 1.0 - t + w * t;
  return {w * t / d, rate * w / (d * d)};
}

StepBounds StepBounds::tightened(double factor) const {
  StepBounds result = *this;
  result.contraction *= factor;
  result.error *= factor;
  result.turn *= factor;
  return result;
}

Tracker::Tracker(ContinuationProblem& problem) : problem_(problem), lu_(problem.unknowns()) {
  const Eigen::Index n = problem.unknowns(), size = problem.point_size(), m = problem.parameters();
  for (ComplexVector* v : {&p_, &dp_}) v->setZero(m);
  for (ComplexVector* v : {&residual_, &along_, &zero_}) v->setZero(n);
  for (ComplexVector* v : {&raw_, &predicted_, &slope_, &first_, &second_, &rate_, &scratch_}) v->setZero(size);
  for (Knot& knot : knots_) {
    knot.x.setZero(size);
    knot.rate.setZero(size);
  }
}

double Tracker::distance(const ComplexVector& a, const ComplexVector& b) {
  double difference = 0.0, size = 1.0;
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const double d = std::norm(a[i] - b[i]);
    if (!std::isfinite(d)) return infinity;
    difference = std::max(difference, d);
    size = std::max(size, std::norm(b[i]));
  }
  return std::sqrt(difference / size);
}

void Tracker::set_parameters(const Route& route, double t) {
  const Route::At at = route.at(t);
  dp_ = *route.to - *route.from;
  p_ = *route.from + at.s * dp_;
  dp_ *= at.rate;
}

/// One Newton step at the present parameters from x to result. With `with_rate`, lu_ and along_ stand for the tangent.
bool Tracker::newton_step(const ComplexVector& x, bool with_rate, ComplexVector& result, double& size) {
  ++cost.evaluations;
  problem_.evaluate(x, p_, residual_, &lu_.matrix, with_rate ? &dp_ : nullptr, with_rate ? &along_ : nullptr);
  if (!lu_.factorise()) return false;
  residual_ = -residual_;
  lu_.solve(residual_);
  problem_.move(x, residual_, result);
  size = distance(result, x);
  return std::isfinite(size);
}

/// From along_ and lu_, as newton_step() left them.
bool Tracker::tangent(const ComplexVector& x, ComplexVector& rate) {
  along_ = -along_;
  lu_.solve(along_);
  problem_.lift(x, along_, rate, scratch_);
  return std::isfinite(size_of(rate));
}

/// Hermite interpolation at t into predicted_, mended, and its derivative into slope_.
void Tracker::predict(double t) {
  raw_.setZero();
  slope_.setZero();
  for (std::size_t i = 0; i < count_; ++i) {
    const double d = t - knots_[i].t;
    // Lagrange's l, its derivative, and its derivative at the knot.
    double l = 1.0, dl = 0.0, at_knot = 0.0;
    for (std::size_t j = 0; j < count_; ++j) {
      if (j == i) continue;
      const double span = knots_[i].t - knots_[j].t, ratio = (t - knots_[j].t) / span;
      dl = dl * ratio + l / span;
      l *= ratio;
      at_knot += 1.0 / span;
    }
    const double a = (1.0 - 2.0 * at_knot * d) * l * l, b = d * l * l;
    const double da = -2.0 * at_knot * l * l + 2.0 * (1.0 - 2.0 * at_knot * d) * l * dl, db = l * l + 2.0 * d * l * dl;
    raw_ += a * knots_[i].x + b * knots_[i].rate;
    slope_ += da * knots_[i].x + db * knots_[i].rate;
  }
  problem_.move(raw_, zero_, predicted_);
}

/// Newton from predicted_ to second_, and its tangent into rate_. Returns the greatest part of a bound that was used
/// up, each to the power that makes it linear in a change of the predictor's error; above 1: not to be accepted.
double Tracker::correct(const StepBounds& bounds, double h) {
  double first = infinity, second = infinity;
  if (!newton_step(predicted_, false, first_, first)) return infinity;
  double used = first / bounds.error;
  if (used > 1.0) return used;
  if (!newton_step(first_, true, second_, second)) return infinity;
  if (second > tiny) used = std::max(used, second / first / bounds.contraction);
  if (used > 1.0) return used;
  if (second > good) {
    first_.swap(second_);
    double third = infinity;
    if (!newton_step(first_, true, second_, third)) return infinity;
    if (third > second * bounds.contraction) return 2.0;
  }
  if (!tangent(second_, rate_)) return infinity;
  double difference = 0.0, tangent_size = 0.0, point_size = 1.0;
  for (Eigen::Index i = 0; i < rate_.size(); ++i) {
    difference = std::max(difference, std::norm(rate_[i] - slope_[i]));
    tangent_size = std::max(tangent_size, std::norm(rate_[i]));
    point_size = std::max(point_size, std::norm(second_[i]));
  }
  const double motion = std::max(h * std::sqrt(tangent_size), still * std::sqrt(point_size));
  return std::max(used, h * std::sqrt(difference) / motion / bounds.turn);
}

Tracker::Outcome Tracker::track(const Route& route, double& t, double t_end, ComplexVector& x,
                                const StepBounds& bounds) {
  ++cost.paths;
  count_ = 0;
  double h = 0.02 * (t_end - t);
  double size = 0.0;
  set_parameters(route, t);
  if (!newton_step(x, true, first_, size) || !tangent(x, rate_)) return Outcome::short_step;
  second_ = x;
  const auto push = [&] {
    std::rotate(knots_.begin(), knots_.end() - 1, knots_.end());
    knots_[0].t = t;
    knots_[0].x.swap(second_);
    knots_[0].rate.swap(rate_);
    count_ = std::min(count_ + 1, knots_.size());
  };
  push();
  bool rejected = false;
  for (std::int32_t step = 0; t < t_end; ++step) {
    if (step >= bounds.steps) return Outcome::many_steps;
    ++cost.steps;
    const double left = t_end - t;
    if (h >= left) {
      h = left;
    } else if (h > 0.5 * left) {
      h = 0.5 * left;
    }
    const double t_new = h == left ? t_end : t + h;
    predict(t_new);
    set_parameters(route, t_new);
    const double used = correct(bounds, h);
    // The error grows with h to the power 2 count, with the older knots where they are; the new h is for all.
    const double order = 2.0 * static_cast<double>(count_);
    const double factor = std::pow(bounds.aim / std::max(used, 1e-6), 1.0 / order);
    if (used > 1.0) {
      h *= std::isfinite(used) ? std::clamp(factor, 0.2, 0.6) : 0.25;
      rejected = true;
      if (h < bounds.shortest) return Outcome::short_step;
      continue;
    }
    t = t_new;
    x = second_;
    push();
    if (size_of(x) > bounds.escape) return Outcome::escaped;
    h *= rejected ? std::min(factor, 1.0) : std::clamp(factor, 0.3, count_ < 3 ? first_growth : largest_growth);
    rejected = false;
    if (h < bounds.shortest) return Outcome::short_step;
  }
  return Outcome::arrived;
}

Tracker::Outcome Tracker::follow(const Route& route, double& t, double t_end, ComplexVector& x,
                                 const StepBounds& bounds) {
  double start = t;
  ComplexVector from = x;
  Outcome outcome = track(route, t, t_end, x, bounds);
  for (int i = 0; i < most_detours && outcome != Outcome::arrived; ++i) {
    const double stuck = t;
    bool passed = false;
    for (const double radius : detours) {
      if (stuck - radius < start || stuck + radius > t_end) continue;
      double there = start;
      ComplexVector y = from;
      if (track(route, there, stuck - radius, y, bounds) != Outcome::arrived) continue;
      if (!pass_by(route, stuck, radius, y, bounds)) continue;
      passed = true;
      start = stuck + radius;
      from = y;
      break;
    }
    if (!passed) return outcome;
    t = start;
    x = from;
    outcome = track(route, t, t_end, x, bounds);
  }
  return outcome;
}

/// From x, at stuck - radius, to stuck + radius.
bool Tracker::pass_by(const Route& route, double stuck, double radius, ComplexVector& x, const StepBounds& bounds) {
  Route bow = route;
  bow.radius = radius;
  bow.centre = stuck;
  ComplexVector other = x, print, other_print;
  for (const int turn : {1, -1}) {
    ComplexVector& point = turn > 0 ? x : other;
    bow.turn = turn;
    double u = 0.0;
    if (track(bow, u, std::numbers::pi, point, bounds) != Outcome::arrived) return false;
    if (!(refine(bow, std::numbers::pi, point) < alike)) return false;
  }
  problem_.fingerprint(x, print);
  problem_.fingerprint(other, other_print);
  return distance(print, other_print) <= alike;
}

double Tracker::refine(const ComplexVector& p, ComplexVector& x) {
  p_ = p;
  return refine(x);
}

double Tracker::refine(const Route& route, double t, ComplexVector& x) {
  set_parameters(route, t);
  return refine(x);
}

double Tracker::refine(ComplexVector& x) {
  double last = infinity;
  for (int i = 0; i < refinements; ++i) {
    double size = infinity;
    if (!newton_step(x, false, first_, size)) return infinity;
    if (size >= 0.5 * last) break;  // met rounding, or does not converge
    x = first_;
    last = size;
    if (size <= 4.0 * eps) break;
  }
  return last;
}

}  // namespace koppel
