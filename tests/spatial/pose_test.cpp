// Poses: composition, inverse, and what is left of their difference far from the origin.
#include "spatial/pose.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "directions.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

Pose random_pose(Random& random) { return {random.rotation(), random.vector()}; }

double distance(const Pose& a, const Pose& b) {
  return std::max((a.rotation - b.rotation).cwiseAbs().maxCoeff(), (a.position - b.position).cwiseAbs().maxCoeff());
}

TEST(Pose, ComposesAsItMovesPoints) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Pose a = random_pose(random), b = random_pose(random);
    const Vector3 p = random.vector();
    EXPECT_LE(((a * b) * p - a * (b * p)).norm(), 16 * eps);
  }
}

TEST(Pose, TimesItsInverseIsTheIdentity) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Pose a = random_pose(random);
    EXPECT_LE(distance(a * a.inverse(), Pose{}), 8 * eps);
    EXPECT_LE(distance(a.inverse() * a, Pose{}), 8 * eps);
  }
}

TEST(Pose, RelativePoseLeadsFromOneToTheOther) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Pose a = random_pose(random), b = random_pose(random);
    EXPECT_LE(distance(a * relative_pose(a, b), b), 16 * eps);
  }
}

// The positions are exact in binary; only their difference matters.
TEST(Pose, RelativePoseLosesNothingFarFromTheOrigin) {
  Random random(4);
  const Vector3 far(std::ldexp(1.0, 40), -std::ldexp(1.0, 41), std::ldexp(1.0, 39)), apart(0.25, -0.5, 0.125);
  const Pose a{random.rotation(), far}, b{random.rotation(), far + apart};
  EXPECT_LE((relative_pose(a, b).position - a.rotation.transpose() * apart).norm(), 2 * eps);
  EXPECT_GT(((a.inverse() * b).position - a.rotation.transpose() * apart).norm(), 1e-6) << "the way not to do it";
}

TEST(Skew, IsTheCrossProduct) {
  Random random(5);
  const Vector3 a = random.vector(), b = random.vector();
  EXPECT_EQ(skew(a) * b, a.cross(b));
}

}  // namespace
}  // namespace koppel::test
