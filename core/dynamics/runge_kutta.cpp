#include "dynamics/runge_kutta.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace koppel {
namespace {

constexpr double safety = 0.9, least_error = 1e-4;
constexpr double most_blur = 1e-8;
constexpr int most_lengths = 6;  // that are tried where rounding disturbs
constexpr double lengthening = 1.2;

}  // namespace

RungeKutta::RungeKutta(const RungeKuttaTable& table, DifferentialEquation& problem, double tolerance, double step)
    : Integrator(problem, tolerance, step),
      table_(&table),
      k_(table.stages.size() + table.between.size()),
      polynomial_(3 + table.polynomial.size()) {
  resize(problem.size());
}

void RungeKutta::resize(Eigen::Index n) {
  for (auto* y : {&y_, &trial_, &y_before_, &late_, &sum_}) y->setZero(n);
  for (auto& k : k_) k.setZero(n);
  for (auto& p : polynomial_) p.setZero(n);
}

bool RungeKutta::start(double t, const Eigen::VectorXd& y) {
  time_ = before_ = t;
  y_ = y_before_ = y;
  fresh_ = true;
  stepped_ = false;
  last_error_ = least_error;
  stiff_steps_ = other_steps_ = 0;
  if (!evaluate(t, y_, k_[0])) return false;
  rounding_at_end_ = problem_->rounding();
  return true;
}

bool RungeKutta::restart(double t, const Eigen::VectorXd& y) {
  const double error = last_error_;
  const bool fresh = fresh_;
  if (y.size() != y_.size()) resize(y.size());
  const bool defined = start(t, y);
  last_error_ = error;
  fresh_ = fresh;
  return defined;
}

bool RungeKutta::exchange(Archive& archive) {
  const Eigen::Index n = problem_->size();
  bool fit = Integrator::exchange(archive);
  archive(last_error_, rounding_at_end_, fresh_, stepped_, joined_, stiff_steps_, other_steps_);
  const auto vector = [&](Eigen::VectorXd& x) {
    archive(x);
    fit = fit && x.size() == n;
  };
  for (Eigen::VectorXd* x : {&y_before_, &trial_, &late_}) vector(*x);
  for (Eigen::VectorXd& k : k_) vector(k);
  for (Eigen::VectorXd& p : polynomial_) vector(p);
  sum_.setZero(n);
  return archive.good() && fit;
}

/// Slopes of stages, the first of which is the `first`; trial_ is where the last one stands, late_ the one before.
bool RungeKutta::evaluate_stages(std::span<const RungeKuttaTable::Stage> stages, std::size_t first, double h) {
  for (std::size_t i = first; i < first + stages.size(); ++i) {
    const RungeKuttaTable::Stage& stage = stages[i - first];
    late_.swap(trial_);
    trial_ = y_before_;
    for (std::size_t j = 0; j < i; ++j) {
      if (stage.weights[j] != 0.0) trial_ += h * stage.weights[j] * k_[j];
    }
    if (!evaluate(before_ + stage.node * h, trial_, k_[i])) return false;
    rounding_ = std::max(rounding_, problem_->rounding());
  }
  return true;
}

/// What rounding may make of a step's error; beside singular positions it grows where steps become shorter, so that no
/// tolerance below it can be met there. What is more than a limit comes from a stage that stood on such a position: the
/// next try has its stages elsewhere.
double RungeKutta::blur(double h) const { return std::min(h * rounding_, most_blur); }

/// Root mean square of a sum of slopes over the tolerance, in the scales of what is controlled.
double RungeKutta::norm(const RungeKuttaTable::Weights& weights, double h) {
  sum_.setZero();
  for (std::size_t i = 0; i < table_->stages.size(); ++i) {
    if (weights[i] != 0.0) sum_ += weights[i] * k_[i];
  }
  const Eigen::VectorXd& scales = problem_->scales();
  double total = 0.0;
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < y_.size(); ++i) {
    if (!std::isfinite(scales[i])) continue;
    const double size = std::max({scales[i], std::abs(y_before_[i]), std::abs(trial_[i])});
    total += std::pow(h * sum_[i] / (tolerance_ * size), 2);
    ++count;
  }
  return count == 0 ? 0.0 : std::sqrt(total / static_cast<double>(count));
}

double RungeKutta::error(double h) {
  const double higher = norm(table_->errors[0], h);
  if (table_->errors.size() == 1 || higher == 0.0) return higher;
  const double lower = norm(table_->errors[1], h);
  return higher * higher / std::sqrt(higher * higher + 0.01 * lower * lower);
}

/// Hairer's guess: such that an Euler step would change little, and its slope too.
double RungeKutta::first_step(double limit) {
  const Eigen::VectorXd& scales = problem_->scales();
  const auto size_of = [&](const Eigen::VectorXd& x) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < y_.size(); ++i) {
      if (std::isfinite(scales[i])) sum += std::pow(x[i] / std::max(scales[i], std::abs(y_[i])), 2);
    }
    return std::sqrt(sum / static_cast<double>(std::max<Eigen::Index>(1, y_.size())));
  };
  const double span = limit - time_, slope = size_of(k_[0]);
  const double h = std::min(span, slope > 1e-10 ? 0.01 / slope : 1e-3 * span);
  trial_ = y_ + h * k_[0];
  if (!evaluate(time_ + h, trial_, k_[1])) return 1e-3 * h;
  sum_ = k_[1] - k_[0];
  const double curvature = size_of(sum_) / h, greatest = std::max(slope, curvature);
  const double fitting = greatest > 1e-15 ? std::pow(0.01 * tolerance_ / greatest, 1.0 / table_->order) : span;
  return std::min({100.0 * h, fitting, span});
}

StepStatus RungeKutta::step(double limit) {
  if (stepped_) k_[0] = last_slope();
  stepped_ = false;
  if (!is_fixed() && fresh_ && step_ == 0.0) step_ = first_step(limit);
  y_before_ = y_;
  before_ = time_;
  const double least = 16.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(time_), std::abs(limit));
  double h = step_;
  bool rejected = false;
  int lengths = 0;
  double best = std::numeric_limits<double>::infinity(), best_length = h;
  for (;;) {
    // A rest that is hardly longer than a step is halved or taken whole, not left as a sliver.
    const double rest = limit - time_;
    const bool last = rest <= h * (1.0 + 1e-9);
    const double tried = last ? rest : (!is_fixed() && rest < 2.0 * h ? rest / 2.0 : h);
    const double end = last ? limit : time_ + tried;
    const double length = end - time_;  // what is tried, rounded: steps add up to the time that has passed
    if (!last && tried < least) return StepStatus::too_small;
    rounding_ = rounding_at_end_;
    const bool defined = evaluate_stages(table_->stages.subspan(1), 1, length);
    const double e = defined && !is_fixed() ? error(length) : 0.0;
    const bool blurred = defined && !is_fixed() && blur(length) > tolerance_;
    if (e > 1.0 && lengths < most_lengths && (blurred || lengths > 0)) {
      // Other lengths have their stages elsewhere: the one that rounding disturbs least is taken in the end.
      if (e < best) {
        best = e;
        best_length = tried;
      }
      ++statistics_.rejected;
      lengths = blurred ? lengths + 1 : most_lengths;
      h = lengths < most_lengths ? lengthening * tried : best_length;
      continue;
    }
    if (defined && (e <= 1.0 || (blurred && e <= blur(length) / tolerance_))) {
      ++statistics_.steps;
      if (!is_fixed()) {
        control(std::min(e, 1.0), tried, lengths > 0 ? tried : h, rejected || blurred);
        look_for_stiffness(length);
      }
      finish(end);
      return StepStatus::done;
    }
    if (is_fixed() || tried < least) return StepStatus::too_small;
    ++statistics_.rejected;
    rejected = true;
    const double factor = safety * std::pow(e, -table_->power - table_->memory / 2.0);
    h = tried * (defined && std::isfinite(e) ? std::max(table_->cut, factor) : 0.25);
  }
}

/// The next step's length by the error of the one that was tried instead of one wanted.
void RungeKutta::control(double error, double tried, double wanted, bool may_not_grow) {
  const double factor =
      safety * std::pow(std::max(error, 1e-10), -table_->power) * std::pow(last_error_, table_->memory);
  const double growth = std::clamp(factor, table_->cut, may_not_grow ? 1.0 : table_->growth);
  // A step that was shortened by the limit says little of the next one's length.
  step_ = tried < wanted ? std::max(wanted, tried * growth) : tried * growth;
  last_error_ = std::max(error, least_error);
  fresh_ = false;
}

/// The last two stages stand at the same time: how their slopes differ by their places tells the greatest eigenvalue
/// (IV.2). Stiff is what keeps the step at the border of stability for many steps, with few others between.
void RungeKutta::look_for_stiffness(double h) {
  const Eigen::VectorXd& scales = problem_->scales();
  const Eigen::VectorXd& late_slope = k_[table_->stages.size() - 2];
  double slopes = 0.0, places = 0.0;
  for (Eigen::Index i = 0; i < y_.size(); ++i) {
    if (!std::isfinite(scales[i])) continue;
    slopes += std::pow((last_slope()[i] - late_slope[i]) / scales[i], 2);
    places += std::pow((trial_[i] - late_[i]) / scales[i], 2);
  }
  if (places > 0.0 && h * std::sqrt(slopes / places) > table_->stability) {
    other_steps_ = 0;
    if (++stiff_steps_ == 15) statistics_.stiff = true;
  } else if (++other_steps_ == 6) {
    stiff_steps_ = 0;
  }
}

/// The step from before_ has succeeded: trial_ is its result.
void RungeKutta::finish(double end) {
  time_ = end;
  y_ = trial_;
  rounding_at_end_ = problem_->rounding();
  stepped_ = true;
  joined_ = false;
}

bool RungeKutta::shorten(double t) {
  if (!evaluate_stages(table_->stages.subspan(1), 1, t - before_)) return false;
  finish(t);
  return true;
}

/// Makes the polynomial between the ends. False: not all its stages can be evaluated.
bool RungeKutta::take_between() {
  const double h = time_ - before_;
  polynomial_[0] = trial_ - y_before_;
  polynomial_[1] = h * k_[0] - polynomial_[0];
  polynomial_[2] = polynomial_[0] - h * last_slope() - polynomial_[1];
  for (std::size_t i = 3; i < polynomial_.size(); ++i) polynomial_[i].setZero();
  joined_ = true;
  if (!evaluate_stages(table_->between, table_->stages.size(), h)) return false;
  for (std::size_t i = 0; i < table_->polynomial.size(); ++i) {
    for (std::size_t j = 0; j < k_.size(); ++j) {
      if (table_->polynomial[i][j] != 0.0) polynomial_[3 + i] += h * table_->polynomial[i][j] * k_[j];
    }
  }
  return true;
}

void RungeKutta::interpolate(double t, Eigen::VectorXd& y) {
  if (!stepped_ || t == time_) {
    y = y_;
    return;
  }
  // Without its stages the polynomial is still Hermite's cubic one.
  if (!joined_) take_between();
  const double s = (t - before_) / (time_ - before_), r = 1.0 - s;
  y = polynomial_.back();
  for (std::size_t i = polynomial_.size() - 1; i-- > 0;) y = polynomial_[i] + (i % 2 == 0 ? r : s) * y;
  y = y_before_ + s * y;
}

}  // namespace koppel
