// Roots of closure conditions in one coordinate, against where they were built from and against a dense scan.
#include "closure/scalar_roots.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "../spatial/directions.hpp"

namespace koppel::test {
namespace {

constexpr double pi = std::numbers::pi, eps = 2.3e-16;

double apart(double a, double b) { return std::abs(std::remainder(a - b, 2.0 * pi)); }

std::vector<double> listed(const Roots& r) { return {r.values.begin(), r.values.begin() + r.count}; }

double distance_to(const Roots& r, double x) {
  double least = 10.0;
  for (double value : listed(r)) least = std::min(least, apart(value, x));
  return least;
}

double amplitude(const FirstHarmonic& f) { return std::hypot(f.c1, f.s1); }
double amplitude(const SecondHarmonic& f) { return std::hypot(std::hypot(f.c1, f.s1), std::hypot(f.c2, f.s2)); }

FirstHarmonic random_first(Random& random) { return {random.normal(), random.normal(), random.normal()}; }

/// f g, of second order.
SecondHarmonic product(const FirstHarmonic& f, const FirstHarmonic& g) {
  return {f.c0 * g.c0 + 0.5 * (f.c1 * g.c1 + f.s1 * g.s1), f.c0 * g.c1 + f.c1 * g.c0, f.c0 * g.s1 + f.s1 * g.c0,
          0.5 * (f.c1 * g.c1 - f.s1 * g.s1), 0.5 * (f.c1 * g.s1 + f.s1 * g.c1)};
}

/// Zero at middle -+ half.
FirstHarmonic with_roots(double middle, double half) { return {-std::cos(half), std::cos(middle), std::sin(middle)}; }

TEST(ScalarRoots, SamplesGiveTheCoefficientsBack) {
  Random random(1);
  for (int n = 0; n < 1000; ++n) {
    const FirstHarmonic f = random_first(random);
    const SecondHarmonic g = product(f, random_first(random));
    const Quadratic h = {random.normal(), random.normal(), random.normal(), 0.3};
    std::array<double, 3> first{}, quadratic{};
    std::array<double, 5> second{};
    for (std::size_t i = 0; i < 3; ++i) first[i] = f.value(FirstHarmonic::samples[i]);
    for (std::size_t i = 0; i < 5; ++i) second[i] = g.value(SecondHarmonic::samples[i]);
    for (std::size_t i = 0; i < 3; ++i) quadratic[i] = h.value(h.length * Quadratic::samples[i]);
    const auto f1 = FirstHarmonic::from_samples(first);
    const auto g1 = SecondHarmonic::from_samples(second);
    const auto h1 = Quadratic::from_samples(quadratic, h.length);
    const double x = random.between(-3, 3), step = 1e-6;
    EXPECT_NEAR(f1.value(x), f.value(x), 1e-14);
    EXPECT_NEAR(g1.value(x), g.value(x), 1e-13);
    EXPECT_NEAR(h1.value(x), h.value(x), 1e-12);
    EXPECT_NEAR(f.derivative(x), (f.value(x + step) - f.value(x - step)) / (2.0 * step), 1e-8);
    EXPECT_NEAR(g.derivative(x), (g.value(x + step) - g.value(x - step)) / (2.0 * step), 1e-8);
    EXPECT_NEAR(h.derivative(x), (h.value(x + step) - h.value(x - step)) / (2.0 * step), 1e-8);
  }
}

// K-II-3.4.4a: p' Rz(theta) r = S.
TEST(ScalarRoots, TheAngleOfAScalarProductIsFound) {
  Random random(2);
  double worst = 0.0, worst_residual = 0.0;
  for (int n = 0; n < 100000; ++n) {
    const Vector3 p = random.vector(), r = random.vector();
    const double theta = random.between(-pi, pi);
    const double a = p.x() * r.x() + p.y() * r.y(), b = p.y() * r.x() - p.x() * r.y();
    const FirstHarmonic f = {-(a * std::cos(theta) + b * std::sin(theta)), a, b};
    const Roots found = roots(f);
    ASSERT_GE(found.count, 1);
    const double size = amplitude(f);
    // theta is as good as the equation tells it: rounding / |f'|, and at a limit position its square root.
    const double slope = std::max(std::abs(f.derivative(theta)) / size, 2e-7);
    worst = std::max(worst, distance_to(found, theta) * slope);
    for (int i = 0; i < found.count; ++i) {
      const double x = found.values[static_cast<std::size_t>(i)];
      EXPECT_TRUE(x > -pi && x <= pi);
      if (!found.repeated[static_cast<std::size_t>(i)]) {
        worst_residual = std::max(worst_residual, std::abs(f.value(x)) / size);
      }
    }
  }
  EXPECT_LT(worst, 1.5e-14);
  EXPECT_LT(worst_residual, 1e-15);
}

TEST(ScalarRoots, TheFirstBranchRisesAndTheSecondFalls) {
  Random random(3);
  for (int n = 0; n < 10000; ++n) {
    const FirstHarmonic f = random_first(random);
    const Roots found = roots(f);
    if (found.count < 2) continue;
    EXPECT_GT(f.derivative(found.values[0]), 0.0);
    EXPECT_LT(f.derivative(found.values[1]), 0.0);
    // The seed's formula with k = 1, 2.
    const double square = f.c1 * f.c1 + f.s1 * f.s1, w = std::sqrt(square - f.c0 * f.c0);
    for (int k = 1; k <= 2; ++k) {
      const double sign = k == 1 ? 1.0 : -1.0;
      const double c = (-f.c1 * f.c0 + sign * f.s1 * w) / square, s = (-f.s1 * f.c0 - sign * f.c1 * w) / square;
      EXPECT_LT(apart(found.values[static_cast<std::size_t>(k - 1)], std::atan2(s, c)), 1e-6);
    }
  }
}

/// Rocker angle x of a four-bar linkage: the coupler of length l3 from the crank pin to the rocker pin.
FirstHarmonic four_bar(double crank, double l1, double l2, double l3, double l4) {
  const double px = l2 * std::cos(crank) - l1, py = l2 * std::sin(crank);
  return {px * px + py * py + l4 * l4 - l3 * l3, -2.0 * l4 * px, -2.0 * l4 * py};
}

TEST(ScalarRoots, ABranchOfAFourBarKeepsItsNumberOverATurnOfTheCrank) {
  // A crank-rocker: the coupler never gets in line with the rocker.
  Roots before = roots(four_bar(0.0, 4.0, 1.0, 3.5, 2.5));
  for (int i = 1; i <= 3600; ++i) {
    const Roots now = roots(four_bar(i * pi / 1800.0, 4.0, 1.0, 3.5, 2.5));
    ASSERT_EQ(now.count, 2);
    for (std::size_t k = 0; k < 2; ++k) EXPECT_LT(apart(now.values[k], before.values[k]), 0.005);
    before = now;
  }
  const Roots first = roots(four_bar(0.0, 4.0, 1.0, 3.5, 2.5));
  for (std::size_t k = 0; k < 2; ++k) EXPECT_LT(apart(before.values[k], first.values[k]), 1e-14);
}

TEST(ScalarRoots, TheTwoBranchesOfATripleRockerMeetInItsLimitPosition) {
  // Coupler and rocker in line: the crank pin is l3 + l4 from the rocker's pivot.
  const double l1 = 2.0, l2 = 3.0, l3 = 2.0, l4 = 1.5;
  const double crank = std::acos((l1 * l1 + l2 * l2 - (l3 + l4) * (l3 + l4)) / (2.0 * l1 * l2));
  const Roots at = roots(four_bar(crank, l1, l2, l3, l4));
  ASSERT_EQ(at.count, 1);
  EXPECT_TRUE(at.repeated[0]);
  EXPECT_LT(apart(at.values[0], std::atan2(l2 * std::sin(crank), l2 * std::cos(crank) - l1)), 1e-14);
  for (const double step : {1e-2, 1e-6, 1e-10, 1e-12}) {
    const Roots inside = roots(four_bar(crank - step, l1, l2, l3, l4));
    ASSERT_EQ(inside.count, 2) << step;
    EXPECT_FALSE(inside.repeated[0]);
    for (std::size_t k = 0; k < 2; ++k) EXPECT_LT(apart(inside.values[k], at.values[0]), 3.0 * std::sqrt(step));
    const Roots outside = roots(four_bar(crank + step, l1, l2, l3, l4));
    EXPECT_EQ(outside.count, 0) << step;
    EXPECT_LT(outside.missed_by, 3.0 * step);
    EXPECT_GT(outside.missed_by, 0.01 * step);
    EXPECT_LT(apart(outside.nearest, at.values[0]), 3.0 * step);
  }
}

TEST(ScalarRoots, AFactorOfTheConditionChangesNothing) {
  Random random(4);
  for (int n = 0; n < 2000; ++n) {
    const FirstHarmonic f = random_first(random);
    const SecondHarmonic g = product(f, random_first(random));
    const Quadratic h = {random.normal(), random.normal(), random.normal()};
    for (const double k : {1e-290, 1e-100, -1.0, 1e100, 1e290}) {
      const Roots one = roots(f), other = roots(FirstHarmonic{k * f.c0, k * f.c1, k * f.s1});
      ASSERT_EQ(one.count, other.count);
      for (double x : listed(one)) EXPECT_LT(distance_to(other, x) * std::abs(f.derivative(x)), 1e-14);
      const Roots two = roots(g), same = roots({k * g.c0, k * g.c1, k * g.s1, k * g.c2, k * g.s2});
      ASSERT_EQ(two.count, same.count);
      for (double x : listed(two)) EXPECT_LT(distance_to(same, x) * std::abs(g.derivative(x)), 1e-13);
      const Roots three = roots(h), third = roots(Quadratic{k * h.c0, k * h.c1, k * h.c2});
      ASSERT_EQ(three.count, third.count);
      for (std::size_t i = 0; i < static_cast<std::size_t>(three.count); ++i) {
        EXPECT_NEAR(three.values[i], third.values[i], 1e-12 * std::abs(three.values[i]));
      }
    }
  }
}

TEST(ScalarRoots, AnUnreachablePositionIsMissedByItsShareOfTheAmplitude) {
  // 5 + 3 cos x + 4 sin x = 0 is a limit position; 6 misses it by 1/5.
  EXPECT_TRUE(roots(FirstHarmonic{5, 3, 4}).repeated[0]);
  const Roots r = roots(FirstHarmonic{6, 3, 4});
  EXPECT_EQ(r.count, 0);
  EXPECT_NEAR(r.missed_by, 0.2, 1e-15);
  EXPECT_NEAR(r.nearest, std::atan2(-4, -3), 1e-15);
  // The least value of 3 + cos x + cos 2x is at cos x = -1/4.
  const Roots second = roots(SecondHarmonic{3, 1, 0, 1, 0});
  EXPECT_EQ(second.count, 0);
  EXPECT_NEAR(second.missed_by, (3 - 0.25 - 0.875) / std::numbers::sqrt2, 1e-15);
  EXPECT_NEAR(std::cos(second.nearest), -0.25, 1e-14);
  const Roots quadratic = roots(Quadratic{13, -6, 1});
  EXPECT_EQ(quadratic.count, 0);
  EXPECT_NEAR(quadratic.missed_by, 4.0, 1e-14);
  EXPECT_NEAR(quadratic.nearest, 3.0, 1e-15);
}

TEST(ScalarRoots, ALimitPositionIsAsWideAsTheScaleMakesIt) {
  for (const double sign : {-1.0, 1.0}) {
    const double off = sign * 1e-11, scale = 1e5;
    EXPECT_NE(roots(FirstHarmonic{5 + off, 3, 4}).count, 1);
    EXPECT_TRUE(roots(FirstHarmonic{5 + off, 3, 4}, scale).repeated[0]);
    EXPECT_NE(roots(SecondHarmonic{1 + off, 0, 0, 1, 0}).count, 2);
    EXPECT_TRUE(roots(SecondHarmonic{1 + off, 0, 0, 1, 0}, scale).repeated[0]);
    EXPECT_NE(roots(Quadratic{1 + off, 2, 1}).count, 1);
    EXPECT_TRUE(roots(Quadratic{1 + off, 2, 1}, scale).repeated[0]);
  }
}

TEST(ScalarRoots, WhatIsNothingButRoundingDeterminesNothing) {
  EXPECT_TRUE(roots(FirstHarmonic{}).everywhere);
  EXPECT_TRUE(roots(SecondHarmonic{}).everywhere);
  EXPECT_TRUE(roots(Quadratic{}).everywhere);
  EXPECT_TRUE(roots(FirstHarmonic{1e-16, -2e-16, 1e-16}, 1.0).everywhere);
  EXPECT_TRUE(roots(SecondHarmonic{1e-16, -2e-16, 1e-16, 1e-16, 0}, 1.0).everywhere);
  EXPECT_TRUE(roots(Quadratic{1e-16, -2e-16, 1e-16}, 1.0).everywhere);
  // The axis through the point: a distance that cannot change.
  for (const Roots& r : {roots(FirstHarmonic{0.1, 1e-16, 0}, 1.0), roots(SecondHarmonic{0.1, 0, 0, 1e-16, 0}, 1.0),
                         roots(Quadratic{0.1, 1e-16, 1e-17}, 1.0), roots(Quadratic{2, 0, 0})}) {
    EXPECT_EQ(r.count, 0);
    EXPECT_FALSE(r.everywhere);
    EXPECT_TRUE(std::isinf(r.missed_by));
  }
  const double nan = std::nan("");
  EXPECT_EQ(roots(FirstHarmonic{nan, 1, 0}).count, 0);
  EXPECT_EQ(roots(SecondHarmonic{0, 1, 0, nan, 0}).count, 0);
  EXPECT_TRUE(std::isnan(roots(Quadratic{0, nan, 0}).missed_by));
}

// --- second order against a dense scan ---

template <typename F>
double bisected(const F& f, double low, double high) {
  const bool rising = f(low) < 0.0;
  for (int i = 0; i < 52; ++i) {
    const double middle = 0.5 * (low + high);
    ((f(middle) < 0.0) == rising ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

struct Point {
  double x, slope, curvature;
};

/// f' and f'' all around, with the zeros of f'' as points of their own: f' is monotone between neighbours.
std::vector<Point> around(const SecondHarmonic& f) {
  constexpr int cells = 400;
  static const auto table = [] {
    std::array<std::array<double, 5>, cells + 1> t{};
    for (std::size_t i = 0; i <= cells; ++i) {
      const double x = -pi + 2.0 * pi * static_cast<double>(i) / cells;
      t[i] = {x, std::cos(x), std::sin(x), std::cos(2 * x), std::sin(2 * x)};
    }
    return t;
  }();
  const SecondHarmonic slope = {0, f.s1, -f.c1, 2.0 * f.s2, -2.0 * f.c2};
  std::vector<Point> points;
  for (const auto& [x, c, s, cc, ss] : table) {
    const double curvature = -(f.c1 * c + f.s1 * s + 4.0 * (f.c2 * cc + f.s2 * ss));
    if (!points.empty() && (curvature < 0.0) != (points.back().curvature < 0.0)) {
      const double inflection = bisected([&](double at) { return slope.derivative(at); }, points.back().x, x);
      points.push_back({inflection, slope.value(inflection), curvature});
    }
    points.push_back({x, f.s1 * c - f.c1 * s + 2.0 * (f.s2 * cc - f.c2 * ss), curvature});
  }
  return points;
}

/// Extrema of f by a scan of f', and roots between those that are clearly not zero.
std::vector<double> scan(const SecondHarmonic& f) {
  std::vector<double> extrema;
  const auto points = around(f);
  for (std::size_t i = 1; i < points.size(); ++i) {
    if ((points[i].slope < 0.0) == (points[i - 1].slope < 0.0)) continue;
    extrema.push_back(bisected([&](double at) { return f.derivative(at); }, points[i - 1].x, points[i].x));
  }
  std::vector<double> roots;
  const double doubtful = 2e-14 * amplitude(f);
  for (std::size_t i = 0; i < extrema.size(); ++i) {
    const double low = extrema[i], high = i + 1 < extrema.size() ? extrema[i + 1] : extrema[0] + 2.0 * pi;
    const double at_low = f.value(low), at_high = f.value(high);
    if (std::abs(at_low) <= doubtful || std::abs(at_high) <= doubtful || (at_low < 0.0) == (at_high < 0.0)) continue;
    roots.push_back(bisected([&](double at) { return f.value(at); }, low, high));
  }
  return roots;
}

/// Whether f has different signs on both sides of each simple root, half way to its neighbours: then it does exist.
bool signs_alternate(const SecondHarmonic& f, const Roots& found) {
  const auto n = static_cast<std::size_t>(found.count);
  const auto half_way = [&](std::size_t i) {
    const double turn = i + 1 < n ? 0.0 : 2.0 * pi;
    return 0.5 * (found.values[i] + found.values[(i + 1) % n] + turn);
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (found.repeated[i]) continue;
    if ((f.value(half_way((i + n - 1) % n)) < 0.0) == (f.value(half_way(i)) < 0.0)) return false;
  }
  return true;
}

/// How far the roots found are wrong at most, times the slope over the amplitude; fails if there is one too many or too
/// few.
double compared(const SecondHarmonic& f) {
  const Roots found = roots(f);
  const std::vector<double> reference = scan(f);
  const double size = amplitude(f);
  double worst = 0.0;
  for (double x : reference) worst = std::max(worst, distance_to(found, x) * std::abs(f.derivative(x)) / size);
  for (double x : listed(found)) {
    EXPECT_LE(std::abs(f.value(x)), 2e-14 * size);
    EXPECT_TRUE(x > -pi && x <= pi);
  }
  EXPECT_TRUE(signs_alternate(f, found));
  EXPECT_GE(static_cast<std::size_t>(found.count), reference.size());
  const auto list = listed(found);
  EXPECT_TRUE(std::is_sorted(list.begin(), list.end()));
  return worst;
}

TEST(ScalarRoots, SecondOrderHasTheRootsThatAScanFinds) {
  Random random(5);
  double worst = 0.0;
  for (int n = 0; n < 40000; ++n) {
    const SecondHarmonic f = {random.normal(), random.normal(), random.normal(), random.normal(), random.normal()};
    worst = std::max(worst, compared(f));
    ASSERT_LT(worst, 1e-14) << n;
  }
}

TEST(ScalarRoots, SecondOrderNearADoubleRootHasTheRootsThatAScanFinds) {
  Random random(6);
  for (int n = 0; n < 30000; ++n) {
    // A pair of roots from 1e-9 rad to 0.1 rad apart, or a bit of both signs missed.
    const double half = std::pow(10.0, random.between(-9, -1));
    SecondHarmonic f = product(with_roots(random.between(-pi, pi), half), random_first(random));
    if (n % 2 == 1) f.c0 += random.normal() * std::pow(10.0, random.between(-17, -1));
    ASSERT_LT(compared(f), 2e-14) << n;
  }
}

TEST(ScalarRoots, SecondOrderWithRootsInAHeapHasTheRootsThatAScanFinds) {
  Random random(7);
  for (int n = 0; n < 20000; ++n) {
    const double spread = std::pow(10.0, random.between(-4, 0)), middle = random.between(-pi, pi);
    const auto near = [&] { return with_roots(middle + spread * random.normal(), spread * random.normal()); };
    const FirstHarmonic f = near();
    // The scan's cells are too wide for heaps below a few hundredths: there, the roots are known.
    if (spread > 0.1) {
      ASSERT_LT(compared(product(f, near())), 2e-14) << n;
      continue;
    }
    const SecondHarmonic g = product(f, near());
    const Roots known = roots(f), found = roots(g);
    for (double x : listed(known)) {
      double nearest = 10.0;
      for (double y : listed(found)) nearest = std::min(nearest, apart(x, y));
      // Between a root and the one that stands for it, |f| is at most rounding, 5e-15; by Markov's inequality the slope
      // times the distance is then at most 2 * 4^2 times that.
      EXPECT_LE(nearest * std::abs(g.derivative(x)) / amplitude(g), 1.6e-13) << n;
      EXPECT_GE(found.count, 1);
    }
  }
}

TEST(ScalarRoots, SecondOrderPassesIntoFirstOrder) {
  Random random(8);
  for (int n = 0; n < 10000; ++n) {
    const FirstHarmonic f = random_first(random);
    const double tiny = n % 3 == 0 ? 0.0 : std::pow(10.0, random.between(-18, -2));
    const SecondHarmonic g = {f.c0, f.c1, f.s1, tiny * random.normal(), tiny * random.normal()};
    ASSERT_LT(compared(g), 2e-14) << n;
    if (tiny > 1e-15) continue;
    const Roots first = roots(f), second = roots(g);
    ASSERT_EQ(first.count, second.count);
    for (double x : listed(first)) {
      EXPECT_LT(distance_to(second, x) * std::max(1e-7, std::abs(f.derivative(x))), 1e-14);
    }
  }
}

TEST(ScalarRoots, MultipleRootsAreListedOnceAndFlagged) {
  // (1 - cos x)^2: four at zero. sin^2 x: two doubles. (1 - cos x)(cos x): one double and two simple ones.
  const Roots four = roots(SecondHarmonic{1.5, -2, 0, 0.5, 0});
  ASSERT_EQ(four.count, 1);
  EXPECT_TRUE(four.repeated[0]);
  EXPECT_LT(std::abs(four.values[0]), 1e-4);
  const Roots sine = roots(SecondHarmonic{0.5, 0, 0, -0.5, 0});
  ASSERT_EQ(sine.count, 2);
  EXPECT_TRUE(sine.repeated[0] && sine.repeated[1]);
  EXPECT_LT(std::abs(sine.values[0]), 1e-15);
  EXPECT_EQ(sine.values[1], pi);
  const Roots mixed = roots(SecondHarmonic{-0.5, 1, 0, -0.5, 0});
  ASSERT_EQ(mixed.count, 3);
  EXPECT_TRUE(!mixed.repeated[0] && mixed.repeated[1] && !mixed.repeated[2]);
  EXPECT_NEAR(mixed.values[0], -pi / 2, 1e-15);
  EXPECT_NEAR(mixed.values[1], 0.0, 1e-15);
  EXPECT_NEAR(mixed.values[2], pi / 2, 1e-15);
}

// K-II-3.4.1, type 3: a point that turns about one axis is at a given distance from another.
TEST(ScalarRoots, APointReachesItsDistanceFromAnAxis) {
  Random random(9);
  int most = 0;
  for (int n = 0; n < 20000; ++n) {
    const Vector3 axis = random.direction(), from = random.direction(), start = 2.0 * random.vector();
    const Vector3 through = random.vector();
    const double theta = random.between(-pi, pi);
    const auto distance = [&](double x) {
      const Vector3 r = rotation_about<double>(axis, x) * start - through;
      return r.cross(from).squaredNorm();
    };
    const double wanted = distance(theta);
    std::array<double, 5> values{};
    for (std::size_t i = 0; i < 5; ++i) values[i] = distance(SecondHarmonic::samples[i]) - wanted;
    const SecondHarmonic f = SecondHarmonic::from_samples(values);
    const Roots found = roots(f, 10.0);
    ASSERT_GE(found.count, 1);
    most = std::max(most, found.count);
    const double slope = std::abs(f.derivative(theta));
    EXPECT_LT(distance_to(found, theta) * std::max(slope, 1e-6 * amplitude(f)), 3e-13) << n;
  }
  EXPECT_EQ(most, 4);
}

// --- displacements ---

TEST(ScalarRoots, ADisplacementHasTheDigitsOfBothRoots) {
  Random random(10);
  for (int n = 0; n < 100000; ++n) {
    const double near = random.normal() * std::pow(10.0, random.between(-12, 2)), far = random.normal() * 100.0;
    const Quadratic f = {near * far, -(near + far), 1.0};
    const Roots found = roots(f);
    const double gap = std::abs(far - near) / std::max(std::abs(far), std::abs(near));
    if (gap < 1e-6) continue;
    ASSERT_EQ(found.count, 2);
    const double low = std::min(near, far), high = std::max(near, far);
    EXPECT_NEAR(found.values[0], low, 4.0 * eps / gap * std::abs(low));
    EXPECT_NEAR(found.values[1], high, 4.0 * eps / gap * std::abs(high));
  }
}

TEST(ScalarRoots, ADisplacementAtItsLimitIsADoubleRoot) {
  const Roots limit = roots(Quadratic{4, -4, 1});
  ASSERT_EQ(limit.count, 1);
  EXPECT_TRUE(limit.repeated[0]);
  EXPECT_EQ(limit.values[0], 2.0);
  const Roots linear = roots(Quadratic{3, -2, 1e-17}, 1.0);
  ASSERT_EQ(linear.count, 1);
  EXPECT_EQ(linear.values[0], 1.5);
  EXPECT_EQ(roots(Quadratic{-1, 0, 4}).count, 2);
}

// --- several conditions ---

TEST(ScalarRoots, AVectorInTwoFramesGivesOneAngle) {
  Random random(11);
  for (int n = 0; n < 20000; ++n) {
    // K-II-3.4.4b: r = Rz(theta) r', with a row of zeros and a repeated one.
    const Vector3 turned = random.vector();
    const double theta = random.between(-pi, pi);
    const Vector3 r = rotation_about<double>(Vector3(0, 0, 1), theta) * turned;
    const std::array<FirstHarmonic, 4> rows = {FirstHarmonic{-r.x(), turned.x(), -turned.y()}, FirstHarmonic{},
                                               FirstHarmonic{-r.y(), turned.y(), turned.x()},
                                               FirstHarmonic{r.x() * 2.0, -2.0 * turned.x(), 2.0 * turned.y()}};
    const RowRoots found = angle_of_rows(rows);
    ASSERT_TRUE(found.unique);
    ASSERT_EQ(found.roots.count, 1);
    EXPECT_LT(apart(found.roots.values[0], theta) * std::hypot(turned.x(), turned.y()), 3e-15);
    EXPECT_LT(found.inconsistency, 3e-15);
  }
}

TEST(ScalarRoots, RowsThatRepeatEachOtherLeaveBothAngles) {
  const FirstHarmonic f = {0.3, 0.8, -0.5};
  const std::array<FirstHarmonic, 3> rows = {f, FirstHarmonic{-0.6, -1.6, 1.0}, FirstHarmonic{}};
  const RowRoots found = angle_of_rows(rows);
  const Roots expected = roots(f);
  EXPECT_FALSE(found.unique);
  ASSERT_EQ(found.roots.count, 2);
  for (double x : listed(expected)) EXPECT_LT(distance_to(found.roots, x), 1e-15);
  EXPECT_LT(found.inconsistency, 1e-15);
}

TEST(ScalarRoots, ARowThatHardlyDiffersStillTellsWhichAngle) {
  Random random(12);
  for (int n = 0; n < 20000; ++n) {
    const double theta = random.between(-pi, pi);
    FirstHarmonic f = random_first(random), g = f;
    const double change = std::pow(10.0, random.between(-6, 0));
    g.c1 += change * random.normal();
    g.s1 += change * random.normal();
    f.c0 = -(f.c1 * std::cos(theta) + f.s1 * std::sin(theta));
    g.c0 = -(g.c1 * std::cos(theta) + g.s1 * std::sin(theta));
    const RowRoots found = angle_of_rows(std::array{f, g}, 0.0, 1e-13);
    const Roots alone = roots(f);
    if (alone.count < 2 || apart(alone.values[0], alone.values[1]) < 1e-3) continue;
    ASSERT_GE(found.roots.count, 1);
    EXPECT_LT(distance_to(found.roots, theta) * std::abs(f.derivative(theta)), 1e-13);
    // The other root of f stays only if g does not see it.
    for (double x : listed(found.roots)) EXPECT_LE(std::abs(g.value(x)), 1e-12);
  }
}

TEST(ScalarRoots, RowsThatDisagreeSayByHowMuch) {
  // cos x = 1/2 and sin x = 1/2 + 0.01: off the circle. Parallel rows with different constants: no angle at all.
  const double s = std::sqrt(0.75);
  const RowRoots off = angle_of_rows(std::array{FirstHarmonic{-0.5, 1, 0}, FirstHarmonic{-s - 0.01, 0, 1}}, 1.0);
  ASSERT_EQ(off.roots.count, 1);
  EXPECT_GT(off.inconsistency, 1e-3);
  EXPECT_LT(off.inconsistency, 1e-2);
  const RowRoots none = angle_of_rows(std::array{FirstHarmonic{-0.5, 1, 0}, FirstHarmonic{-0.6, 1, 0}}, 1.0);
  EXPECT_EQ(none.roots.count, 0);
  EXPECT_NEAR(none.inconsistency, 0.05, 1e-9);
  const RowRoots free = angle_of_rows(std::array{FirstHarmonic{}, FirstHarmonic{1e-17, 0, 1e-17}}, 1.0);
  EXPECT_TRUE(free.roots.everywhere);
  const RowRoots never = angle_of_rows(std::array{FirstHarmonic{}, FirstHarmonic{0.2, 0, 1e-17}}, 1.0);
  EXPECT_FALSE(never.roots.everywhere);
  EXPECT_NEAR(never.roots.missed_by, 0.2, 1e-15);
  EXPECT_TRUE(angle_of_rows({}).roots.everywhere);
}

TEST(ScalarRoots, LinearRowsOfADisplacementAreSolvedByLeastSquares) {
  // K-II-3.4.4c: s p = r.
  Random random(13);
  for (int n = 0; n < 1000; ++n) {
    const Vector3 p = random.vector(), across = 1e-3 * random.vector();
    const double s = random.normal();
    const Vector3 r = s * p + (across - across.dot(p) / p.squaredNorm() * p);
    std::array<Quadratic, 3> rows;
    for (int i = 0; i < 3; ++i) rows[static_cast<std::size_t>(i)] = {-r[i], p[i], 0.0};
    const RowRoots found = displacement_of_rows(rows, 1.0);
    ASSERT_TRUE(found.unique);
    EXPECT_NEAR(found.roots.values[0], s, 1e-14 / p.norm());
    EXPECT_NEAR(found.inconsistency, (r - s * p).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(ScalarRoots, QuadraticRowsOfADisplacementAreFilteredByTheOthers) {
  // (s - 1)(s - 2), twice: both. With (s - 1)(s + 3): only 1, and uniquely so.
  const Quadratic f = {2, -3, 1}, g = {-3, 2, 1};
  const RowRoots both = displacement_of_rows(std::array{f, Quadratic{-4, 6, -2}, Quadratic{}});
  EXPECT_FALSE(both.unique);
  ASSERT_EQ(both.roots.count, 2);
  EXPECT_NEAR(both.roots.values[0], 1.0, 1e-15);
  EXPECT_NEAR(both.roots.values[1], 2.0, 1e-15);
  const RowRoots one = displacement_of_rows(std::array{f, g});
  EXPECT_TRUE(one.unique);
  ASSERT_EQ(one.roots.count, 1);
  EXPECT_NEAR(one.roots.values[0], 1.0, 1e-14);
}

}  // namespace
}  // namespace koppel::test
