// Motion along a path: known curves, the same from every fixed frame, at every scale, and where there is no tangent or
// normal.
#include "spatial/path.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "directions.hpp"

namespace koppel::test {
namespace {

using Long = long double;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// r = (a cos t, a sin t, c t).
template <typename Length>
auto helix(Length a, Length c) {
  return [a, c](const auto& t) {
    using Time = std::decay_t<decltype(t)>;
    using std::cos, std::sin;
    return Vector3T<Time>(Time(a) * cos(t), Time(a) * sin(t), Time(c) * t);
  };
}

/// A path with random coefficients: a cubic and an oscillation.
auto random_path(Random& random) {
  const Vector3 p = random.vector(), q = random.vector(), s = random.vector(), w = random.vector();
  return [=](const auto& t) {
    using Time = std::decay_t<decltype(t)>;
    using std::sin;
    const auto of = [](const Vector3& x) -> Vector3T<Time> { return x.unaryExpr([](double y) { return Time(y); }); };
    return Vector3T<Time>(of(p) + of(q) * t + of(s) * (t * t * t) + of(w) * sin(Time(3.0) * t));
  };
}

void expect_orthonormal(const NaturalComponents& natural) {
  Matrix3 frame;
  frame << natural.tangent, natural.normal, natural.binormal;
  EXPECT_LE((frame.transpose() * frame - Matrix3::Identity()).cwiseAbs().maxCoeff(), 8 * eps);
  EXPECT_GT(frame.determinant(), 0);
}

void expect_no_normal(const NaturalComponents& natural) {
  EXPECT_EQ(natural.normal, Vector3::Zero());
  EXPECT_EQ(natural.binormal, Vector3::Zero());
  EXPECT_EQ(natural.normal_acceleration, 0);
  EXPECT_EQ(natural.curvature, 0);
}

// Checks K-I-3.1.1, K-I-3.1.2.
// Polynomials with small whole coefficients: every number is exact.
TEST(PointMotion, HasTheDerivativesOfThePath) {
  const auto cubic = [](const auto& t) {
    using Time = std::decay_t<decltype(t)>;
    return Vector3T<Time>(t * t * t - Time(2) * t, Time(5) - t * t, Time(7) * t);
  };
  const PointMotion motion = point_motion(cubic, 2.0);
  EXPECT_EQ(motion.position, Vector3(4, 1, 14));
  EXPECT_EQ(motion.velocity, Vector3(10, -4, 7));
  EXPECT_EQ(motion.acceleration, Vector3(12, -2, 0));
  EXPECT_EQ(point_motion(cubic, Long(2)).acceleration, Vector3T<Long>(12, -2, 0));
}

// Checks K-I-3.1.1, K-I-3.1.2, K-I-3.1.3.
// The frame's position costs eps of the greatest coordinate, its rotation a few eps of each vector.
TEST(PointMotion, IsTheSamePathInAnotherFixedFrame) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const auto path = random_path(random);
    const Pose x{random.rotation(), 10 * random.vector()};
    const PointMotion one = point_motion(path, random.between(-2, 2)), two = point_motion(path, random.between(-2, 2));
    const PointMotion one_seen = transformed(x, one), two_seen = transformed(x, two);
    const double size = 10 + one.position.norm() + two.position.norm();
    EXPECT_NEAR((one_seen.position - two_seen.position).norm(), (one.position - two.position).norm(), 8 * eps * size);

    const NaturalComponents here = natural_components(one), there = natural_components(one_seen);
    ASSERT_EQ(here.kind, PathKind::curved);
    ASSERT_EQ(there.kind, PathKind::curved);
    const double a = one.acceleration.norm();
    const double condition = a / here.normal_acceleration;  // one over the sine of the angle between v and a
    EXPECT_NEAR(there.speed, here.speed, 8 * eps * here.speed);
    EXPECT_NEAR(there.tangential_acceleration, here.tangential_acceleration, 16 * eps * a);
    EXPECT_NEAR(there.normal_acceleration, here.normal_acceleration, 16 * eps * a);
    EXPECT_NEAR(there.radius, here.radius, 32 * eps * condition * here.radius);
    EXPECT_LE((there.tangent - x.rotation * here.tangent).norm(), 8 * eps);
    EXPECT_LE((there.binormal - x.rotation * here.binormal).norm(), 16 * eps * condition);
  }
}

// Checks K-I-3.1.2, K-I-3.1.3.
// v is orthogonal to a all along: nothing is worse determined than the coordinates, good to two eps each.
TEST(NaturalComponents, OfAHelixAreThoseOfTheTextbookAtEveryScale) {
  for (const double scale : {1e-160, 1e-12, 1.0, 1e12, 1e150}) {
    for (const double slope : {0.0, 1e-6, 0.7, 1e6}) {
      for (const double t : {0.0, 0.3, 2.0, -5.0}) {
        const double a = 3 * scale, c = slope * scale, speed = std::hypot(a, c);
        const NaturalComponents natural = natural_components(point_motion(helix(a, c), t));
        ASSERT_EQ(natural.kind, PathKind::curved);
        EXPECT_NEAR(natural.speed, speed, 8 * eps * speed);
        EXPECT_NEAR(natural.tangential_acceleration, 0, 8 * eps * a);
        EXPECT_NEAR(natural.normal_acceleration, a, 8 * eps * a);
        const double radius = speed * (speed / a);
        EXPECT_NEAR(natural.radius, radius, 32 * eps * radius);
        EXPECT_NEAR(natural.curvature, 1 / radius, 32 * eps / radius);
        EXPECT_LE((natural.normal + Vector3(std::cos(t), std::sin(t), 0)).norm(), 8 * eps);
        expect_orthonormal(natural);
      }
    }
  }
}

// Checks K-I-3.1.3.
// The motion is not uniform: phi = t + t^2/2. The centre is found as well as the radius, whose condition is that of the
// sine of the angle between v and a.
TEST(NaturalComponents, OfACircleLeadToItsCentre) {
  Random random(2);
  for (int i = 0; i < 500; ++i) {
    const double radius = std::exp(random.between(-30, 30));
    const Pose x{random.rotation(), radius * random.vector()};
    const auto circle = [&](const auto& t) {
      using Time = std::decay_t<decltype(t)>;
      using std::cos, std::sin;
      const Time phi = t + Time(0.5) * t * t;
      return Vector3T<Time>(Time(radius) * cos(phi), Time(radius) * sin(phi), Time(0));
    };
    const double t = random.between(-0.9, 3), rate = 1 + t;
    const PointMotion motion = transformed(x, point_motion(circle, t));
    const NaturalComponents natural = natural_components(motion);
    ASSERT_EQ(natural.kind, PathKind::curved);
    const double a = radius * std::hypot(1, rate * rate), condition = a / (radius * rate * rate);
    EXPECT_NEAR(natural.speed, radius * rate, 16 * eps * radius * rate);
    EXPECT_NEAR(natural.tangential_acceleration, radius, 16 * eps * a);
    EXPECT_NEAR(natural.normal_acceleration, radius * rate * rate, 16 * eps * a);
    EXPECT_NEAR(natural.radius, radius, 64 * eps * condition * radius);
    EXPECT_LE((motion.position + natural.radius * natural.normal - x.position).norm(), 64 * eps * condition * radius);
    EXPECT_LE((natural.binormal - x.rotation.col(2)).norm(), 16 * eps * condition);
  }
}

// Checks K-I-3.1.3.
// Dual numbers differentiate the velocity's length and direction: d|v|/dt = a_T, and the tangent turns by speed over
// radius towards the normal.
TEST(NaturalComponents, AreTheRatesOfSpeedAndTangent) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 v = random.vector(), a = random.vector();
    Vector3T<Dual<double>> moving;
    for (int k = 0; k < 3; ++k) moving[k] = {v[k], a[k]};
    const auto along = polar<Dual<double>>(moving);
    const NaturalComponents natural = natural_components<double>(v, a);
    EXPECT_NEAR(natural.tangential_acceleration, along->length.dual, 16 * eps * a.norm());
    const Vector3 turning = natural.speed * natural.curvature * natural.normal;
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(turning[k], along->direction[k].dual, 32 * eps * a.norm() / v.norm());
    }
    const double at = natural.tangential_acceleration, an = natural.normal_acceleration;
    EXPECT_NEAR(std::hypot(at, an), a.norm(), 8 * eps * a.norm());
    EXPECT_LE((at * natural.tangent + an * natural.normal - a).norm(), 16 * eps * a.norm());
  }
}

// Checks K-I-3.1.3.
TEST(NaturalComponents, HaveNoTangentAtRest) {
  for (const Vector3& a : {Vector3(0, 0, 0), Vector3(1, 2, 3), Vector3(1e-160, 0, 0)}) {
    const NaturalComponents natural = natural_components<double>(Vector3::Zero(), a);
    EXPECT_EQ(natural.kind, PathKind::at_rest);
    EXPECT_EQ(natural.speed, 0);
    EXPECT_EQ(natural.tangent, Vector3::Zero());
    EXPECT_EQ(natural.tangential_acceleration, 0);
    EXPECT_EQ(natural.radius, 0);
    expect_no_normal(natural);
  }
  EXPECT_EQ(natural_components<double>(Vector3(1e-300, 0, 0), Vector3::Zero()).kind, PathKind::straight)
      << "however slow, it moves";
}

// Checks K-I-3.1.3.
// The multiple of v is rounded: what is left across it is rounding, and must not be taken for a normal.
TEST(NaturalComponents, HaveNoNormalWhereThePathIsStraight) {
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const double size = std::pow(10.0, random.between(-150, 150));
    const Vector3 v = size * random.vector(), a = std::pow(10.0, random.between(-150, 150)) * (v / size);
    for (const double sense : {1.0, -1.0, 0.0}) {
      const NaturalComponents natural = natural_components<double>(v, sense * a);
      EXPECT_EQ(natural.kind, PathKind::straight);
      EXPECT_LE((natural.tangent - v.stableNormalized()).norm(), 4 * eps);
      EXPECT_NEAR(natural.tangential_acceleration, sense * a.stableNorm(), 4 * eps * a.stableNorm());
      EXPECT_EQ(natural.radius, inf);
      expect_no_normal(natural);
    }
  }
}

// Checks K-I-3.1.3.
// The rounding of a leaves its angle from v uncertain by eps.
TEST(NaturalComponents, TellASlightBendFromAStraightLine) {
  Random random(5);
  for (const double sine : {1e-6, 1e-12, 1e-14}) {
    for (int i = 0; i < 200; ++i) {
      Vector3 u = random.direction();
      const Vector3 n = tangents<double>(u).col(0);
      const NaturalComponents natural = natural_components<double>(2 * u, 3 * (u + sine * n));
      ASSERT_EQ(natural.kind, PathKind::curved);
      EXPECT_NEAR(natural.curvature, 0.75 * sine, 4 * eps);
      EXPECT_LE((natural.normal - n).norm(), 4 * eps / sine);
      expect_orthonormal(natural);
    }
  }
}

// Checks K-I-3.1.3.
TEST(NaturalComponents, SayWhereTheMotionIsNoNumber) {
  const Vector3 good(1, 2, 3);
  for (const double bad : {inf, -inf, nan}) {
    for (int k = 0; k < 3; ++k) {
      Vector3 broken = good;
      broken[k] = bad;
      for (const auto& natural : {natural_components<double>(broken, good), natural_components<double>(good, broken)}) {
        EXPECT_EQ(natural.kind, PathKind::not_finite);
        EXPECT_EQ(natural.speed, 0);
        EXPECT_EQ(natural.radius, 0);
      }
    }
  }
}

// Checks K-I-3.1.3.
// The radius (a^2 + c^2) / a of a helix has the derivative 1 - (c / a)^2 with respect to a.
TEST(NaturalComponents, CarryDerivativesAndHigherPrecision) {
  const double a = 3, c = 0.7, t = 0.4;
  const Dual<double> seeded(a, 1);
  const Vector3T<Dual<double>> v(-seeded * std::sin(t), seeded * std::cos(t), Dual<double>(c));
  const Vector3T<Dual<double>> pull(-seeded * std::cos(t), -seeded * std::sin(t), Dual<double>(0));
  EXPECT_NEAR(natural_components<Dual<double>>(v, pull).radius.dual, 1 - (c / a) * (c / a), 64 * eps);

  const Long epsl = std::numeric_limits<Long>::epsilon();
  const auto precise = natural_components(point_motion(helix(Long(3), Long(4)), Long(1)));
  EXPECT_LE(std::abs(precise.radius - Long(25) / Long(3)), 32 * epsl * 9);
}

}  // namespace
}  // namespace koppel::test
