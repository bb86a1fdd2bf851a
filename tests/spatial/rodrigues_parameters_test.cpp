// Rodrigues parameters: the tangent of half the angle, up to half a turn.
#include "spatial/rodrigues_parameters.hpp"

#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "directions.hpp"
#include "spatial/rotation.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;

// Checks K-I-4.6.1.
TEST(RodriguesParameters, OfAQuarterTurnAreOne) {
  const auto x = extracted<RodriguesParameters, double>(rotation_about<double>(Vector3::UnitZ(), pi / 2));
  EXPECT_FALSE(x.singular);
  EXPECT_LE((x.coordinates - Vector3(0, 0, 1)).norm(), 4 * eps);
}

// Checks K-I-4.6.1.
TEST(RodriguesParameters, MakeTheBooksMatrix) {
  Random random(1);
  for (int n = 0; n < 1000; ++n) {
    const Vector3 l = 3 * random.vector();
    const Matrix3 s = skew(l), book = Matrix3::Identity() + 2 / (1 + l.squaredNorm()) * (s + s * s);
    EXPECT_LE((rotation<RodriguesParameters, double>(l) - book).cwiseAbs().maxCoeff(), 16 * eps);
  }
}

// Checks K-I-4.6.1.
TEST(RodriguesParameters, ComposeWithoutTrigonometry) {
  Random random(2);
  for (int n = 0; n < 1000; ++n) {
    const Vector3 a = 2 * random.vector(), b = 2 * random.vector();
    const auto product = rodrigues_product<double>(a, b);
    const Matrix3 both = rotation<RodriguesParameters, double>(a) * rotation<RodriguesParameters, double>(b);
    EXPECT_LE((rotation<RodriguesParameters, double>(product.coordinates) - both).cwiseAbs().maxCoeff(), 32 * eps);
    if (std::abs(1 - a.dot(b)) > 0.1) {
      const Vector3 law = (a + b + a.cross(b)) / (1 - a.dot(b));
      EXPECT_LE((product.coordinates - law).norm(), 16 * eps * (1 + law.norm()) * 10);
    }
  }
}

// Checks K-I-4.6.1.
TEST(RodriguesParameters, AreFlaggedAtHalfATurnAndFiniteAllTheSame) {
  Random random(3);
  for (int n = 0; n < 100; ++n) {
    const Vector3 u = random.direction();
    const Matrix3 r = rotation_about<double>(u, pi);
    const auto x = extracted<RodriguesParameters, double>(r);
    EXPECT_TRUE(x.singular);
    EXPECT_GT(x.coordinates.norm(), 1e15);
    EXPECT_LE((rotation<RodriguesParameters, double>(x.coordinates) - r).cwiseAbs().maxCoeff(), 8 * eps);
  }
  // Two quarter turns about one axis.
  EXPECT_TRUE(rodrigues_product<double>(Vector3::UnitX(), Vector3::UnitX()).singular);
  const Matrix3 nearly = rotation_about<double>(Vector3::UnitX(), pi - 1e-9);
  EXPECT_FALSE((extracted<RodriguesParameters, double>(nearly).singular));
}

// Checks K-I-4.6.2.
TEST(RodriguesParameters, HaveTheBooksMatrices) {
  const Vector3 l(0.4, -1.5, 3);
  const Matrix3 one = Matrix3::Identity(), s = skew(l);
  for (const Axes axes : {Axes::base, Axes::body}) {
    const double sign = axes == Axes::base ? 1 : -1;
    const Matrix3 h = 2 / (1 + l.squaredNorm()) * (one + sign * s), k = 0.5 * (one + l * l.transpose() - sign * s);
    EXPECT_LE((RodriguesParameters::h_matrix<double>(l, axes) - h).cwiseAbs().maxCoeff(), 2 * eps);
    EXPECT_LE((*RodriguesParameters::k_matrix<double>(l, axes) - k).cwiseAbs().maxCoeff(), 8 * eps);
  }
}

}  // namespace
}  // namespace koppel::test
