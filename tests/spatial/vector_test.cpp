// Vectors: the rules of their products, and length, direction and angle at every size.
#include "spatial/vector.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "directions.hpp"
#include "spatial/dual.hpp"
#include "spatial/unit_vector.hpp"

namespace koppel::test {
namespace {

using Long = long double;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double pi = std::numbers::pi;
constexpr std::array<double, 9> sizes{1e-300, 1e-160, 1e-30, 1e-6, 1.0, 1e6, 1e30, 1e160, 1e300};
// What the specification asks of the identities, relative to the product of the lengths.
constexpr double identity_tolerance = 1e-14;

// Checks K-I-2.1.1.
// Sums and scalar products commute to the last digit in IEEE arithmetic; the cross product may be rounded otherwise
// where the machine multiplies and adds at once.
TEST(Vectors, CommuteInSumAndScalarProduct) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 a = random.vector(), b = random.vector();
    EXPECT_EQ(Vector3(a + b), Vector3(b + a));
    EXPECT_EQ(a.dot(b), b.dot(a));
    EXPECT_LE((a.cross(b) + b.cross(a)).norm(), 2 * eps * a.norm() * b.norm());
  }
}

// Checks K-I-2.1.1.
TEST(Vectors, HaveACrossProductOrthogonalToBothFactors) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 a = random.vector(), b = random.vector(), c = a.cross(b);
    EXPECT_LE(std::abs(c.dot(a)), identity_tolerance * a.norm() * a.norm() * b.norm());
    EXPECT_LE(std::abs(c.dot(b)), identity_tolerance * a.norm() * b.norm() * b.norm());
    const double cosine_part = a.dot(b);
    EXPECT_NEAR(std::hypot(c.norm(), cosine_part), a.norm() * b.norm(), identity_tolerance * a.norm() * b.norm());
  }
  EXPECT_EQ(Vector3::UnitX().cross(Vector3::UnitY()), Vector3::UnitZ()) << "right-handed";
}

// Checks K-I-2.1.1.
TEST(Vectors, SatisfyTheIdentitiesOfTripleProducts) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 a = random.vector(), b = random.vector(), c = random.vector(), d = random.vector();
    const double abc = a.norm() * b.norm() * c.norm();
    EXPECT_NEAR(a.dot(b.cross(c)), b.dot(c.cross(a)), identity_tolerance * abc);
    EXPECT_NEAR(a.dot(b.cross(c)), c.dot(a.cross(b)), identity_tolerance * abc);
    const Vector3 expanded = b * a.dot(c) - c * a.dot(b);
    EXPECT_LE((a.cross(b.cross(c)) - expanded).norm(), identity_tolerance * abc);
    const double lagrange = a.dot(c) * b.dot(d) - b.dot(c) * a.dot(d);
    EXPECT_NEAR(a.cross(b).dot(c.cross(d)), lagrange, identity_tolerance * abc * d.norm());
  }
}

// Checks K-I-2.1.1.
TEST(Polar, IsEmptyWhereThereIsNoDirection) {
  EXPECT_FALSE(polar<double>(Vector3::Zero()));
  EXPECT_FALSE(polar<double>(Vector3(-0.0, 0.0, -0.0)));
  EXPECT_FALSE(normalised<double>(Vector3::Zero()));
  EXPECT_FALSE(polar<Dual<double>>(Vector3T<Dual<double>>::Zero()));
  for (const double bad : {inf, -inf, nan}) {
    for (int k = 0; k < 3; ++k) {
      for (const double other : {0.0, 1.0, -2.0}) {
        Vector3 v = Vector3::Constant(other);
        v[k] = bad;
        EXPECT_FALSE(polar<double>(v)) << v.transpose();
        EXPECT_FALSE(normalised<double>(v)) << v.transpose();
        EXPECT_FALSE(angle_between<double>(v, Vector3::UnitX())) << v.transpose();
      }
    }
  }
  EXPECT_FALSE(angle_between<double>(Vector3::UnitX(), Vector3::Zero()));
  EXPECT_FALSE(angle_between<double>(Vector3::Zero(), Vector3::UnitX()));
}

// Checks K-I-2.1.1.
TEST(Polar, IsLengthAndDirectionAtEverySize) {
  Random random(4);
  for (const double size : sizes) {
    for (int i = 0; i < 200; ++i) {
      const Vector3 v = size * random.vector();
      const Long length = v.cast<Long>().norm();
      const auto p = polar<double>(v);
      ASSERT_TRUE(p);
      EXPECT_LE(std::abs(static_cast<double>(p->length / length - 1)), 4 * eps);
      EXPECT_LE((p->direction.cast<Long>() - v.cast<Long>() / length).norm(), 4 * eps);
      EXPECT_LE(std::abs(p->direction.norm() - 1), 2 * eps);
      EXPECT_EQ(*normalised<double>(v), p->direction);
    }
  }
  // The least number there is, and one part in 1e300 beside it.
  const double least = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(polar<double>(Vector3(0, -least, 0))->direction, Vector3(0, -1, 0));
  EXPECT_EQ(polar<double>(Vector3(1e150, 1e-150, 0))->direction, Vector3(1, 1e-300, 0));
}

// Checks K-I-2.1.1.
// The same vector, near 1 and scaled by a power of two: the same direction to the last digit.
TEST(Polar, DoesNotDependOnTheUnit) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const Vector3 v = random.vector();
    for (const int power : {-900, -300, 300, 900}) {
      const auto p = polar<double>(v), q = polar<double>(std::ldexp(1.0, power) * v);
      EXPECT_EQ(q->direction, p->direction);
      EXPECT_EQ(q->length, std::ldexp(p->length, power));
    }
  }
}

/// Angle of vectors by its definition, in long double: by the arc cosine in the middle of its range.
double angle_by_arc_cosine(const Vector3& a, const Vector3& b) {
  const Vector3T<Long> u = a.cast<Long>(), w = b.cast<Long>();
  return static_cast<double>(std::acos(u.dot(w) / std::sqrt(u.squaredNorm() * w.squaredNorm())));
}

// Checks K-I-2.1.1.
TEST(AngleBetween, IsTheArcCosineOfHigherPrecision) {
  Random random(6);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 a = random.vector(), b = random.vector();
    const double angle = *angle_between<double>(a, b);
    EXPECT_NEAR(angle, angle_by_arc_cosine(a, b), 8 * eps);
    EXPECT_NEAR(angle, *angle_between<double>(b, a), 8 * eps);
    EXPECT_NEAR(*angle_between<double>(a, -b), pi - angle, 8 * eps);
    EXPECT_NEAR(*angle_between<double>(1e-200 * a, 1e200 * b), angle, 8 * eps);
  }
}

// Checks K-I-2.1.1.
// b is a turned by the angle and rounded; the angle of what is then stored, by the arc tangent in long double, is known
// to eps, where the arc cosine would have lost half of the digits.
TEST(AngleBetween, IsExactNearZeroAndNearPi) {
  Random random(7);
  for (const double off : {0.0, 1e-300, 1e-16, 1e-15, 1e-12, 1e-8, 1e-4}) {
    for (int i = 0; i < 200; ++i) {
      const Vector3 a = random.direction(), across = tangents<double>(a).col(0);
      const Vector3 b = a + off * across;
      const Vector3T<Long> u = a.cast<Long>(), w = b.cast<Long>();
      const auto exact = static_cast<double>(std::atan2(u.cross(w).norm(), u.dot(w)));
      EXPECT_NEAR(*angle_between<double>(a, b), exact, 4 * eps);
      EXPECT_NEAR(*angle_between<double>(a, -b), pi - exact, 4 * eps);
    }
  }
  // Along an axis nothing is rounded on the way, and the smallest angle has all its digits.
  for (const double off : {1e-300, 1e-160, 1e-16, 1e-8}) {
    EXPECT_NEAR(*angle_between<double>(Vector3(2, 0, 0), Vector3(3, 0, 3 * off)), off, 2 * eps * off) << off;
  }
}

// Checks K-I-2.1.2.
TEST(Components, PutTheVectorTogetherAgain) {
  Random random(8);
  for (const double size : {1e-160, 1.0, 1e150}) {
    for (int i = 0; i < 1000; ++i) {
      const Matrix3 basis = random.rotation();
      const Vector3 s = size * random.vector(), parts = components<double>(s, basis);
      Vector3 sum = Vector3::Zero();
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(parts[k], s.dot(basis.col(k)), 2 * eps * size) << "an orthogonal projection";
        sum += parts[k] * basis.col(k);
      }
      EXPECT_LE((sum / size - s / size).norm(), 16 * eps);
      EXPECT_LE((basis * parts / size - s / size).norm(), 16 * eps);
    }
  }
  // A left-handed basis is orthonormal too.
  EXPECT_EQ(components<double>(Vector3(1, 2, 3), Vector3(1, 1, -1).asDiagonal()), Vector3(1, 2, -3));
}

// Checks K-I-2.1.1.
TEST(Tangents, CompleteEveryDirectionToARightHandedFrame) {
  Random random(9);
  for (int i = 0; i < 1000; ++i) {
    Vector3 n = random.direction();
    if (i < 6) n = (i < 3 ? 1.0 : -1.0) * Vector3::Unit(i % 3);
    if (i == 6) n = Vector3::Ones().normalized();
    if (i >= 7 && i < 20) n = Vector3(1, 1e-12, std::pow(10.0, -20 * i)).normalized();
    const Eigen::Matrix<double, 3, 2> t = tangents<double>(n);
    Matrix3 frame;
    frame << t, n;
    EXPECT_LE((frame.transpose() * frame - Matrix3::Identity()).cwiseAbs().maxCoeff(), 4 * eps);
    EXPECT_NEAR(frame.determinant(), 1, 8 * eps);
    Eigen::Index least = 0;
    n.cwiseAbs().minCoeff(&least);
    EXPECT_EQ(t(least, 0), 0) << "the first tangent is across the axis that n has least of";
  }
}

TEST(RateAxes, CompleteAFrameThatChangesSmoothly) {
  Random random(11);
  for (int i = 0; i < 1000; ++i) {
    Vector3 n = random.direction();
    if (i < 6) n = (i < 3 ? 1.0 : -1.0) * Vector3::Unit(i % 3);
    if (i >= 6 && i < 20) n = Vector3(std::pow(10.0, -i), std::pow(0.1, i), -1).normalized();
    const Eigen::Matrix<double, 3, 2> t = rate_axes<double>(n);
    Matrix3 frame;
    frame << t, n;
    EXPECT_LE((frame.transpose() * frame - Matrix3::Identity()).cwiseAbs().maxCoeff(), 8 * eps);
    EXPECT_NEAR(frame.determinant(), 1, 16 * eps);
    // With n they turn about n by tan(angle from z / 2) of the way, and across n by the way.
    const double across = std::hypot(n.x(), n.y()), way = 1e-6;
    const double sway = n.z() > 0.0 ? across / (1.0 + n.z()) : (1.0 - n.z()) / across;
    if (!(way * sway < 1e-3)) continue;
    const Vector3 beside = (n + way * (t * Eigen::Vector2d(std::cos(i), std::sin(i)))).normalized();
    EXPECT_LE((rate_axes<double>(beside) - t).norm(), 2.0 * way * (1.0 + sway));
  }
}

// Checks K-I-2.1.1.
// d|v| = u . dv; du is dv across u, over the length.
TEST(Polar, CarriesDerivativesAndHigherPrecision) {
  Random random(10);
  for (const double size : {1e-160, 1.0, 1e150}) {
    for (int i = 0; i < 200; ++i) {
      const Vector3 v = random.vector(), rate = random.vector();
      Vector3T<Dual<double>> moving;
      for (int k = 0; k < 3; ++k) moving[k] = {size * v[k], size * rate[k]};
      const auto p = polar<Dual<double>>(moving);
      ASSERT_TRUE(p);
      const Vector3 u = v.normalized(), across = rate - u * u.dot(rate);
      EXPECT_NEAR(p->length.dual / size, u.dot(rate), 16 * eps * rate.norm());
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(p->direction[k].dual, across[k] / v.norm(), 32 * eps * rate.norm() / v.norm());
      }
    }
  }
  const Vector3T<Long> v(1, 2, 2);
  EXPECT_EQ(polar<Long>(v)->length, 3);
  EXPECT_EQ(tangents<Long>(Vector3T<Long>::UnitZ()).col(0).cross(tangents<Long>(Vector3T<Long>::UnitZ()).col(1)),
            Vector3T<Long>::UnitZ());
}

}  // namespace
}  // namespace koppel::test
