// Integrators on motions with known solutions: their orders as slopes, steps by the tolerance, results between the
// steps, and what they do where there is no solution.
#include "dynamics/integrator.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "dynamics/runge_kutta.hpp"
#include "dynamics/semi_implicit.hpp"
#include "scene/formulations.hpp"

namespace koppel {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

struct Problem final : DifferentialEquation {
  using Rate = std::function<bool(double, const Eigen::VectorXd&, Eigen::VectorXd&)>;
  Problem(Eigen::Index n, Rate f, Eigen::Index of_positions = 0)
      : rate_of(std::move(f)), weights(Eigen::VectorXd::Ones(n)), first(of_positions) {}
  Eigen::Index size() const override { return weights.size(); }
  const Eigen::VectorXd& scales() const override { return weights; }
  bool rate(double t, const Eigen::VectorXd& y, Eigen::VectorXd& y_rate) override { return rate_of(t, y, y_rate); }
  Eigen::Index positions() const override { return first; }
  Rate rate_of;
  Eigen::VectorXd weights;
  Eigen::Index first;
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

/// A weight on a spring, from 1 at rest: position, then velocity.
Problem oscillator() {
  return {2,
          [](double, const Eigen::VectorXd& y, Eigen::VectorXd& rate) {
            rate = Eigen::Vector2d(y[1], -y[0]);
            return true;
          },
          1};
}
Eigen::VectorXd oscillator_at(double t) { return Eigen::Vector2d(std::cos(t), -std::sin(t)); }

/// Two bodies about each other, the small one on an ellipse of the eccentricity 0.6 about the large one, from the
/// pericentre on; a revolution takes 2 pi.
Problem orbit() {
  return {4,
          [](double, const Eigen::VectorXd& y, Eigen::VectorXd& rate) {
            const double r = std::hypot(y[0], y[1]);
            rate = Eigen::Vector4d(y[2], y[3], -y[0] / (r * r * r), -y[1] / (r * r * r));
            return true;
          },
          2};
}
constexpr double eccentricity = 0.6;
Eigen::VectorXd orbit_at(double t) {
  double e = t;  // the eccentric anomaly, by Newton's method on Kepler's equation
  for (int i = 0; i < 50; ++i) e -= (e - eccentricity * std::sin(e) - t) / (1 - eccentricity * std::cos(e));
  const double b = std::sqrt(1 - eccentricity * eccentricity), r = 1 - eccentricity * std::cos(e);
  return Eigen::Vector4d(std::cos(e) - eccentricity, b * std::sin(e), -std::sin(e) / r, b * std::cos(e) / r);
}

/// Greatest error at the ends of n steps of the same length over 2 s, and between them.
struct Errors {
  double ends = 0.0, between = 0.0;
};
Errors errors(IntegratorKind kind, int n, Problem problem, Eigen::VectorXd (*solution)(double)) {
  const double h = 2.0 / n;
  const auto method = make_integrator(kind, problem, 1e30, h);  // so coarse a tolerance accepts every step
  Errors result;
  EXPECT_TRUE(method->start(0.0, solution(0.0)));
  Eigen::VectorXd y(2);
  for (int i = 1; i <= n; ++i) {
    EXPECT_EQ(method->step(h * i), StepStatus::done);
    EXPECT_EQ(method->time(), h * i);
    result.ends = std::max(result.ends, (method->y() - solution(method->time())).norm());
    for (const double back : {0.2, 0.4, 0.7}) {
      method->interpolate(h * (i - back), y);
      result.between = std::max(result.between, (y - solution(h * (i - back))).norm());
    }
  }
  return result;
}

/// Those of differential equations.
std::vector<IntegratorName> of_rates() {
  std::vector<IntegratorName> names;
  for (const IntegratorName& name : integrators()) {
    if (!formulation_for(name.kind).integrator) names.push_back(name);
  }
  return names;
}

struct Order {
  IntegratorKind kind;
  int steps;
  double ends, between;
};

/// The error falls with the step's power; the pairs between the ends, too. Rounding does not count yet.
void expect_order(const Order& order, const Problem& problem, Eigen::VectorXd (*solution)(double)) {
  const Errors coarse = errors(order.kind, order.steps, problem, solution);
  const Errors fine = errors(order.kind, 2 * order.steps, problem, solution);
  ASSERT_GT(fine.ends, 100 * eps);
  EXPECT_GT(std::log2(coarse.ends / fine.ends), order.ends - 0.3);
  EXPECT_LT(std::log2(coarse.ends / fine.ends), order.ends + 0.8);
  EXPECT_GT(std::log2(coarse.between / fine.between), order.between - 0.35);
}

TEST(Integrators, HaveTheirOrders) {
  const Order orders[] = {{IntegratorKind::dormand_prince, 32, 5, 4},
                          {IntegratorKind::classical, 32, 4, 4},
                          {IntegratorKind::dop853, 10, 8, 7},
                          {IntegratorKind::semi_implicit, 256, 1, 1}};
  for (const Order& order : orders) {
    SCOPED_TRACE(integrators()[static_cast<std::size_t>(order.kind)].name);
    expect_order(order, swinging(), swinging_at);
  }
  expect_order({IntegratorKind::semi_implicit, 256, 1, 1}, oscillator(), oscillator_at);
}

/// Neighbouring solutions keep their distance: errors of steps add up, at most the tolerance in two components each. A
/// decade for what backward differentiation formulas leave uncontrolled when they change their order.
TEST(Integrators, ErrorsFollowTheTolerance) {
  for (const IntegratorName& which : of_rates()) {
    if (which.control == StepControl::step) continue;
    SCOPED_TRACE(which.name);
    double before = std::numeric_limits<double>::infinity();
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      Problem problem = oscillator();
      const auto method = make_integrator(which.kind, problem, tolerance, 0.0);
      ASSERT_TRUE(method->start(0.0, oscillator_at(0.0)));
      double between = 0.0;
      Eigen::VectorXd y(2);
      while (method->time() < 20.0) {
        ASSERT_EQ(method->step(20.0), StepStatus::done);
        const double middle = 0.5 * (method->time_before() + method->time());
        method->interpolate(middle, y);
        between = std::max(between, (y - oscillator_at(middle)).norm());
      }
      EXPECT_EQ(method->time(), 20.0);
      const double error = (method->y() - oscillator_at(20.0)).norm();
      const double allowed = std::sqrt(2.0) * tolerance * static_cast<double>(method->statistics().steps);
      const double decade = which.kind == IntegratorKind::cvode ? 10.0 : 1.0;
      EXPECT_LT(error, decade * allowed);
      EXPECT_LT(between, 10.0 * decade * allowed);
      EXPECT_LT(error, before / 5.0);
      before = error;
    }
  }
}

TEST(Integrators, OfLoopsAreNotForOtherProblems) {
  Problem problem = oscillator();
  for (const IntegratorKind kind : {IntegratorKind::ida, IntegratorKind::generalised_alpha}) {
    EXPECT_EQ(make_integrator(kind, problem, 1e-8, 0.01), nullptr);
  }
}

TEST(Integrators, PairsTakeOneEvaluationLessThanStages) {
  for (const auto& [kind, stages] : {std::pair{IntegratorKind::dormand_prince, 6}, {IntegratorKind::dop853, 12}}) {
    Problem problem = oscillator();
    const auto method = make_integrator(kind, problem, 1e-8, 0.0);
    ASSERT_TRUE(method->start(0.0, oscillator_at(0.0)));
    while (method->time() < 20.0) ASSERT_EQ(method->step(20.0), StepStatus::done);
    const Integrator::Statistics& counted = method->statistics();
    // The last slope is the next one's first; two for the start and the first step's length.
    EXPECT_EQ(counted.evaluations, 2 + static_cast<unsigned>(stages) * (counted.steps + counted.rejected));
  }
}

/// Ten revolutions on an ellipse. A disturbance grows with the revolutions: an error in energy shifts the phase by 3 pi
/// of it each time, at the pericentre's speed of 2.
TEST(Integrators, FollowAnEllipse) {
  const double end = 20.0 * std::acos(-1.0), growth = 2.0 * 3.0 * end;
  for (const IntegratorKind kind : {IntegratorKind::dormand_prince, IntegratorKind::dop853}) {
    for (const double tolerance : {1e-7, 1e-10}) {
      Problem problem = orbit();
      const auto method = make_integrator(kind, problem, tolerance, 0.0);
      ASSERT_TRUE(method->start(0.0, orbit_at(0.0)));
      while (method->time() < end) ASSERT_EQ(method->step(end), StepStatus::done);
      const double steps = static_cast<double>(method->statistics().steps);
      EXPECT_LT((method->y() - orbit_at(end)).norm(), 2.0 * tolerance * steps * growth);
    }
  }
}

/// The orbit of Arenstorf in the restricted three-body problem, once round (Hairer, Norsett, Wanner, II.0.1 and
/// II.0.2).
TEST(Integrators, ComeRoundArenstorfsOrbit) {
  constexpr double mu = 0.012277471, period = 17.0652165601579625588917206249;
  const auto f = [](double, const Eigen::VectorXd& y, Eigen::VectorXd& rate) {
    const double a = std::pow(std::hypot(y[0] + mu, y[1]), 3), b = std::pow(std::hypot(y[0] - 1 + mu, y[1]), 3);
    rate = Eigen::Vector4d(y[2], y[3], y[0] + 2 * y[3] - (1 - mu) * (y[0] + mu) / a - mu * (y[0] - 1 + mu) / b,
                           y[1] - 2 * y[2] - (1 - mu) * y[1] / a - mu * y[1] / b);
    return true;
  };
  const Eigen::Vector4d start(0.994, 0.0, 0.0, -2.00158510637908252240537862224);
  for (const IntegratorKind kind : {IntegratorKind::dormand_prince, IntegratorKind::dop853}) {
    double before = std::numeric_limits<double>::infinity();
    for (const double tolerance : {1e-9, 1e-11, 1e-13}) {
      Problem problem(4, f);
      const auto method = make_integrator(kind, problem, tolerance, 0.0);
      ASSERT_TRUE(method->start(0.0, start));
      while (method->time() < period) ASSERT_EQ(method->step(period), StepStatus::done);
      const double error = (method->y() - start).head<2>().norm();
      EXPECT_LT(error, before / 10.0);
      before = error;
    }
    EXPECT_LT(before, 1e-5);  // near the moon disturbances grow a million times
  }
}

TEST(Integrators, ComponentsOfInfiniteScaleDoNotCount) {
  for (const IntegratorName& which : of_rates()) {
    if (which.control == StepControl::step) continue;
    const auto steps = [&](double scale) {
      Problem problem{2, [](double t, const Eigen::VectorXd& y, Eigen::VectorXd& rate) {
                        rate[0] = -y[0];
                        rate[1] = std::sin(100.0 * t);
                        return true;
                      }};
      problem.weights[1] = scale;
      const auto method = make_integrator(which.kind, problem, 1e-8, 0.0);
      EXPECT_TRUE(method->start(0.0, Eigen::Vector2d(1.0, 0.0)));
      while (method->time() < 1.0) EXPECT_EQ(method->step(1.0), StepStatus::done);
      return method->statistics().steps;
    };
    EXPECT_LT(3 * steps(std::numeric_limits<double>::infinity()), steps(1.0)) << which.name;
  }
}

TEST(Integrators, StopWhereTheSolutionEnds) {
  for (const IntegratorName& which : of_rates()) {
    if (which.control == StepControl::step) continue;
    for (const bool nan : {false, true}) {
      Problem problem{1, [nan](double t, const Eigen::VectorXd&, Eigen::VectorXd& rate) {
                        rate[0] = t > 1.0 ? std::nan("") : 1.0;
                        return nan || t <= 1.0;
                      }};
      const auto method = make_integrator(which.kind, problem, 1e-8, 0.0);
      ASSERT_TRUE(method->start(0.0, Eigen::VectorXd::Zero(1)));
      StepStatus status = StepStatus::done;
      while (status == StepStatus::done && method->time() < 2.0) status = method->step(2.0);
      EXPECT_EQ(status, StepStatus::too_small) << which.name;
      EXPECT_NEAR(method->time(), 1.0, which.kind == IntegratorKind::cvode ? 1e-6 : 1e-12) << which.name;
      EXPECT_NEAR(method->y()[0], method->time(), 1e-12) << which.name;
    }
  }
}

/// x' = -k (x - cos t): after 1/k it follows the cosine, and steps of 3/k are all that explicit methods can take.
/// On both sides of zero the way leads back to it: steps across are no longer than the tolerance, without an end.
TEST(Integrators, StepsThatHardlyGoOnEnd) {
  for (const IntegratorKind kind : {IntegratorKind::cvode, IntegratorKind::arkode}) {
    SCOPED_TRACE(integrators()[static_cast<std::size_t>(kind)].name);
    Problem problem{1, [](double, const Eigen::VectorXd& y, Eigen::VectorXd& rate) {
                      rate[0] = y[0] > 0.0 ? -1.0 : 1.0;
                      return true;
                    }};
    const auto method = make_integrator(kind, problem, 1e-13, 0.0);
    ASSERT_TRUE(method->start(0.0, Eigen::VectorXd::Constant(1, 0.1)));
    StepStatus status = StepStatus::done;
    while (status == StepStatus::done && method->statistics().steps < 1000000) status = method->step(1.0);
    EXPECT_EQ(status, StepStatus::too_small);
    EXPECT_NEAR(method->time(), 0.1, 1e-6);
  }
}

TEST(Integrators, StiffnessIsSeenAndCvodeMindsItNot) {
  constexpr double k = 1e5;
  const auto run = [](IntegratorKind kind) {
    Problem problem{1, [](double t, const Eigen::VectorXd& y, Eigen::VectorXd& rate) {
                      rate[0] = -k * (y[0] - std::cos(t));
                      return true;
                    }};
    const auto method = make_integrator(kind, problem, 1e-6, 0.0);
    EXPECT_TRUE(method->start(0.0, Eigen::VectorXd::Zero(1)));
    while (method->time() < 1.0) EXPECT_EQ(method->step(1.0), StepStatus::done);
    EXPECT_NEAR(method->y()[0], (k * k * std::cos(1.0) + k * std::sin(1.0)) / (1 + k * k), 1e-5);
    return method->statistics();
  };
  const auto implicit = run(IntegratorKind::cvode);
  EXPECT_FALSE(implicit.stiff);
  EXPECT_LT(implicit.steps, 1000u);
  for (const IntegratorKind kind : {IntegratorKind::dormand_prince, IntegratorKind::dop853}) {
    const auto explicit_ = run(kind);
    EXPECT_TRUE(explicit_.stiff);
    EXPECT_GT(explicit_.steps, k / 10.0);  // the stability domains are shorter
  }
  Problem easy = swinging();
  const auto method = make_integrator(IntegratorKind::dormand_prince, easy, 1e-6, 0.0);
  ASSERT_TRUE(method->start(0.0, swinging_at(0.0)));
  while (method->time() < 10.0) ASSERT_EQ(method->step(10.0), StepStatus::done);
  EXPECT_FALSE(method->statistics().stiff);
}

/// The energy of an oscillator stays within the step's length of where it was, however long it swings.
TEST(SemiImplicit, KeepsEnergyWithinBounds) {
  Problem problem = oscillator();
  SemiImplicitEuler method(problem, 0.0, 0.1);
  ASSERT_TRUE(method.start(0.0, oscillator_at(0.0)));
  for (int i = 0; i < 100000; ++i) {
    ASSERT_EQ(method.step(1e9), StepStatus::done);
    ASSERT_NEAR(0.5 * method.y().squaredNorm(), 0.5, 0.5 * 0.1);
  }
}

TEST(Integrators, AShortenedStepEndsWhereItShould) {
  for (const IntegratorName& which : of_rates()) {
    SCOPED_TRACE(which.name);
    const double step = which.kind == IntegratorKind::semi_implicit ? 1e-6 : 0.01;
    Problem problem = swinging();
    const auto method = make_integrator(which.kind, problem, 1e-8, which.control == StepControl::step ? step : 0.0);
    ASSERT_TRUE(method->start(0.0, swinging_at(0.0)));
    for (int i = 0; i < 10; ++i) ASSERT_EQ(method->step(2.0), StepStatus::done);
    const double before = method->time_before(), t = before + 0.3 * (method->time() - before);
    ASSERT_TRUE(method->shorten(t));
    EXPECT_EQ(method->time(), t);
    EXPECT_EQ(method->time_before(), before);
    EXPECT_LT((method->y() - swinging_at(t)).norm(), 1e-6);
    Eigen::VectorXd y(2);
    method->interpolate(0.5 * (before + t), y);
    EXPECT_LT((y - swinging_at(0.5 * (before + t))).norm(), 1e-6);
    ASSERT_EQ(method->step(2.0), StepStatus::done);
    EXPECT_LT((method->y() - swinging_at(method->time())).norm(), 1e-6);
  }
}

template <typename Method>
void expect_copies_to_agree(double step) {
  Problem problem = swinging();
  Method method(problem, 1e-6, step);
  ASSERT_TRUE(method.start(0.0, swinging_at(0.0)));
  for (int i = 0; i < 5; ++i) ASSERT_EQ(method.step(10.0), StepStatus::done);
  Method copy = method;
  Eigen::VectorXd y(2), of_copy(2);
  while (method.time() < 10.0) {
    ASSERT_EQ(method.step(10.0), StepStatus::done);
    ASSERT_EQ(copy.step(10.0), StepStatus::done);
    ASSERT_EQ(copy.time(), method.time());
    ASSERT_EQ(copy.y(), method.y());
    const double middle = 0.5 * (method.time_before() + method.time());
    method.interpolate(middle, y);
    copy.interpolate(middle, of_copy);
    ASSERT_EQ(of_copy, y);
  }
}

TEST(Integrators, ACopyGoesOnBitForBit) {
  expect_copies_to_agree<DormandPrince>(0.0);
  expect_copies_to_agree<Dop853>(0.0);
  expect_copies_to_agree<ClassicalRungeKutta>(0.03);
  expect_copies_to_agree<SemiImplicitEuler>(0.03);
}

}  // namespace
}  // namespace koppel
