// Quaternions: a group under Hamilton's product, and the rotations that unit quaternions are.
#include "spatial/quaternion.hpp"

#include <array>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "directions.hpp"
#include "spatial/euler_parameters.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;

Vector4 any(Random& random) {
  return {random.between(-9, 9), random.between(-9, 9), random.between(-9, 9), random.between(-9, 9)};
}
Vector4 product(const Vector4& a, const Vector4& b) { return quaternion_product<double>(a, b); }
Vector4 about(const Vector3& u, double angle) {
  return (Vector4() << std::cos(angle / 2), std::sin(angle / 2) * u).finished();
}

// Checks K-I-4.5.1.
TEST(Quaternion, UnitsMultiplyByHamiltonsRules) {
  const Vector4 one = Vector4::Unit(0), i = Vector4::Unit(1), j = Vector4::Unit(2), k = Vector4::Unit(3);
  EXPECT_EQ(product(i, j), k);
  EXPECT_EQ(product(j, k), i);
  EXPECT_EQ(product(k, i), j);
  EXPECT_EQ(product(j, i), -k);
  for (const Vector4& unit : {i, j, k}) EXPECT_EQ(product(unit, unit), -one);
  EXPECT_EQ(product(one, k), k);
}

// Checks K-I-4.5.1.
TEST(Quaternion, NotZeroAreAGroup) {
  Random random(1);
  for (int n = 0; n < 1000; ++n) {
    const Vector4 a = any(random), b = any(random), c = any(random);
    const double size = a.norm() * b.norm();
    EXPECT_LE((product(product(a, b), c) - product(a, product(b, c))).norm(), 16 * eps * size * c.norm());
    EXPECT_LE(std::abs(product(a, b).norm() - size), 8 * eps * size);
    EXPECT_LE((product(a, b + c) - product(a, b) - product(a, c)).norm(), 16 * eps * a.norm() * (b.norm() + c.norm()));
    EXPECT_LE((product(a, *quaternion_inverse<double>(a)) - Vector4::Unit(0)).norm(), 8 * eps);
    EXPECT_LE((conjugate<double>(product(a, b)) - product(conjugate<double>(b), conjugate<double>(a))).norm(),
              8 * eps * size);
    EXPECT_LE((left_factor<double>(a) * b - product(a, b)).norm(), 8 * eps * size);
    EXPECT_LE((right_factor<double>(b) * a - product(a, b)).norm(), 8 * eps * size);
  }
  const Vector4 pure(0, 1, 2, 3), other(0, -2, 0.5, 1);
  EXPECT_LE((product(pure, other) -
             (Vector4() << -pure.tail<3>().dot(other.tail<3>()), pure.tail<3>().cross(other.tail<3>())).finished())
                .norm(),
            16 * eps);
}

// Checks K-I-4.5.1.
TEST(Quaternion, ZeroHasNoInverseAndTinyOnesDo) {
  EXPECT_FALSE(quaternion_inverse<double>(Vector4::Zero()));
  const Vector4 tiny = 1e-200 * Vector4(1, -2, 3, 0.5);
  EXPECT_LE((product(tiny, *quaternion_inverse<double>(tiny)) - Vector4::Unit(0)).norm(), 8 * eps);
}

// Checks K-I-4.5.2.
TEST(Quaternion, TurnsVectorsAsItsMatrixAndAsItsSandwich) {
  Random random(2);
  for (int n = 0; n < 1000; ++n) {
    const Vector4 q = random.quaternion();
    const Vector3 v = random.vector();
    const Matrix3 r = rotation_of_quaternion<double>(q);
    const Vector4 pure = (Vector4() << 0, v).finished();
    const Vector4 sandwich = product(product(q, pure), conjugate<double>(q));
    EXPECT_LE((rotated<double>(q, v) - r * v).norm(), 16 * eps);
    EXPECT_LE((sandwich.tail<3>() - r * v).norm(), 16 * eps);
    EXPECT_LE(std::abs(sandwich[0]), 8 * eps);
    EXPECT_LE((rotated<double>(conjugate<double>(q), rotated<double>(q, v)) - v).norm(), 16 * eps);
    EXPECT_EQ(rotation_of_quaternion<double>(-q), r) << "q and -q are one rotation";
  }
}

// Checks K-I-4.5.2, K-I-4.5.4.
TEST(Quaternion, ProductIsTheProductOfTheMatrices) {
  Random random(3);
  for (int n = 0; n < 1000; ++n) {
    const Vector4 a = random.quaternion(), b = random.quaternion();
    EXPECT_LE((rotation_of_quaternion<double>(product(a, b)) -
               rotation_of_quaternion<double>(a) * rotation_of_quaternion<double>(b))
                  .cwiseAbs()
                  .maxCoeff(),
              16 * eps);
  }
}

// Checks K-I-4.5.4.
TEST(Quaternion, OfTheTwoArmRobotIsThatOfTheBook) {
  const double first = 40 * pi / 180, second = 60 * pi / 180;
  const Vector4 q = product(about(Vector3::UnitZ(), first), about(-Vector3::UnitY(), second));
  const double c1 = std::cos(first / 2), s1 = std::sin(first / 2), c2 = std::cos(second / 2), s2 = std::sin(second / 2);
  EXPECT_LE((q - Vector4(c1 * c2, s1 * s2, -c1 * s2, s1 * c2)).norm(), 4 * eps);
  EXPECT_LE((q - Vector4(0.813798, 0.171010, -0.469846, 0.296198)).cwiseAbs().maxCoeff(), 0.5e-6);
}

TEST(Quaternion, NeedNotBeOfUnitLengthForItsMatrix) {
  Random random(4);
  for (const double size : {1e-100, 0.5, 1.001, 1e100}) {
    const Vector4 q = random.quaternion();
    EXPECT_LE((rotation_of_quaternion<double>(size * q) - rotation_of_quaternion<double>(q)).cwiseAbs().maxCoeff(),
              8 * eps);
  }
}

// Checks K-I-4.5.3.
// Each greatest component has its own way; a turn about every axis by every special angle goes through all of them.
TEST(Quaternion, OfAMatrixComesByAllFourWays) {
  std::array<int, 4> ways{};
  const auto check = [&](const Vector4& q) {
    const Matrix3 r = rotation_of_quaternion<double>(q);
    const int way = greatest_component<double>(r);
    ++ways[static_cast<std::size_t>(way)];
    const Vector4 back = quaternion_of_rotation<double>(r);
    EXPECT_GE(std::abs(back[way]), 0.5 - eps);
    EXPECT_GE(back[0], 0);
    EXPECT_LE(std::abs(back.norm() - 1), 2 * eps);
    EXPECT_LE((near<double>(back, q) - q).cwiseAbs().maxCoeff(), 4 * eps) << q.transpose();
  };
  for (const double angle : {0.0, 1e-9, 1e-6, 1e-3, 0.5, pi / 2, pi - 1e-9, pi, -pi / 2}) {
    for (const Vector3& axis : {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1), Vector3(1, 1, 0),
                                Vector3(1, 1, 1), Vector3(-0.3, 0.8, 0.2)}) {
      check(about(axis.normalized(), angle));
    }
  }
  Random random(5);
  for (int n = 0; n < 1000; ++n) check(random.quaternion());
  for (const int count : ways) EXPECT_GT(count, 100);
}

// The columns are orthonormal to ten digits only: so is the answer, and of unit length to rounding.
TEST(Quaternion, OfAWornMatrixIsRightToItsDigits) {
  Random random(6);
  for (int n = 0; n < 1000; ++n) {
    const Vector4 q = random.quaternion();
    Matrix3 worn = rotation_of_quaternion<double>(q);
    worn += 1e-10 * Matrix3::NullaryExpr([&] { return random.between(-1, 1); });
    const Vector4 back = quaternion_of_rotation<double>(worn);
    EXPECT_LE((near<double>(back, q) - q).cwiseAbs().maxCoeff(), 4e-10);
    EXPECT_LE(std::abs(back.norm() - 1), 2 * eps);
  }
}

// Checks K-I-4.5.3.
TEST(Quaternion, NearThePreviousOneHasNoJump) {
  const Vector4 previous = about(Vector3::UnitX(), pi - 0.01);
  const Vector4 next =
      quaternion_of_rotation<double>(rotation_of_quaternion<double>(about(Vector3::UnitX(), pi + 0.01)));
  EXPECT_LT(next.dot(previous), 0);
  EXPECT_GT(near<double>(next, previous).dot(previous), 0.99);
}

// Checks K-I-4.5.5.
TEST(EulerParameters, HaveTheBooksMatrices) {
  const Vector4 q = Vector4(0.1, 0.7, -0.5, 0.5).normalized();
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  Eigen::Matrix<double, 3, 4> base, body;
  base << -x, w, -z, y, -y, z, w, -x, -z, -y, x, w;
  body << -x, w, z, -y, -y, -z, w, x, -z, y, -x, w;
  for (const Axes axes : {Axes::base, Axes::body}) {
    const Eigen::Matrix<double, 3, 4> h = EulerParameters::h_matrix<double>(q, axes);
    EXPECT_EQ(h, 2 * (axes == Axes::base ? base : body));
    EXPECT_EQ((*EulerParameters::k_matrix<double>(q, axes)), h.transpose() / 4);
    // The first row of the full product, which H leaves out, is the constraint.
    const Vector4 rate = *EulerParameters::k_matrix<double>(q, axes) * Vector3(0.3, -2, 1);
    EXPECT_LE(std::abs(q.dot(rate)), eps);
  }
}

}  // namespace
}  // namespace koppel::test
