#include "dynamics/runge_kutta.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace koppel {
namespace {

// Dormand and Prince (1980), table 5.2 of the book.
constexpr std::array<double, 7> nodes{0, 1.0 / 5, 3.0 / 10, 4.0 / 5, 8.0 / 9, 1, 1};
constexpr double table[7][6] = {
    {},
    {1.0 / 5},
    {3.0 / 40, 9.0 / 40},
    {44.0 / 45, -56.0 / 15, 32.0 / 9},
    {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
    {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
    {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84},
};
// Difference of the two results.
constexpr std::array<double, 7> error_weights{71.0 / 57600,      0,          -71.0 / 16695, 71.0 / 1920,
                                              -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
// Of the fourth power in the continuous result (II.6, Shampine 1986).
constexpr std::array<double, 7> dense_weights{-12715105075.0 / 11282082432,  0,
                                              87487479700.0 / 32700410799,   -10690763975.0 / 1880347072,
                                              701980252875.0 / 199316789632, -1453857185.0 / 822651844,
                                              69997945.0 / 29380423};

constexpr double safety = 0.9, largest_growth = 10.0, largest_cut = 0.2;
constexpr double power = 0.17, memory = 0.04;  // of the controller that also looks at the step before (II.4)

}  // namespace

RungeKutta::RungeKutta(DifferentialEquation& problem, double tolerance, double step)
    : problem_(&problem), tolerance_(tolerance), step_(step) {
  resize(problem.size());
}

void RungeKutta::resize(Eigen::Index n) {
  for (auto* y : {&y_, &trial_, &y_before_, &sum_}) y->setZero(n);
  for (auto& k : k_) k.setZero(n);
  for (auto& c : continuous_) c.setZero(n);
}

bool RungeKutta::evaluate(double t, const Eigen::VectorXd& y, Eigen::VectorXd& rate) {
  ++statistics_.evaluations;
  return problem_->rate(t, y, rate) && rate.allFinite();
}

bool RungeKutta::start(double t, const Eigen::VectorXd& y) {
  time_ = before_ = t;
  y_ = y_before_ = y;
  for (auto& c : continuous_) c.setZero();
  fresh_ = true;
  last_error_ = 1e-4;
  return evaluate(t, y_, k_[0]);
}

bool RungeKutta::restart(const Eigen::VectorXd& y) {
  const double step = step_, error = last_error_;
  const bool fresh = fresh_;
  resize(y.size());
  const bool defined = start(time_, y);
  step_ = step;
  last_error_ = error;
  fresh_ = fresh;
  return defined;
}

/// All stages of a step; the result stands in trial_ and its slope in the last stage.
bool RungeKutta::stages(double h) {
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    trial_ = y_;
    for (std::size_t j = 0; j < i; ++j) {
      if (table[i][j] != 0.0) trial_ += h * table[i][j] * k_[j];
    }
    if (!evaluate(time_ + nodes[i] * h, trial_, k_[i])) return false;
  }
  return true;
}

bool RungeKutta::classical(double h) {
  const double half = h / 2.0;
  trial_ = y_ + half * k_[0];
  if (!evaluate(time_ + half, trial_, k_[1])) return false;
  trial_ = y_ + half * k_[1];
  if (!evaluate(time_ + half, trial_, k_[2])) return false;
  trial_ = y_ + h * k_[2];
  if (!evaluate(time_ + h, trial_, k_[3])) return false;
  trial_ = y_ + h / 6.0 * (k_[0] + 2.0 * k_[1] + 2.0 * k_[2] + k_[3]);
  return evaluate(time_ + h, trial_, k_[6]);
}

double RungeKutta::error(double h) const {
  const Eigen::VectorXd& scales = problem_->scales();
  double sum = 0.0;
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < y_.size(); ++i) {
    if (!std::isfinite(scales[i])) continue;
    double difference = 0.0;
    for (std::size_t k = 0; k < error_weights.size(); ++k) difference += error_weights[k] * k_[k][i];
    const double size = std::max({scales[i], std::abs(y_[i]), std::abs(trial_[i])});
    sum += std::pow(h * difference / (tolerance_ * size), 2);
    ++count;
  }
  return count == 0 ? 0.0 : std::sqrt(sum / static_cast<double>(count));
}

/// Hairer's guess: such that an Euler step would change little, and its slope too.
double RungeKutta::first_step(double limit) {
  const Eigen::VectorXd& scales = problem_->scales();
  const auto norm = [&](const auto& x) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < y_.size(); ++i) {
      if (std::isfinite(scales[i])) sum += std::pow(x[i] / std::max(scales[i], std::abs(y_[i])), 2);
    }
    return std::sqrt(sum / static_cast<double>(std::max<Eigen::Index>(1, y_.size())));
  };
  const double span = limit - time_, slope = norm(k_[0]);
  double h = std::min(span, slope > 1e-10 ? 0.01 / slope : 1e-3 * span);
  trial_ = y_ + h * k_[0];
  if (!evaluate(time_ + h, trial_, k_[1])) return 1e-3 * h;
  sum_ = k_[1] - k_[0];
  const double curvature = norm(sum_) / h, greatest = std::max(slope, curvature);
  const double fitting = greatest > 1e-15 ? std::pow(0.01 * tolerance_ / greatest, 0.2) : span;
  return std::min({100.0 * h, fitting, span});
}

StepStatus RungeKutta::step(double limit) {
  const bool fixed = tolerance_ == 0.0;
  if (!fixed && fresh_ && step_ == 0.0) step_ = first_step(limit);
  const double least = 16.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(time_), std::abs(limit));
  double h = step_;
  bool rejected = false;
  for (;;) {
    // A rest that is hardly longer than a step is halved or taken whole, not left as a sliver.
    const double rest = limit - time_;
    const bool last = rest <= h * (1.0 + 1e-9);
    const double tried = last ? rest : (!fixed && rest < 2.0 * h ? rest / 2.0 : h);
    if (!last && tried < least) return StepStatus::too_small;
    const bool defined = fixed ? classical(tried) : stages(tried);
    if (!defined) {
      if (fixed || tried < least) return StepStatus::too_small;
      h = tried / 4.0;
      ++statistics_.rejected;
      rejected = true;
      continue;
    }
    const double e = fixed ? 0.0 : error(tried);
    if (!(e <= 1.0)) {
      if (tried < least) return StepStatus::too_small;
      h = std::isfinite(e) ? tried * std::max(largest_cut, safety * std::pow(e, -power - memory / 2.0)) : tried / 4.0;
      ++statistics_.rejected;
      rejected = true;
      continue;
    }
    ++statistics_.steps;
    if (!fixed) {
      const double wanted = safety * std::pow(std::max(e, 1e-10), -power) * std::pow(last_error_, memory);
      const double growth = std::clamp(wanted, largest_cut, rejected ? 1.0 : largest_growth);
      // A step that was shortened by the limit says little of the next one's length.
      step_ = tried < h ? std::max(h, tried * growth) : tried * growth;
      last_error_ = std::max(e, 1e-4);
    }
    fresh_ = false;
    y_before_ = y_;
    const Eigen::VectorXd& last_slope = k_[6];
    continuous_[0] = trial_ - y_;
    continuous_[1] = tried * k_[0] - continuous_[0];
    continuous_[2] = continuous_[0] - tried * last_slope - continuous_[1];
    continuous_[3].setZero();
    if (!fixed) {
      for (std::size_t i = 0; i < dense_weights.size(); ++i) continuous_[3] += tried * dense_weights[i] * k_[i];
    }
    before_ = time_;
    time_ = last ? limit : time_ + tried;
    y_ = trial_;
    k_[0] = last_slope;
    return StepStatus::done;
  }
}

void RungeKutta::interpolate(double t, Eigen::VectorXd& y) const {
  if (time_ == before_ || t == time_) {
    y = y_;
    return;
  }
  const double s = (t - before_) / (time_ - before_), r = 1.0 - s;
  y = y_before_ + s * (continuous_[0] + r * (continuous_[1] + s * (continuous_[2] + r * continuous_[3])));
}

}  // namespace koppel
