// Homogeneous matrices: the poses over again, on points and on directions.
#include "spatial/homogeneous.hpp"

#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "directions.hpp"
#include "spatial/dual.hpp"

namespace koppel::test {
namespace {

using Long = long double;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr int runs = 500;

Pose random_pose(Random& random, double size) { return {random.rotation(), size * random.vector()}; }

// Checks K-I-3.3.1.
// r = r_1 + R rho: a point is turned and shifted, a direction only turned.
TEST(HomogeneousMatrix, MovesPointsAndTurnsDirections) {
  Random random(1);
  for (const double size : {1e-160, 1.0, 1e150}) {
    for (int i = 0; i < runs; ++i) {
      const Pose x = random_pose(random, size);
      const Vector3 p = size * random.vector();
      const Matrix4 m = homogeneous_matrix(x);
      const Vector4 point = m * homogeneous_point<double>(p), direction = m * homogeneous_direction<double>(p);
      EXPECT_EQ(point[3], 1);
      EXPECT_EQ(direction[3], 0);
      EXPECT_LE((point.head<3>() / size - x * p / size).norm(), 8 * eps);
      EXPECT_LE((direction.head<3>() / size - x.rotation * p / size).norm(), 8 * eps);
      // The difference of two points is a direction.
      const Vector4 difference = homogeneous_point<double>(p) - homogeneous_point<double>(x.position);
      EXPECT_EQ(difference, homogeneous_direction<double>(p - x.position));
    }
  }
}

// Checks K-I-3.3.1.
TEST(HomogeneousMatrix, ComposesAndInvertsAsThePoseDoes) {
  Random random(2);
  for (int i = 0; i < runs; ++i) {
    const Pose a = random_pose(random, 1), b = random_pose(random, 1), c = random_pose(random, 1);
    const Matrix4 ma = homogeneous_matrix(a), mb = homogeneous_matrix(b), mc = homogeneous_matrix(c);
    EXPECT_LE((homogeneous_matrix(a * b) - ma * mb).cwiseAbs().maxCoeff(), 8 * eps);
    EXPECT_LE(((ma * mb) * mc - ma * (mb * mc)).cwiseAbs().maxCoeff(), 32 * eps);
    EXPECT_LE((homogeneous_matrix(a.inverse()) * ma - Matrix4::Identity()).cwiseAbs().maxCoeff(), 16 * eps);
    EXPECT_LE((ma * homogeneous_matrix(a.inverse()) - Matrix4::Identity()).cwiseAbs().maxCoeff(), 16 * eps);
    // Of the general inverse of a matrix, by cofactors, the condition is (1 + |p|^2), 4 at most.
    EXPECT_LE((homogeneous_matrix(a.inverse()) - ma.inverse()).cwiseAbs().maxCoeff(), 64 * eps);
  }
}

// Checks K-I-3.3.1.
TEST(HomogeneousMatrix, ReturnsToThePose) {
  Random random(3);
  for (const double size : {0.0, 1e-160, 1.0, 1e150}) {
    for (int i = 0; i < runs; ++i) {
      const Pose x = random_pose(random, size);
      const auto back = pose_of_homogeneous<double>(homogeneous_matrix(x));
      ASSERT_TRUE(back);
      EXPECT_EQ(back->rotation, x.rotation);
      EXPECT_EQ(back->position, x.position);
      const Pose y = random_pose(random, size);
      EXPECT_TRUE(pose_of_homogeneous<double>(homogeneous_matrix(x) * homogeneous_matrix(y)));
    }
    EXPECT_TRUE(pose_of_homogeneous<double>(homogeneous_matrix(random_pose(random, 1)).inverse()));
  }
}

// Checks K-I-3.3.1.
TEST(HomogeneousMatrix, IsRefusedWithAnotherLastRow) {
  const Matrix4 good = Matrix4::Identity();
  for (int k = 0; k < 4; ++k) {
    for (const double bad : {1e-300, -1.0, 2.0, 1 + 32 * eps, std::numeric_limits<double>::infinity(),
                             std::numeric_limits<double>::quiet_NaN()}) {
      Matrix4 m = good;
      m(3, k) = bad;
      EXPECT_FALSE(pose_of_homogeneous<double>(m)) << "(3, " << k << ") = " << bad;
    }
  }
  EXPECT_FALSE(pose_of_homogeneous<double>(Matrix4::Zero()));
  EXPECT_FALSE(pose_of_homogeneous<double>(good.transpose() * 2));
}

// Checks K-I-3.3.1.
// A time derivative, as dual part, has a last row of zeros; the real part is a pose.
TEST(HomogeneousMatrix, TakesOtherScalars) {
  PoseT<Dual<double>> moving;
  moving.position = {Dual<double>(1, 4), Dual<double>(2, 5), Dual<double>(3, 6)};
  const Matrix4T<Dual<double>> m = homogeneous_matrix(moving);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(m(k, 3), Dual<double>(k + 1, k + 4));
  for (int k = 0; k < 4; ++k) EXPECT_EQ(m(3, k).dual, 0);
  EXPECT_EQ(pose_of_homogeneous<Dual<double>>(m)->position, moving.position);
  EXPECT_EQ(pose_of_homogeneous<Long>(homogeneous_matrix(PoseT<Long>{}))->position, Vector3T<Long>::Zero());
}

}  // namespace
}  // namespace koppel::test
