// Between two rotations: one axis, constant rate, and the same from wherever one looks.
#include "spatial/interpolation.hpp"

#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "directions.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;

double angle_of(const Matrix3& r) { return rotation_vector_of_rotation<double>(r).norm(); }

TEST(Interpolation, StartsAtOneEndsAtTheOtherAndTurnsEvenly) {
  Random random(1);
  for (int n = 0; n < 1000; ++n) {
    const Matrix3 a = random.rotation(), b = random.rotation();
    const double whole = angle_of(a.transpose() * b);
    EXPECT_LE((interpolated<double>(a, b, 0).value - a).cwiseAbs().maxCoeff(), 8 * eps);
    EXPECT_LE((interpolated<double>(a, b, 1).value - b).cwiseAbs().maxCoeff(), 16 * eps);
    for (const double fraction : {0.1, 0.5, 0.9}) {
      const Matrix3 between = interpolated<double>(a, b, fraction).value;
      EXPECT_NEAR(angle_of(a.transpose() * between), fraction * whole, 16 * eps);
      EXPECT_NEAR(angle_of(between.transpose() * b), (1 - fraction) * whole, 16 * eps);
    }
  }
}

TEST(Interpolation, IsTheSameForMatricesAndQuaternionsAndInEveryBase) {
  Random random(2);
  for (int n = 0; n < 1000; ++n) {
    const Vector4 a = random.quaternion(), b = random.quaternion();
    const double fraction = random.between(-1, 2);
    const Matrix3 base = random.rotation(), ra = rotation_of_quaternion<double>(a),
                  rb = rotation_of_quaternion<double>(b);
    const Matrix3 found = interpolated<double>(ra, rb, fraction).value;
    // Beyond the ends the turn is up to twice as long, and so is its error.
    EXPECT_LE(
        (rotation_of_quaternion<double>(interpolated<double>(a, b, fraction).value) - found).cwiseAbs().maxCoeff(),
        32 * eps);
    EXPECT_LE((interpolated<double>(Matrix3(base * ra), Matrix3(base * rb), fraction).value - base * found)
                  .cwiseAbs()
                  .maxCoeff(),
              48 * eps);
    // q and -q are one rotation: the way is never the long one round.
    EXPECT_LE(std::abs(interpolated<double>(a, Vector4(-b), 0.5).value.dot(interpolated<double>(a, b, 0.5).value) - 1),
              16 * eps);
  }
}

TEST(Interpolation, SaysWhenTheOtherWayIsAsShort) {
  const Matrix3 half = rotation_about<double>(Vector3::UnitY(), pi);
  EXPECT_TRUE(interpolated<double>(Matrix3(Matrix3::Identity()), half, 0.3).ambiguous);
  EXPECT_TRUE(interpolated<double>(Vector4(Vector4::Unit(0)), Vector4(Vector4::Unit(2)), 0.3).ambiguous);
  const Matrix3 nearly = rotation_about<double>(Vector3::UnitY(), pi - 1e-9);
  EXPECT_FALSE(interpolated<double>(Matrix3(Matrix3::Identity()), nearly, 0.3).ambiguous);
}

TEST(Interpolation, OfTwoThatAreTheSameIsThat) {
  Random random(3);
  const Vector4 q = random.quaternion();
  EXPECT_LE((interpolated<double>(q, q, 0.7).value - q).norm(), 4 * eps);
}

}  // namespace
}  // namespace koppel::test
