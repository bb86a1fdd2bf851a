// Cardan angles: they put the matrix together again, in the middle and at the ends of their range.
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "directions.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;

Matrix3 of_cardan_angles(const Vector3& angles) {
  return rotation_about<double>(Vector3::UnitX(), angles[0]) * rotation_about<double>(Vector3::UnitY(), angles[1]) *
         rotation_about<double>(Vector3::UnitZ(), angles[2]);
}

double missed(const Matrix3& r) { return (of_cardan_angles(cardan_angles<double>(r)) - r).cwiseAbs().maxCoeff(); }

TEST(CardanAngles, AreThoseThatMadeTheMatrix) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 angles(random.between(-3.1, 3.1), random.between(-1.4, 1.4), random.between(-3.1, 3.1));
    // Next to the ends of beta's range the others are worse determined, by 1 / cos(beta).
    EXPECT_LE((cardan_angles<double>(of_cardan_angles(angles)) - angles).norm(), 8 * eps / std::cos(angles[1]));
  }
}

TEST(CardanAngles, PutTheMatrixTogetherAgainHoweverNearToGimbalLock) {
  Random random(2);
  for (const double off : {1.0, 1e-2, 1e-5, 1e-7, 1e-9, 1e-12, 1e-14, 1e-15, 1e-16, 0.0}) {
    for (const double side : {-1.0, 1.0}) {
      for (int i = 0; i < 50; ++i) {
        const Vector3 angles(random.between(-3.1, 3.1), side * (pi / 2 - off), random.between(-3.1, 3.1));
        const Matrix3 there = random.rotation();
        const Matrix3 r = there * (there.transpose() * of_cardan_angles(angles));  // rounded like any other matrix
        EXPECT_LE(missed(r), 32 * eps) << angles.transpose();
      }
    }
  }
}

TEST(CardanAngles, LeaveTheThirdAtZeroInGimbalLock) {
  const Vector3 up = cardan_angles<double>(of_cardan_angles({0.3, pi / 2, 0.4}));
  EXPECT_NEAR(up[0], 0.7, 4 * eps);
  EXPECT_NEAR(up[1], pi / 2, 4 * eps);
  EXPECT_EQ(up[2], 0);
  const Vector3 down = cardan_angles<double>(of_cardan_angles({0.3, -pi / 2, 0.4}));
  EXPECT_NEAR(down[0], -0.1, 4 * eps);
  EXPECT_EQ(down[2], 0);
}

}  // namespace
}  // namespace koppel::test
