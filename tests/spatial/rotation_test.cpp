// Rotation matrices: what they are, how they compose, and the nearest one to a matrix that is none.
#include "spatial/rotation.hpp"

#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "directions.hpp"
#include "spatial/dual.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;

Matrix3 about(const Vector3& u, double degrees) { return rotation_about<double>(u, degrees * pi / 180); }
double size_of(const Matrix3& m) { return m.cwiseAbs().maxCoeff(); }
const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY(), z = Vector3::UnitZ();

// Checks K-I-2.1.3.
TEST(Rotation, OfThirtyDegreesHasTheBooksCosines) {
  const Matrix3 r = about(z, 30);
  EXPECT_NEAR(r(0, 0), 0.8660254, 0.5e-7);
  EXPECT_NEAR(r(0, 1), -0.5, eps);
  EXPECT_NEAR(r(1, 0), 0.5, eps);
  const Matrix3 angles = direction_cosine_angles<double>(r) * 180 / pi;
  EXPECT_NEAR(angles(0, 0), 30, 64 * eps);
  EXPECT_NEAR(angles(0, 1), 120, 128 * eps);
  EXPECT_NEAR(angles(1, 0), 60, 64 * eps);
  EXPECT_NEAR(angles(2, 2), 0, 2 * eps);
}

// Checks K-I-2.1.3, K-I-2.1.2.
TEST(Rotation, TakesComponentsThereAndBack) {
  Random random(1);
  for (int n = 0; n < 1000; ++n) {
    const Matrix3 r = random.rotation();
    const Vector3 s = random.vector();
    EXPECT_LE((r.transpose() * (r * s) - s).norm(), 8 * eps);
    EXPECT_LE(orthonormality_residual<double>(r), 8 * eps);
    EXPECT_NEAR(r.determinant(), 1, 8 * eps);
    EXPECT_TRUE(is_rotation<double>(r, 8 * eps));
    // The angles are those of the columns brought to length one: half of what r^T r misses.
    const Matrix3 cosines = direction_cosine_angles<double>(r).array().cos();
    EXPECT_LE(size_of(cosines - r), 2 * eps + orthonormality_residual<double>(r) / 2);
  }
}

// A cosine near one hides its angle; the table does not.
TEST(Rotation, ShowsTheSmallestAngleInItsTable) {
  for (const double angle : {1e-3, 1e-8, 1e-100}) {
    EXPECT_NEAR(direction_cosine_angles<double>(rotation_about<double>(z, angle))(0, 0) / angle, 1, 4 * eps);
  }
}

// Checks K-I-2.1.3.
TEST(Rotation, IsNeitherAMirrorNorSkewedNorWorn) {
  EXPECT_FALSE(is_rotation<double>(-Matrix3::Identity()));
  EXPECT_FALSE(is_rotation<double>(Vector3(1, 1, -1).asDiagonal()));
  EXPECT_FALSE(is_rotation<double>(1.001 * Matrix3::Identity()));
  EXPECT_FALSE(is_rotation<double>(std::numeric_limits<double>::quiet_NaN() * Matrix3::Identity()));
  Matrix3 skewed = Matrix3::Identity();
  skewed(0, 1) = 1e-9;
  EXPECT_FALSE(is_rotation<double>(skewed));
  EXPECT_TRUE(is_rotation<double>(skewed, 1e-8));
  EXPECT_NEAR(orthonormality_residual<double>(skewed), 1e-9, eps);
}

// Checks K-I-4.2.1a.
TEST(RotationAbout, ItsAxisIsTheFormulaOfTheBook) {
  Random random(2);
  for (int n = 0; n < 1000; ++n) {
    const Vector3 u = random.direction();
    const double b = random.between(-7, 7), c = std::cos(b), s = std::sin(b);
    const Matrix3 r = rotation_about<double>(u, b);
    EXPECT_LE(size_of(r - (c * Matrix3::Identity() + s * skew(u) + (1 - c) * u * u.transpose())), 4 * eps);
    EXPECT_LE(size_of(r - (Matrix3::Identity() + s * skew(u) + (1 - c) * skew(u) * skew(u))), 8 * eps);
    EXPECT_LE(size_of(rotation_about<double>(u, -b) - r.transpose()), 4 * eps);
    EXPECT_LE(size_of(rotation_about<double>(-u, b) - r.transpose()), 4 * eps);
    // Two units in each entry, three in each sum, three sums.
    EXPECT_LE((r * u - u).norm(), 9 * eps);
    EXPECT_LE(size_of(rotation_about<double>(u, pi) - (2 * u * u.transpose() - Matrix3::Identity())), 4 * eps);
    EXPECT_EQ(rotation_about<double>(u, 0), Matrix3::Identity());
  }
}

// Checks K-I-4.2.3a.
TEST(RotationAbout, TwoAxesDoesNotCommute) {
  Matrix3 xy, yx;
  xy << 0, 1, 0, 0, 0, -1, -1, 0, 0;
  yx << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  EXPECT_LE(size_of(about(y, 90) * about(x, 90) - xy), 2 * eps);
  EXPECT_LE(size_of(about(x, 90) * about(y, 90) - yx), 2 * eps);
  // Small turns do, but for their product.
  for (const double a : {1e-2, 1e-3, 1e-4}) {
    const Matrix3 first = rotation_about<double>(x, a), second = rotation_about<double>(y, 2 * a);
    EXPECT_NEAR(size_of(first * second - second * first) / (2 * a * a), 1, a);
  }
}

// Checks K-I-4.2.3b.
TEST(TwoArmRobot, ReachesItsTipByTransformedCoordinates) {
  const double b1 = 40 * pi / 180, b2 = 60 * pi / 180;
  const Vector3 tip = about(z, 40) * (about(-y, 60) * x);
  EXPECT_LE((tip - Vector3(std::cos(b1) * std::cos(b2), std::sin(b1) * std::cos(b2), std::sin(b2))).norm(), 4 * eps);
  EXPECT_LE((tip - Vector3(0.3830222, 0.3213938, 0.8660254)).cwiseAbs().maxCoeff(), 0.5e-7);
}

// Checks K-I-4.2.3c, K-I-3.2.1.
// Start axes: the last turn stands leftmost. Carried axes: the second axis has been turned by the first. One end
// position, two ways there.
TEST(TwoArmRobot, ReachesItsTipAboutStartAxesAndAboutCarriedAxes) {
  const double b1 = 0.7, b2 = 1.05, c1 = std::cos(b1), s1 = std::sin(b1), c2 = std::cos(b2), s2 = std::sin(b2);
  const Matrix3 first = rotation_about<double>(z, b1), second_start = rotation_about<double>(-y, b2);
  const Vector3 carried_axis = first * -y;
  EXPECT_LE((carried_axis - Vector3(s1, -c1, 0)).norm(), eps);
  const Matrix3 second_carried = rotation_about<double>(carried_axis, b2);
  Matrix3 book;
  book << c2 + (1 - c2) * s1 * s1, -(1 - c2) * s1 * c1, -c1 * s2,  //
      -(1 - c2) * s1 * c1, c2 + (1 - c2) * c1 * c1, -s1 * s2,      //
      c1 * s2, s1 * s2, c2;
  EXPECT_LE(size_of(second_carried - book), 2 * eps);
  EXPECT_LE(size_of(second_carried - first * second_start * first.transpose()), 4 * eps);
  EXPECT_LE((first * (second_start * x) - second_carried * (first * x)).norm(), 4 * eps);
  EXPECT_GT((second_start * x - first * x).norm(), 0.5) << "the positions on the way differ";
}

// Checks K-I-3.2.1.
// The rotation tensor has the same coordinates in the frame that it turns and in the turned one.
TEST(Rotation, HasTheSameCoordinatesInBothFrames) {
  Random random(3);
  const Matrix3 r = random.rotation();
  EXPECT_LE(size_of(r.transpose() * r * r - r), 8 * eps);
}

/// How far from M the rotation about some axis is that differs from R by an angle.
double distance_of_neighbour(const Matrix3& m, const Matrix3& r, const Vector3& u, double angle) {
  return (m - r * rotation_about<double>(u, angle)).norm();
}

// Checks K-I-2.1.3.
TEST(NearestRotation, IsNearerThanItsNeighbours) {
  Random random(4);
  for (int n = 0; n < 1000; ++n) {
    const Matrix3 m = random.rotation() + 0.4 * Matrix3::NullaryExpr([&] { return random.between(-1, 1); });
    const auto nearest = nearest_rotation<double>(m);
    EXPECT_TRUE(is_rotation<double>(nearest.rotation, 16 * eps));
    EXPECT_NEAR(nearest.distance, (m - nearest.rotation).norm(), 4 * eps);
    if (nearest.ambiguous) continue;
    const double moved = distance_of_neighbour(m, nearest.rotation, random.direction(), 1e-3);
    EXPECT_GE(moved, nearest.distance - 8 * eps);
    EXPECT_GE(distance_of_neighbour(m, nearest.rotation, random.direction(), random.between(-pi, pi)),
              nearest.distance - 8 * eps);
  }
}

// Checks K-I-2.1.3.
TEST(NearestRotation, OfAStretchedRotationIsTheRotation) {
  Random random(5);
  for (int n = 0; n < 100; ++n) {
    const Matrix3 r = random.rotation(), axes = random.rotation();
    const Matrix3 stretch = axes * Vector3(2, 0.5, 1e-6).asDiagonal() * axes.transpose();
    const auto nearest = nearest_rotation<double>(r * stretch);
    // The two least stretches determine the turn between them: an error of eps times the greatest, over their sum.
    EXPECT_LE(size_of(nearest.rotation - r), 32 * eps * 2 / 0.5);
    EXPECT_FALSE(nearest.ambiguous);
  }
}

TEST(NearestRotation, SaysWhenThereAreOthers) {
  EXPECT_TRUE(nearest_rotation<double>(Matrix3::Zero()).ambiguous);
  EXPECT_TRUE(nearest_rotation<double>(x * y.transpose()).ambiguous);
  EXPECT_TRUE(nearest_rotation<double>(-Matrix3::Identity()).ambiguous);
  EXPECT_FALSE(nearest_rotation<double>(Vector3(1, 1, -0.5).asDiagonal()).ambiguous);
  for (const Matrix3& m : {Matrix3(Matrix3::Zero()), Matrix3(x * y.transpose()), Matrix3(-Matrix3::Identity())}) {
    EXPECT_TRUE(is_rotation<double>(nearest_rotation<double>(m).rotation, 16 * eps)) << "a rotation all the same";
  }
}

}  // namespace
}  // namespace koppel::test
