// The standard functions: values by hand, derivatives against differences of the values, smoothness where pieces meet.
#include <algorithm>
#include <cmath>
#include <limits>

#include "curve.hpp"
#include "fixtures.hpp"

namespace koppel::test {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double eps = std::numeric_limits<double>::epsilon();

struct Jet {
  double value, first, second;
};

class Function {
 public:
  Function(const std::string& name, const Given& given)
      : type_(expect_value(registry_.function(name, {}))), instance_(expect_value(create(*type_, given))) {}

  Jet operator()(double x) const {
    const void* pointer = instance_.get();
    double out[3] = {};
    EXPECT_EQ(type_->calls.evaluate(1, &pointer, &x, out), KOPPEL_OK);
    return {out[0], out[1], out[2]};
  }

 private:
  Registry registry_{linked_in()};
  const FunctionType* type_;
  Instance instance_;
};

Result<Instance> try_create(const std::string& name, const Given& given) {
  Registry registry(linked_in());
  return create(*expect_value(registry.function(name, {})), given);
}

/// scale: greatest value near x; seventh, eighth: bounds of those derivatives. The tolerance is the truncation of the
/// sixth-order formula, h^6/140 f^(7), plus its rounding 2 * 8 eps scale / h for a function that is right to 8 eps.
void expect_derivatives(const Function& f, double x, double h, double scale, double seventh, double eighth) {
  const Jet at = f(x);
  const auto value = [&](double t) { return f(x + t).value; };
  const auto first = [&](double t) { return f(x + t).first; };
  // What x + t loses to rounding is a change of argument.
  const double argument = 2 * eps * (std::abs(x) + 3 * h) / h;
  const double by_value = std::pow(h, 6) / 140 * seventh + 16 * eps * scale / h + argument * std::abs(at.first);
  const double rate = std::max({std::abs(f(x - 3 * h).first), std::abs(at.first), std::abs(f(x + 3 * h).first)});
  const double by_first =
      std::pow(h, 6) / 140 * eighth + 16 * eps * (rate + scale) / h + argument * (std::abs(at.second) + rate);
  EXPECT_NEAR(at.first, derivative(value, h), 2 * by_value) << "at " << x;
  EXPECT_NEAR(at.second, derivative(first, h), 2 * by_first) << "at " << x;
}

TEST(Constant, StaysAsItIs) {
  const Jet jet = Function("constant", {{"value", {3}}})(7);
  EXPECT_EQ(jet.value, 3.0);
  EXPECT_EQ(jet.first, 0.0);
  EXPECT_EQ(jet.second, 0.0);
}

TEST(Ramp, RisesFromItsStart) {
  const Jet jet = Function("ramp", {{"start", {3}}, {"slope", {-0.5}}})(2);
  EXPECT_EQ(jet.value, 2.0);
  EXPECT_EQ(jet.first, -0.5);
  EXPECT_EQ(jet.second, 0.0);
}

TEST(Sine, CountsItsFrequencyInHertz) {
  const Function f("sine", {{"amplitude", {2}}, {"frequency", {0.5}}, {"phase", {pi / 6}}, {"offset", {10}}});
  EXPECT_NEAR(f(0).value, 11.0, 16 * eps);
  EXPECT_NEAR(f(2).value, f(0).value, 16 * 2 * pi * eps);  // one period; the argument is right to eps * 2 pi
  for (double x = -3; x < 3; x += 0.37) {
    expect_derivatives(f, x, difference_step, 12, 2 * std::pow(pi, 7), 2 * std::pow(pi, 8));
  }
}

TEST(Polynomial, HasItsConstantTermFirst) {
  const Function f("polynomial", {{"coefficients", {1, 2, 3, 4}}});
  const Jet jet = f(2);
  EXPECT_EQ(jet.value, 1 + 2 * 2 + 3 * 4 + 4 * 8.0);
  EXPECT_EQ(jet.first, 2 + 6 * 2 + 12 * 4.0);
  EXPECT_EQ(jet.second, 6 + 24 * 2.0);
  for (double x = -2; x < 2; x += 0.29) expect_derivatives(f, x, difference_step, 49, 0, 0);
}

TEST(Polynomial, MayBeAConstant) {
  const Jet jet = Function("polynomial", {{"coefficients", {5}}})(3);
  EXPECT_EQ(jet.value, 5.0);
  EXPECT_EQ(jet.first, 0.0);
  EXPECT_EQ(jet.second, 0.0);
}

TEST(Cycloid, RestsBeforeAndAfter) {
  const Function f("cycloid", {{"from", {1}}, {"to", {3}}, {"start", {2}}, {"duration", {4}}});
  for (const auto& [x, value] : {std::pair{-5.0, 1.0}, {2.0, 1.0}, {6.0, 3.0}, {50.0, 3.0}}) {
    EXPECT_EQ(f(x).value, value);
    EXPECT_EQ(f(x).first, 0.0);
    EXPECT_EQ(f(x).second, 0.0);
  }
  EXPECT_DOUBLE_EQ(f(4).value, 2.0);
  EXPECT_DOUBLE_EQ(f(4).first, 1.0);  // twice the mean rate
}

TEST(Cycloid, IsSmoothWhereItBeginsAndEnds) {
  const double rise = 2, duration = 4;
  const Function f("cycloid", {{"from", {1}}, {"to", {1 + rise}}, {"start", {2}}, {"duration", {duration}}});
  // Within a distance d of an end: second <= (2 pi)^2 rise/T^3 d, first <= half of that times d, the value a third.
  const double jerk = 4 * pi * pi * rise / std::pow(duration, 3);
  const double d = 1e-6;
  for (const double inside : {2 + d, 6 - d}) {
    EXPECT_LE(std::abs(f(inside).second), jerk * d * (1 + 1e-9));
    EXPECT_LE(std::abs(f(inside).first), jerk * d * d);
    EXPECT_NEAR(f(inside).value, inside < 4 ? 1 : 3, jerk * d * d * d + 8 * eps);
  }
  const double w = 2 * pi / duration;
  for (double x = 2.1; x < 5.9; x += 0.31) {
    expect_derivatives(f, x, difference_step, 3, rise / duration * std::pow(w, 6), rise / duration * std::pow(w, 7));
  }
}

TEST(Cycloid, RefusesAJump) {
  const auto instance = try_create("cycloid", {{"to", {1}}, {"duration", {0}}});
  ASSERT_FALSE(instance);
  expect_mentions(instance.error(), {"cycloid", "duration", "greater than zero"});
}

const std::vector<double> points = {-1, 0.5, 0, 2, 0.25, 1.5, 1.5, -1, 2, 0, 4, 0.125};

TEST(Table, GoesThroughItsPoints) {
  const Function f("table", {{"points", points}});
  for (std::size_t i = 0; i < points.size(); i += 2) EXPECT_NEAR(f(points[i]).value, points[i + 1], 4 * eps);
}

TEST(Table, IsTheNaturalSpline) {
  // Through (0,0), (1,1), (2,0): the moment in the middle is -3, so f(1/2) = 11/16 and f'(0) = 3/2.
  const Function f("table", {{"points", {0, 0, 1, 1, 2, 0}}});
  EXPECT_DOUBLE_EQ(f(1).second, -3.0);
  EXPECT_DOUBLE_EQ(f(0.5).value, 11.0 / 16);
  EXPECT_DOUBLE_EQ(f(0).first, 1.5);
  EXPECT_EQ(f(0).second, 0.0);
  EXPECT_EQ(f(2).second, 0.0);
}

TEST(Table, HasNoJumpsAtItsPoints) {
  const Function f("table", {{"points", points}});
  for (std::size_t i = 0; i < points.size(); i += 2) {
    // Between neighbouring doubles a smooth function changes by eps times its rates (below 100 here).
    const double x = points[i];
    const Jet before = f(std::nextafter(x, -10)), after = f(std::nextafter(x, 10));
    EXPECT_NEAR(before.value, after.value, 100 * 4 * eps) << "at " << x;
    EXPECT_NEAR(before.first, after.first, 100 * 4 * eps) << "at " << x;
    EXPECT_NEAR(before.second, after.second, 100 * 16 * eps) << "at " << x;
  }
}

TEST(Table, HasTheDerivativesOfItsValues) {
  const Function f("table", {{"points", points}});
  // Between the points the curve is a cubic: no truncation.
  for (const double x : {-0.6, 0.125, 0.8, 1.75, 3.1}) expect_derivatives(f, x, difference_step, 20, 0, 0);
}

TEST(Table, GoesOnStraight) {
  const Function f("table", {{"points", points}});
  for (const double end : {-1.0, 4.0}) {
    const Jet at = f(end), beyond = f(2 * end);
    EXPECT_DOUBLE_EQ(beyond.first, at.first);
    EXPECT_DOUBLE_EQ(beyond.value, at.value + at.first * end);
    EXPECT_EQ(beyond.second, 0.0);
  }
}

TEST(Table, OfTwoPointsIsALine) {
  const Jet jet = Function("table", {{"points", {1, 2, 3, 6}}})(2);
  EXPECT_DOUBLE_EQ(jet.value, 4.0);
  EXPECT_DOUBLE_EQ(jet.first, 2.0);
  EXPECT_EQ(jet.second, 0.0);
}

TEST(Table, RefusesTimesThatDoNotIncrease) {
  for (const double time : {0.0, -1.0}) {
    const auto instance = try_create("table", {{"points", {0, 0, time, 1}}});
    ASSERT_FALSE(instance);
    expect_mentions(instance.error(), {"table", "points", "do not increase"});
  }
}

}  // namespace
}  // namespace koppel::test
