#include "dynamics/generalised_alpha.hpp"

#include <cmath>
#include <limits>

namespace koppel {
namespace {

// Chung and Hulbert, (25) to (28), for the spectral radius 0.9 at infinity.
constexpr double radius = 0.9;
constexpr double alpha_m = (2.0 * radius - 1.0) / (radius + 1.0);
constexpr double alpha_f = radius / (radius + 1.0);
constexpr double ahead = alpha_m - alpha_f;  // of its time, in steps, is what the method carries on
constexpr double gamma = 0.5 - ahead;
constexpr double beta = 0.25 * (gamma + 0.5) * (gamma + 0.5);

// Of the scales: for difference quotients, coarse enough for joints whose derivatives are differences, too.
const double nudge = std::cbrt(std::numeric_limits<double>::epsilon());
constexpr double solved = 1e-13;  // a correction, as a part of what moves: the one after it is rounding
constexpr double rounded = 1e-8;  // below this corrections that do not shrink are noise, by a new Jacobian
constexpr double slow = 0.3;      // part of its size that a correction leaves: beyond it the Jacobian is made anew
constexpr int most_iterations = 20;
constexpr double same_step = 1e-9;     // relative difference of steps that are one length
constexpr double similar_step = 1e-3;  // of such as one Jacobian serves

}  // namespace

bool GeneralisedAlpha::start(double t, const Eigen::VectorXd& y) {
  time_ = before_ = t;
  y_ = y_before_ = y;
  sizes_ = loops_.sizes();
  const auto [n, s, m] = sizes_;
  loops_.unknown_scales(scales_);
  no_mu_.setZero(m);
  jacobian_.resize(n + s + m, n + s + m);
  for (Eigen::VectorXd* x : {&x_, &shifted_}) x->setZero(n + s + m);
  jacobian_step_ = length_ = 0.0;
  statistics_.evaluations += 3;
  if (!loops_.begin(t, y, unknowns_rate_, to_.lambda)) return false;
  loops_.gather(y, to_.u);
  to_.slope = to_.carried = unknowns_rate_.segment(n, n + s);
  to_.power = unknowns_rate_[2 * n + s];
  change_.setZero(n + s);
  // How slopes are about to change: by those a step further on.
  from_ = to_;
  from_.u += step_ * unknowns_rate_;
  if (loops_.spread(t + step_, from_.u, y_) && loops_.begin(t + step_, y_, unknowns_rate_, from_.lambda)) {
    change_ = (unknowns_rate_.segment(n, n + s) - to_.slope) / step_;
    // A trend that steps do not resolve is none.
    if (!(step_ * change_.norm() <= to_.slope.norm())) change_.setZero();
  }
  y_ = y;
  from_ = to_;
  return loops_.rate(t, y_, y_slope_);
}

bool GeneralisedAlpha::exchange(Archive& archive) {
  if (!Integrator::exchange(archive)) return false;
  sizes_ = loops_.sizes();
  const auto [n, s, m] = sizes_;
  for (Point* point : {&from_, &to_}) archive(point->u, point->slope, point->carried, point->lambda, point->power);
  Eigen::VectorXd entries = jacobian_.reshaped();
  archive(change_, y_before_, entries, jacobian_step_, length_);
  if (!archive.good() || y_before_.size() != y_.size() || change_.size() != n + s) return false;
  for (const Point* point : {&from_, &to_}) {
    if (point->u.size() != sizes_.unknowns() || point->slope.size() != n + s || point->carried.size() != n + s ||
        point->lambda.size() != m) {
      return false;
    }
  }
  if (!archive.is_reading()) return true;
  const Eigen::Index count = n + s + m;
  if (entries.size() != count * count) return false;
  loops_.unknown_scales(scales_);
  no_mu_.setZero(m);
  for (Eigen::VectorXd* x : {&x_, &shifted_}) x->setZero(count);
  jacobian_ = entries.reshaped(count, count);
  factors_.compute(jacobian_);
  return true;
}

/// Takes to_ where the slopes carried on there bring it.
void GeneralisedAlpha::go(double h) {
  const auto [n, s, m] = sizes_;
  increment_ = h * from_.u.segment(n, n) +
               h * h * ((0.5 - beta) * from_.carried.head(n) + beta * to_.carried.head(n) + 0.5 * bending_);
  to_.u = from_.u;
  loops_.move(increment_, to_.u);
  to_.u.segment(n, n + s) += h * ((1.0 - gamma) * from_.carried + gamma * to_.carried);
  to_.slope = ((1.0 - alpha_m) * to_.carried + alpha_m * from_.carried - alpha_f * from_.slope) / (1.0 - alpha_f);
}

/// And what is missing there into `missing_`.
bool GeneralisedAlpha::reach(double h) {
  const auto [n, s, m] = sizes_;
  go(h);
  unknowns_rate_.setZero(sizes_.unknowns());
  unknowns_rate_.segment(n, n + s) = to_.slope;
  ++statistics_.evaluations;
  if (!loops_.residual(before_ + h, to_.u, unknowns_rate_, to_.lambda, no_mu_, missing_)) return false;
  to_.power = -missing_[2 * n + s];
  // What the unknowns shall bring to zero, at the front: balance, states, conditions as accelerations.
  for (Eigen::Index i = 0; i < n + s; ++i) missing_[i] = missing_[n + i];
  for (Eigen::Index i = 0; i < m; ++i) missing_[n + s + i] = missing_[2 * n + s + 1 + i] / (beta * h * h);
  return true;
}

bool GeneralisedAlpha::differentiate(double h) {
  const auto [n, s, m] = sizes_;
  if (!reach(h)) return false;
  shifted_ = missing_.head(n + s + m);
  for (Eigen::Index i = 0; i < n + s + m; ++i) {
    double& unknown = i < n + s ? to_.carried[i] : to_.lambda[i - n - s];
    const double at = unknown;
    if (i < n)
      unknown += nudge * scales_[i] / (beta * h * h);
    else if (i < n + s)
      unknown += nudge / (gamma * h);
    else
      unknown += std::max(1.0, std::abs(at));  // linear
    const double difference = unknown - at;
    const bool defined = reach(h);
    unknown = at;
    if (!defined) return false;
    jacobian_.col(i) = (missing_.head(n + s + m) - shifted_) / difference;
  }
  if (!jacobian_.allFinite()) return false;
  factors_.compute(jacobian_);
  jacobian_step_ = h;
  return reach(h);
}

/// A correction by what is missing; its greatest size, as a part of a change of position or state.
double GeneralisedAlpha::correct(double h) {
  const auto [n, s, m] = sizes_;
  x_ = factors_.solve(missing_.head(n + s + m));
  to_.carried -= x_.head(n + s);
  to_.lambda -= x_.tail(m);
  double size = 0.0;
  for (Eigen::Index i = 0; i < n + s; ++i) {
    const double lever = i < n ? beta * h * h : gamma * h, scale = i < n ? scales_[i] : 1.0;
    const double at = std::abs(to_.u[i < n ? i : n + i]) + lever * std::abs(to_.carried[i]);
    size = std::max(size, lever * std::abs(x_[i]) / (scale + at));
  }
  return x_.allFinite() ? size : std::numeric_limits<double>::infinity();
}

void GeneralisedAlpha::predict(double h) {
  to_.carried = from_.slope + (1.0 + ahead) * h * change_;
  to_.lambda = from_.lambda;
}

/// What positions are off makes rates wrong by it over h, and the motion by it over h^2 in the end: a last correction
/// takes it to rounding.
bool GeneralisedAlpha::polish(double h) {
  if (!std::isfinite(correct(h))) return false;
  go(h);
  return true;
}

/// A step of the length h from from_ to to_.
bool GeneralisedAlpha::move(double h) {
  if (!(std::abs(h - length_) <= same_step * h)) from_.carried = from_.slope + ahead * h * change_;
  loops_.bend(from_.u, bending_);
  predict(h);
  bool fresh = std::abs(h - jacobian_step_) > similar_step * h;
  if (fresh ? !differentiate(h) : !reach(h)) return false;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_iterations; ++i) {
    const double size = correct(h), left = std::isfinite(before) ? size / before : 1.0;
    const bool good = std::isfinite(size) && reach(h);
    if (good && size <= solved) return polish(h);
    if (good && fresh && size <= rounded && left > 0.5 && std::isfinite(before)) return polish(h);
    if (good && (left < slow || !std::isfinite(before) || fresh)) {
      before = size;
      continue;
    }
    if (fresh) return false;
    fresh = true;
    predict(h);
    if (!differentiate(h)) return false;
    before = std::numeric_limits<double>::infinity();
  }
  return false;
}

StepStatus GeneralisedAlpha::step(double limit) {
  if (length_ > 0.0) change_ = (to_.slope - from_.slope) / length_;
  from_ = to_;
  before_ = time_;
  y_before_ = y_;
  slope_known_ = false;
  const double rest = limit - time_;
  const bool last = rest <= step_ * (1.0 + same_step);
  time_ = last ? limit : time_ + step_;
  if (!shorten(time_)) {
    time_ = before_;
    return StepStatus::too_small;
  }
  ++statistics_.steps;
  return StepStatus::done;
}

bool GeneralisedAlpha::shorten(double t) {
  const double h = t - before_;
  if (!move(h)) return false;
  time_ = t;
  length_ = h;
  to_.u.tail(1) = from_.u.tail(1);
  to_.u.tail(1).array() += 0.5 * h * (from_.power + to_.power);
  return loops_.spread(t, to_.u, y_);
}

void GeneralisedAlpha::interpolate(double t, Eigen::VectorXd& y) {
  if (t == time_) {
    y = y_;
    return;
  }
  const double h = time_ - before_, part = (t - before_) / h;
  if (!slope_known_ && !loops_.rate(before_, y_before_, y_slope_)) y_slope_ = (y_ - y_before_) / h;
  slope_known_ = true;
  y = y_before_ + part * h * y_slope_ + part * part * (y_ - y_before_ - h * y_slope_);
}

}  // namespace koppel
