// All common roots of two closure conditions, against where they were built from and against Newton's method from
// everywhere.
#include "closure/common_roots.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "../spatial/directions.hpp"

namespace koppel::test {
namespace {

using Kind = Unknown::Kind;
using Matrix5 = Eigen::Matrix<double, 5, 5>;
using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double pi = std::numbers::pi;
const Unknown angle{Kind::angle, 1, 1.0}, angle2{Kind::angle, 2, 1.0};
const Unknown displacement{Kind::displacement, 1, 1.0}, displacement2{Kind::displacement, 2, 1.0};

struct System {
  Unknown x, y;
  Condition2 f, g;

  Vector2d value(const Vector2d& p) const { return {f.value(x, y, p[0], p[1]), g.value(x, y, p[0], p[1])}; }
  Matrix2d jacobian(const Vector2d& p) const {
    constexpr double h = 1e-5;
    Matrix2d j;
    for (int k = 0; k < 2; ++k) {
      const Vector2d step = h * Vector2d::Unit(k);
      j.col(k) = (value(p + step) - value(p - step)) / (2.0 * h);
    }
    return j;
  }
  CommonRoots roots() const { return common_roots(x, y, f, g); }
};

double apart(const System& s, const Vector2d& a, const Vector2d& b) {
  const auto part = [](const Unknown& u, double d) {
    return u.kind == Kind::angle ? std::remainder(d, 2.0 * pi) : d / u.length;
  };
  return std::hypot(part(s.x, a[0] - b[0]), part(s.y, a[1] - b[1]));
}

double distance_to(const System& s, const CommonRoots& found, const Vector2d& p) {
  double least = 1e3;
  for (const CommonRoot& r : found.roots) least = std::min(least, apart(s, {r.x, r.y}, p));
  return least;
}

Condition2 random_condition(const Unknown& x, const Unknown& y, Random& random) {
  Condition2 c;
  for (int i = 0; i < x.terms(); ++i) {
    for (int j = 0; j < y.terms(); ++j) c.c(i, j) = random.normal();
  }
  return c;
}

Vector2d random_point(const System& s, Random& random) {
  const auto one = [&](const Unknown& u) { return u.kind == Kind::angle ? random.between(-pi, pi) : random.normal(); };
  return {one(s.x), one(s.y)};
}

/// Random conditions that both vanish at p.
System through(const Unknown& x, const Unknown& y, const Vector2d& p, Random& random) {
  System s{x, y, random_condition(x, y, random), random_condition(x, y, random)};
  // Twice: the first value has the rounding of a larger constant.
  for (int i = 0; i < 2; ++i) {
    const Vector2d value = s.value(p);
    s.f.c(0, 0) -= value[0];
    s.g.c(0, 0) -= value[1];
  }
  return s;
}

/// How far the nearest root found is from a known one, as a multiple of what the inverse Jacobian makes of rounding;
/// where two roots nearly meet, of its square root.
double error_in_roundings(const System& s, const CommonRoots& found, const Vector2d& p) {
  const Eigen::JacobiSVD<Matrix2d> svd(s.jacobian(p));
  return distance_to(s, found, p) * std::max(svd.singularValues()[1], 1e-6) / 2.3e-16;
}

void expect_the_known_root(const Unknown& x, const Unknown& y, int systems, int most, unsigned seed) {
  Random random(seed);
  int fewer = 0;
  for (int n = 0; n < systems; ++n) {
    System s{x, y, {}, {}};
    const Vector2d p = random_point(s, random);
    s = through(x, y, p, random);
    const CommonRoots found = s.roots();
    ASSERT_FALSE(found.degenerate) << n;
    ASSERT_LT(error_in_roundings(s, found, p), 300.0) << n;
    ASSERT_LE(static_cast<int>(found.roots.size()), most);
    ASSERT_LE(found.complex_count, most) << n;
    ASSERT_GE(found.complex_count, static_cast<int>(found.roots.size())) << n;
    if (found.complex_count < most) ++fewer;
    for (const CommonRoot& r : found.roots) {
      const double distance = apart(s, {r.x, r.y}, p);
      if (r.repeated || distance > distance_to(s, found, p)) continue;
      EXPECT_LE(distance, 16.0 * r.error) << n;
    }
  }
  // A displacement of more than a thousand lengths counts as infinite; an angle hardly ever gets there.
  const bool bounded = x.kind == Kind::angle && y.kind == Kind::angle;
  EXPECT_LE(fewer, bounded ? 2 : systems / 50);
}

TEST(CommonRoots, OfTwoAnglesAreTheKnownOneAndAtMostSevenMore) { expect_the_known_root(angle, angle, 35000, 8, 1); }
TEST(CommonRoots, OfAnAngleAndADisplacementAreTheKnownOneAndAtMostThreeMore) {
  expect_the_known_root(angle, displacement, 30000, 4, 2);
}
TEST(CommonRoots, OfAnAngleAndASquareAreTheKnownOneAndAtMostSevenMore) {
  expect_the_known_root(displacement2, angle, 20000, 8, 3);
}
TEST(CommonRoots, OfTwoDisplacementsAreTheKnownOneAndAtMostSevenMore) {
  expect_the_known_root(displacement2, displacement2, 15000, 8, 4);
}
TEST(CommonRoots, OfADoubledAngleAndAnAngleAreTheKnownOneAndAtMost15More) {
  expect_the_known_root(angle2, angle, 3000, 16, 5);
}
TEST(CommonRoots, OfTwoDoubledAnglesAreTheKnownOneAndAtMost31More) {
  expect_the_known_root(angle2, angle2, 800, 32, 6);
}

// --- against Newton's method from everywhere ---

std::vector<Vector2d> by_many_starts(const System& s, int starts, Random& random) {
  std::vector<Vector2d> found;
  for (int n = 0; n < starts; ++n) {
    Vector2d p = random_point(s, random);
    if (n % 2 == 1) p *= 3.0;
    bool converged = false;
    for (int i = 0; i < 40 && !converged; ++i) {
      Vector2d step = -s.jacobian(p).inverse() * s.value(p);
      if (!step.allFinite()) break;
      if (step.norm() > 0.5) step *= 0.5 / step.norm();
      p += step;
      converged = step.norm() < 1e-13 * (1.0 + p.norm());
    }
    const auto is_p = [&](const Vector2d& q) { return apart(s, p, q) < 1e-7 * (1.0 + p.norm()); };
    if (converged && std::none_of(found.begin(), found.end(), is_p)) found.push_back(p);
  }
  return found;
}

void expect_the_roots_of_many_starts(const Unknown& x, const Unknown& y, int systems, int starts, unsigned seed) {
  Random random(seed);
  for (int n = 0; n < systems; ++n) {
    const System s{x, y, random_condition(x, y, random), random_condition(x, y, random)};
    const CommonRoots found = s.roots();
    const auto expected = by_many_starts(s, starts, random);
    for (const Vector2d& p : expected) EXPECT_LT(error_in_roundings(s, found, p), 1e3) << n << ": " << p.transpose();
    // Random starts may leave one out that is far off or has a small basin: each found is checked by itself.
    EXPECT_GE(found.roots.size(), expected.size()) << n;
    for (const CommonRoot& r : found.roots) {
      const bool far = std::hypot(x.kind == Kind::angle ? 0 : r.x, y.kind == Kind::angle ? 0 : r.y) > 5.0;
      const bool seen = std::any_of(expected.begin(), expected.end(), [&](const Vector2d& p) {
        return apart(s, p, {r.x, r.y}) < 1e-6;
      });
      EXPECT_TRUE(far || seen) << n << ": " << r.x << ' ' << r.y;
    }
  }
}

TEST(CommonRoots, AreThoseThatManyStartsFind) {
  expect_the_roots_of_many_starts(angle, angle, 150, 300, 11);
  expect_the_roots_of_many_starts(angle, displacement, 150, 300, 12);
  expect_the_roots_of_many_starts(displacement2, angle, 100, 300, 13);
  expect_the_roots_of_many_starts(displacement2, displacement2, 100, 300, 14);
  expect_the_roots_of_many_starts(angle, angle2, 30, 500, 15);
  expect_the_roots_of_many_starts(angle2, angle2, 15, 1500, 16);
}

// --- examples with known answers ---

/// Distance from (x, y) = (a, b) is r.
Condition2 circle(double a, double b, double r) {
  Condition2 c;
  c.c(0, 0) = a * a + b * b - r * r;
  c.c(1, 0) = -2.0 * a, c.c(0, 1) = -2.0 * b;
  c.c(2, 0) = c.c(0, 2) = 1.0;
  return c;
}

TEST(CommonRoots, TwoCirclesMeetInTwoPointsTouchInOneOrMiss) {
  System s{displacement2, displacement2, circle(0, 0, 5), circle(3, 0, 4)};
  const CommonRoots two = s.roots();
  ASSERT_EQ(two.roots.size(), 2u);
  EXPECT_NEAR(two.roots[0].x, 3.0, 1e-14);
  EXPECT_NEAR(two.roots[0].y, -4.0, 1e-14);
  EXPECT_NEAR(two.roots[1].x, 3.0, 1e-14);
  EXPECT_NEAR(two.roots[1].y, 4.0, 1e-14);
  EXPECT_FALSE(two.roots[0].repeated);
  s.g = circle(6, 8, 5);
  const CommonRoots one = s.roots();
  ASSERT_EQ(one.roots.size(), 1u);
  EXPECT_TRUE(one.roots[0].repeated);
  EXPECT_NEAR(one.roots[0].x, 3.0, 1e-13);
  EXPECT_NEAR(one.roots[0].y, 4.0, 1e-13);
  s.g = circle(6, 8, 4.99);
  EXPECT_TRUE(s.roots().roots.empty());
  EXPECT_FALSE(s.roots().degenerate);
  s.g = circle(0, 0, 5);
  EXPECT_TRUE(s.roots().degenerate);
  s.g = circle(0, 0, 4);
  EXPECT_TRUE(s.roots().roots.empty());
}

/// Tip of two links on revolute joints at (px, py); x and y are the joint angles.
System two_links(double l1, double l2, double px, double py) {
  System s{angle, angle, {}, {}};
  s.f.c(0, 0) = -px, s.f.c(1, 0) = l1, s.f.c(1, 1) = l2, s.f.c(2, 2) = -l2;
  s.g.c(0, 0) = -py, s.g.c(2, 0) = l1, s.g.c(2, 1) = l2, s.g.c(1, 2) = l2;
  return s;
}

TEST(CommonRoots, TwoLinksReachAPointWithTheElbowUpAndDown) {
  Random random(21);
  for (int n = 0; n < 3000; ++n) {
    const double l1 = random.between(0.5, 2), l2 = random.between(0.5, 2), reach = random.between(0.01, 4);
    const double at = random.between(-pi, pi);
    const System s = two_links(l1, l2, reach * std::cos(at), reach * std::sin(at));
    const CommonRoots found = s.roots();
    const double cosine = (reach * reach - l1 * l1 - l2 * l2) / (2.0 * l1 * l2);
    ASSERT_EQ(found.roots.size(), std::abs(cosine) < 1.0 ? 2u : 0u) << n;
    if (found.roots.empty()) continue;
    for (const double elbow : {std::acos(cosine), -std::acos(cosine)}) {
      const double shoulder = at - std::atan2(l2 * std::sin(elbow), l1 + l2 * std::cos(elbow));
      EXPECT_LT(error_in_roundings(s, found, {shoulder, elbow}), 100.0) << n;
    }
  }
}

TEST(CommonRoots, TwoLinksInLineAreAtTheirLimit) {
  for (const bool folded : {false, true}) {
    const double reach = folded ? 0.3 : 1.7;
    const CommonRoots found = two_links(1.0, 0.7, 0.6 * reach, 0.8 * reach).roots();
    ASSERT_EQ(found.roots.size(), 1u);
    EXPECT_TRUE(found.roots[0].repeated);
    EXPECT_NEAR(found.roots[0].x, std::atan2(0.8, 0.6), 1e-13);
    EXPECT_NEAR(std::abs(found.roots[0].y), folded ? pi : 0.0, 1e-13);
  }
  // The whole circle of the shoulder, if the links are equal and the tip is on it.
  EXPECT_TRUE(two_links(1.0, 1.0, 0.0, 0.0).roots().degenerate);
}

TEST(CommonRoots, AConditionOnOneUnknownSplitsThePair) {
  // RCCC: the angle from type 4, the displacement from type 5, linear.
  System s{angle, displacement, {}, {}};
  s.f.c(0, 0) = -0.5, s.f.c(1, 0) = 1.0;
  s.g.c(0, 0) = 0.2, s.g.c(1, 0) = 0.3, s.g.c(2, 1) = 2.0, s.g.c(0, 1) = 0.1;
  for (const bool exchanged : {false, true}) {
    if (exchanged) std::swap(s.f, s.g);
    const CommonRoots found = s.roots();
    ASSERT_EQ(found.roots.size(), 2u);
    EXPECT_EQ(found.complex_count, 2);
    for (const CommonRoot& r : found.roots) {
      EXPECT_NEAR(std::abs(r.x), pi / 3, 1e-15);
      EXPECT_NEAR(r.y, -0.35 / (0.1 + 2.0 * std::sin(r.x)), 1e-15);
    }
  }
  // The other unknown, and each on its own.
  System turned{displacement, angle, {}, {}};
  turned.f.c = s.f.c.transpose();
  turned.g.c = s.g.c.transpose();
  EXPECT_EQ(turned.roots().roots.size(), 2u);
  System separate{angle, angle, {}, {}};
  separate.f.c(0, 0) = -0.5, separate.f.c(1, 0) = 1.0;
  separate.g.c(0, 0) = 0.5, separate.g.c(0, 2) = 1.0;
  ASSERT_EQ(separate.roots().roots.size(), 4u);
  for (const CommonRoot& r : separate.roots().roots) EXPECT_NEAR(std::sin(r.y), -0.5, 1e-15);
  // Both on the same: nothing, or a line.
  System same{angle, angle, separate.f, separate.f};
  EXPECT_TRUE(same.roots().degenerate);
  same.g.c(2, 0) = 1.0;
  EXPECT_FALSE(same.roots().degenerate);
  EXPECT_TRUE(same.roots().roots.empty());
}

/// f g of first order, as a condition of second order, from samples.
Condition2 product(const System& first, const Condition2& f, const Condition2& g, const Unknown& x, const Unknown& y) {
  Matrix5 values = Matrix5::Zero();
  for (int i = 0; i < x.terms(); ++i) {
    for (int j = 0; j < y.terms(); ++j) {
      values(i, j) =
          f.value(first.x, first.y, x.sample(i), y.sample(j)) * g.value(first.x, first.y, x.sample(i), y.sample(j));
    }
  }
  return Condition2::from_samples(x, y, values);
}

TEST(CommonRoots, ACurveOfThemIsReported) {
  Random random(22);
  for (int n = 0; n < 200; ++n) {
    const System s{angle, angle, random_condition(angle, angle, random), random_condition(angle, angle, random)};
    Condition2 common = random_condition(angle, angle, random);
    System one{angle, angle, s.f, s.f};
    one.g.c *= -3.7;
    EXPECT_TRUE(one.roots().degenerate);
    const System factor{angle2, angle2, product(s, s.f, common, angle2, angle2),
                        product(s, s.g, common, angle2, angle2)};
    EXPECT_TRUE(factor.roots().degenerate) << n;
    EXPECT_TRUE(common_roots(angle, angle, Condition2{}, s.f).degenerate);
    // Of one unknown only, the factor leaves a line, if it has a real root.
    for (const bool of_x : {true, false}) {
      Condition2 line;
      line.c(0, 0) = -random.between(-0.9, 0.9);
      (of_x ? line.c(1, 0) : line.c(0, 1)) = 1.0;
      const System lined{angle2, angle2, product(s, s.f, line, angle2, angle2), product(s, s.g, line, angle2, angle2)};
      EXPECT_TRUE(lined.roots().degenerate) << n << of_x;
    }
  }
}

TEST(CommonRoots, SamplesGiveTheConditionBack) {
  Random random(23);
  const Unknown far{Kind::displacement, 2, 5.0}, near{Kind::displacement, 1, 0.02};
  for (const Unknown& x : {angle, angle2, far, near}) {
    for (const Unknown& y : {angle, angle2, far, near}) {
      const Condition2 c = random_condition(x, y, random);
      Matrix5 values = Matrix5::Zero();
      for (int i = 0; i < x.terms(); ++i) {
        for (int j = 0; j < y.terms(); ++j) values(i, j) = c.value(x, y, x.sample(i), y.sample(j));
      }
      const Condition2 again = Condition2::from_samples(x, y, values);
      const double size = values.cwiseAbs().maxCoeff();
      for (int i = 0; i < x.terms(); ++i) {
        for (int j = 0; j < y.terms(); ++j) {
          EXPECT_NEAR(again.value(x, y, x.sample(i), y.sample(j)), values(i, j), 1e-14 * size);
        }
      }
    }
  }
}

TEST(CommonRoots, DoNotDependOnUnits) {
  Random random(24);
  for (int n = 0; n < 300; ++n) {
    const System metres{displacement2, angle, random_condition(displacement2, angle, random),
                        random_condition(displacement2, angle, random)};
    System millimetres = metres;
    millimetres.x.length = 1000.0;
    for (int i = 1; i < 3; ++i) {
      millimetres.f.c.row(i) *= std::pow(1e-3, i);
      millimetres.g.c.row(i) *= std::pow(1e-3, i);
    }
    millimetres.f.c *= 1e9;
    const CommonRoots a = metres.roots(), b = millimetres.roots();
    ASSERT_EQ(a.roots.size(), b.roots.size());
    for (const CommonRoot& r : a.roots) EXPECT_LT(distance_to(millimetres, b, {1000.0 * r.x, r.y}), 1e4 * r.error);
  }
}

/// Squared distance of a point on each of two cranks, less that at p; the axes of the cranks are parallel or skew.
Condition2 coupler(const Vector3& axis_x, const Vector3& axis_y, const Vector2d& p, Random& random) {
  const Vector3 apart_by(2.0, 0.0, 0.0), a = random.vector(), b = random.vector();
  const auto square = [&](double x, double y) {
    const Vector3 of_x = rotation_about<double>(axis_x, x) * a, of_y = rotation_about<double>(axis_y, y) * b;
    return (of_x - apart_by - of_y).squaredNorm();
  };
  Matrix5 values = Matrix5::Zero();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) values(i, j) = square(angle.sample(i), angle.sample(j)) - square(p[0], p[1]);
  }
  return Condition2::from_samples(angle, angle, values);
}

TEST(CommonRoots, TwoCouplersBetweenTwoCranksFitWhereTheyWereMeasured) {
  Random random(26);
  for (int n = 0; n < 20000; ++n) {
    const bool parallel = n % 2 == 0;
    const Vector3 z(0, 0, 1), axis_x = parallel ? z : random.direction(), axis_y = parallel ? z : random.direction();
    const Vector2d p(random.between(-pi, pi), random.between(-pi, pi));
    const System s{angle, angle, coupler(axis_x, axis_y, p, random), coupler(axis_x, axis_y, p, random)};
    const CommonRoots found = common_roots(angle, angle, s.f, s.g, 10.0);
    ASSERT_FALSE(found.degenerate) << n;
    ASSERT_LT(error_in_roundings(s, found, p), 1000.0) << n;
    // Of cos x cos y and sin x sin y, parallel axes have only the sum: two of the eight roots go to infinity.
    ASSERT_LE(found.complex_count, parallel ? 6 : 8) << n;
  }
}

// --- where two roots meet ---

/// Conditions through p with parallel gradients there; `bend` becomes the second derivative of the weak combination.
System touching(const Vector2d& p, double& bend, Random& random) {
  System s = through(angle, angle, p, random);
  const Matrix2d j = s.jacobian(p);
  const Vector2d change = 0.7 * j.row(0).transpose() - j.row(1).transpose();
  for (int k = 0; k < 2; ++k) {
    // change sin(x - p) leaves the value at p.
    double& sine = k == 0 ? s.g.c(2, 0) : s.g.c(0, 2);
    double& cosine = k == 0 ? s.g.c(1, 0) : s.g.c(0, 1);
    sine += change[k] * std::cos(p[k]);
    cosine -= change[k] * std::sin(p[k]);
  }
  s.g.c(0, 0) -= s.value(p)[1];
  const Vector2d along = Vector2d(-j(0, 1), j(0, 0)).normalized();
  const auto weak = [&](double t) {
    const Vector2d f = s.value(p + t * along);
    // Corrected for f = 0 along its gradient, g changes by -0.7 f.
    return f[1] - 0.7 * f[0];
  };
  constexpr double h = 1e-3;
  bend = (weak(h) - 2.0 * weak(0) + weak(-h)) / (h * h);
  return s;
}

TEST(CommonRoots, NearALimitPositionThereAreTwoOneOrNone) {
  Random random(25);
  for (int n = 0; n < 3000; ++n) {
    const Vector2d p(random.between(-pi, pi), random.between(-pi, pi));
    double bend = 0.0;
    System s = touching(p, bend, random);
    if (std::abs(bend) < 0.3 || s.jacobian(p).row(0).norm() < 0.3) continue;
    const double base = s.g.c(0, 0), shift = std::pow(10.0, random.between(-12, -5));
    const auto near = [&](double radius) {
      const CommonRoots found = s.roots();
      return std::count_if(found.roots.begin(), found.roots.end(), [&](const CommonRoot& r) {
        return apart(s, p, {r.x, r.y}) < radius;
      });
    };
    const CommonRoots limit = s.roots();
    ASSERT_EQ(near(1e-4), 1) << n;
    for (const CommonRoot& r : limit.roots) {
      if (apart(s, p, {r.x, r.y}) > 1e-4) continue;
      EXPECT_TRUE(r.repeated) << n;
      EXPECT_LT(apart(s, p, {r.x, r.y}), 1e-6) << n;
    }
    const double radius = 3.0 * std::sqrt(2.0 * shift / std::abs(bend));
    s.g.c(0, 0) = base - std::copysign(shift, bend);
    ASSERT_EQ(near(radius), 2) << n << ' ' << shift;
    s.g.c(0, 0) = base + std::copysign(shift, bend);
    ASSERT_EQ(near(radius), 0) << n << ' ' << shift;
    if (shift > 1e-8) continue;
    // All the same, if the coefficients come from numbers that are no better than that.
    const CommonRoots rough = common_roots(angle, angle, s.f, s.g, 1e16 * shift);
    EXPECT_LT(distance_to(s, rough, p), radius) << n << ' ' << shift;
  }
}

}  // namespace
}  // namespace koppel::test
