// Runge-Kutta methods on motions with known solutions: their orders as slopes, steps by the tolerance, results between
// the steps, and what they do where there is no solution.
#include "dynamics/runge_kutta.hpp"

#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

namespace koppel {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

struct Problem final : DifferentialEquation {
  using Rate = std::function<bool(double, const Eigen::VectorXd&, Eigen::VectorXd&)>;
  Problem(Eigen::Index n, Rate f) : rate_of(std::move(f)), weights(Eigen::VectorXd::Ones(n)) {}
  Eigen::Index size() const override { return weights.size(); }
  const Eigen::VectorXd& scales() const override { return weights; }
  bool rate(double t, const Eigen::VectorXd& y, Eigen::VectorXd& y_rate) override { return rate_of(t, y, y_rate); }
  Rate rate_of;
  Eigen::VectorXd weights;
};

/// y' depends on y and t, no order condition is idle: y = (e^sin t, cos t).
Problem swinging() {
  return {2, [](double t, const Eigen::VectorXd& y, Eigen::VectorXd& rate) {
            rate[0] = y[0] * y[1] + (y[1] - std::cos(t)) * t;
            rate[1] = -std::sin(t) + 0.5 * (std::cos(t) - y[1]) * y[0];
            return true;
          }};
}
Eigen::VectorXd swinging_at(double t) { return Eigen::Vector2d(std::exp(std::sin(t)), std::cos(t)); }

/// Greatest error at the ends of n steps of the same length over 2 s, and in the middle of them.
struct Errors {
  double ends = 0.0, between = 0.0;
};
Errors errors(int n, bool classical) {
  Problem problem = swinging();
  const double h = 2.0 / n;
  RungeKutta method(problem, classical ? 0.0 : 1e30, h);  // so coarse a tolerance accepts every step
  Errors result;
  EXPECT_TRUE(method.start(0.0, swinging_at(0.0)));
  Eigen::VectorXd y(2);
  for (int i = 1; i <= n; ++i) {
    EXPECT_EQ(method.step(h * i), StepStatus::done);
    EXPECT_EQ(method.time(), h * i);
    result.ends = std::max(result.ends, (method.y() - swinging_at(method.time())).norm());
    method.interpolate(h * (i - 0.4), y);
    result.between = std::max(result.between, (y - swinging_at(h * (i - 0.4))).norm());
  }
  return result;
}

/// log2 of how the error falls when the step is halved; rounding does not count yet.
double slope(double coarse, double fine) { return std::log2(coarse / fine); }

TEST(RungeKutta, PairOfOrderFive) {
  const Errors coarse = errors(32, false), fine = errors(64, false);
  ASSERT_GT(fine.ends, 1e3 * eps);
  EXPECT_GT(slope(coarse.ends, fine.ends), 4.75);
  EXPECT_LT(slope(coarse.ends, fine.ends), 5.75);
  EXPECT_GT(slope(coarse.between, fine.between), 3.75);
}

TEST(RungeKutta, ClassicalMethodOfOrderFour) {
  const Errors coarse = errors(32, true), fine = errors(64, true);
  EXPECT_GT(slope(coarse.ends, fine.ends), 3.75);
  EXPECT_LT(slope(coarse.ends, fine.ends), 4.75);
  EXPECT_GT(slope(coarse.between, fine.between), 3.5);  // a cubic: fourth order in the step
}

TEST(RungeKutta, ErrorFollowsTheTolerance) {
  double before = std::numeric_limits<double>::infinity();
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    Problem problem{2, [](double, const Eigen::VectorXd& y, Eigen::VectorXd& rate) {
                      rate = Eigen::Vector2d(y[1], -y[0]);
                      return true;
                    }};
    RungeKutta method(problem, tolerance, 0.0);
    ASSERT_TRUE(method.start(0.0, Eigen::Vector2d(1.0, 0.0)));
    while (method.time() < 20.0) ASSERT_EQ(method.step(20.0), StepStatus::done);
    EXPECT_EQ(method.time(), 20.0);
    const double error = (method.y() - Eigen::Vector2d(std::cos(20.0), -std::sin(20.0))).norm();
    // Neighbouring solutions keep their distance: errors of steps add up, at most the tolerance in two components each.
    EXPECT_LT(error, std::sqrt(2.0) * tolerance * static_cast<double>(method.statistics().steps));
    EXPECT_LT(error, before / 10.0);
    before = error;
    const RungeKutta::Statistics& counted = method.statistics();
    EXPECT_EQ(counted.evaluations,
              2 + 6 * (counted.steps + counted.rejected));  // the last slope is the next one's first
  }
}

TEST(RungeKutta, ComponentsOfInfiniteScaleDoNotCount) {
  const auto steps = [](double scale) {
    Problem problem{2, [](double t, const Eigen::VectorXd& y, Eigen::VectorXd& rate) {
                      rate[0] = -y[0];
                      rate[1] = std::sin(100.0 * t);
                      return true;
                    }};
    problem.weights[1] = scale;
    RungeKutta method(problem, 1e-8, 0.0);
    EXPECT_TRUE(method.start(0.0, Eigen::Vector2d(1.0, 0.0)));
    while (method.time() < 1.0) EXPECT_EQ(method.step(1.0), StepStatus::done);
    return method.statistics().steps;
  };
  EXPECT_LT(5 * steps(std::numeric_limits<double>::infinity()), steps(1.0));
}

TEST(RungeKutta, StopsWhereTheSolutionEnds) {
  for (const bool nan : {false, true}) {
    Problem problem{1, [nan](double t, const Eigen::VectorXd&, Eigen::VectorXd& rate) {
                      rate[0] = t > 1.0 ? std::nan("") : 1.0;
                      return nan || t <= 1.0;
                    }};
    RungeKutta method(problem, 1e-8, 0.0);
    ASSERT_TRUE(method.start(0.0, Eigen::VectorXd::Zero(1)));
    StepStatus status = StepStatus::done;
    while (status == StepStatus::done && method.time() < 2.0) status = method.step(2.0);
    EXPECT_EQ(status, StepStatus::too_small);
    EXPECT_NEAR(method.time(), 1.0, 1e-12);
    EXPECT_NEAR(method.y()[0], 1.0, 1e-12);
  }
}

TEST(RungeKutta, ACopyGoesOnBitForBit) {
  Problem problem = swinging();
  RungeKutta method(problem, 1e-6, 0.0);
  ASSERT_TRUE(method.start(0.0, swinging_at(0.0)));
  for (int i = 0; i < 5; ++i) ASSERT_EQ(method.step(10.0), StepStatus::done);
  RungeKutta copy = method;
  while (method.time() < 10.0) {
    ASSERT_EQ(method.step(10.0), StepStatus::done);
    ASSERT_EQ(copy.step(10.0), StepStatus::done);
    ASSERT_EQ(copy.time(), method.time());
    ASSERT_EQ(copy.y(), method.y());
  }
}

}  // namespace
}  // namespace koppel
