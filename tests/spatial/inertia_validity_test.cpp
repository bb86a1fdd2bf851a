// Which mass properties a rigid body can have: those of point clouds always, others refused with the reason.
#include "spatial/inertia_validity.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "directions.hpp"

namespace koppel::test {
namespace {

using Long = long double;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr int runs = 200;

SpatialInertia with_moments(const Vector3& moments, const Matrix3& axes) {
  return inertia_from_principal_moments<double>(1, Vector3(1, 2, 3), moments, axes);
}

void expect_fault(const SpatialInertia& body, InertiaFault fault) {
  const InertiaValidity verdict = validity(body);
  EXPECT_EQ(verdict.fault, fault) << body.about_centre;
  EXPECT_EQ(verdict.is_valid(), fault == InertiaFault::none);
  if (fault != InertiaFault::none) {
    EXPECT_LT(verdict.margin, 0);
  }
}

/// A random cloud squeezed to a plane, to a line or to a point by factors of its coordinates, then turned.
SpatialInertia cloud(Random& random, const Vector3& factors, int points) {
  const Pose x{random.rotation(), random.vector()};
  std::vector<PointMass> masses;
  masses.reserve(static_cast<std::size_t>(points));
  for (int i = 0; i < points; ++i) {
    masses.push_back({random.between(0.1, 1), x * random.vector().cwiseProduct(factors)});
  }
  return inertia_from_points<double>(masses);
}

TEST(Validity, IsGivenToEveryCloudOfPoints) {
  Random random(1);
  for (int i = 0; i < runs; ++i) {
    const SpatialInertia body = cloud(random, Vector3::Ones(), 40);
    expect_fault(body, InertiaFault::none);
    EXPECT_GT(validity(body).margin, 1e-3);
    EXPECT_LE(validity(body).margin, 0.5);
  }
}

// Nothing is left of the margin but the rounding of coordinates of size one, twice that of the tensor, and of the
// solver: relative to the body's own extent.
TEST(Validity, IsGivenToFlatBodiesRodsAndPoints) {
  Random random(2);
  for (int i = 0; i < runs; ++i) {
    for (const Vector3& factors : {Vector3(1, 1, 0), Vector3(0, 2, 0.5)}) {
      for (const int points : {3, 40}) {
        const SpatialInertia body = cloud(random, factors, points);
        const double extent = std::sqrt(body.about_centre.norm() / body.mass);
        expect_fault(body, InertiaFault::none);
        EXPECT_NEAR(validity(body).margin, 0, 32 * eps * 4 / extent);
      }
    }
    expect_fault(cloud(random, Vector3(1, 0, 0), 40), InertiaFault::none);
    expect_fault(cloud(random, Vector3(1, 1, 1), 2), InertiaFault::none);
    expect_fault(cloud(random, Vector3(1, 1, 1), 1), InertiaFault::none);
  }
  expect_fault({}, InertiaFault::none);
  EXPECT_EQ(validity(SpatialInertia{}).margin, 0);
}

// The verdict and the margin are those of the principal moments, in whatever axes.
TEST(Validity, TellsTheReasonAndTheMargin) {
  struct Case {
    Vector3 moments;
    InertiaFault fault;
    double margin;
  };
  const InertiaFault triangle = InertiaFault::triangle_inequality, negative = InertiaFault::not_positive_semidefinite;
  const std::vector<Case> cases{{{1, 1, 1}, InertiaFault::none, 0.5},
                                {{2, 3, 4}, InertiaFault::none, 0.125},
                                {{1, 1, 2}, InertiaFault::none, 0},
                                {{0, 1, 1}, InertiaFault::none, 0},
                                {{1, 1, 3}, triangle, -1.0 / 6},
                                {{0, 1, 2}, triangle, -0.25},
                                {{0, 0, 1}, triangle, -0.5},
                                {{-1, 1, 1}, negative, -0.5},
                                {{-1, 4, 4}, negative, -0.125},
                                {{-1, -1, -1}, negative, -0.5},
                                {{1, 1, 2 + 1e-10}, triangle, -2.5e-11},
                                {{-1e-10, 1, 1}, negative, -0.5e-10}};
  Random random(3);
  for (int i = 0; i < runs; ++i) {
    Matrix3 axes = random.rotation();
    if (i == 0) axes.setIdentity();
    if (i % 2 == 1) axes.col(2) *= -1;  // mirrored
    for (const Case& c : cases) {
      for (const double scale : {1e-160, 1e-12, 1.0, 1e150}) {
        const SpatialInertia body = with_moments(scale * c.moments, axes);
        expect_fault(body, c.fault);
        EXPECT_NEAR(validity(body).margin, c.margin, 32 * eps);
      }
    }
  }
}

TEST(Validity, ComesBeforeTheTensorWhereTheMassIsWrong) {
  const Matrix3 good = Matrix3::Identity();
  expect_fault({-1, Vector3::Zero(), good}, InertiaFault::negative_mass);
  expect_fault({-1e-300, Vector3::Zero(), Matrix3::Zero()}, InertiaFault::negative_mass);
  expect_fault({0, Vector3::Zero(), 1e-300 * good}, InertiaFault::inertia_without_mass);
  expect_fault({0, Vector3(1, 2, 3), Matrix3::Zero()}, InertiaFault::none);
  for (const double bad : {inf, -inf, nan}) {
    expect_fault({bad, Vector3::Zero(), good}, InertiaFault::not_finite);
    for (int k = 0; k < 9; ++k) {
      Matrix3 broken = good;
      broken(k) = bad;
      expect_fault({1, Vector3::Zero(), broken}, InertiaFault::not_finite);
      EXPECT_FALSE(principal_inertia<double>(broken));
    }
    for (int k = 0; k < 3; ++k) {
      Vector3 broken = Vector3::Zero();
      broken[k] = bad;
      expect_fault({1, broken, good}, InertiaFault::not_finite);
    }
  }
}

TEST(Validity, IsRefusedToATensorThatIsNotSymmetric) {
  for (const double scale : {1e-160, 1.0, 1e150}) {
    Matrix3 tensor = scale * Matrix3::Identity();
    tensor(0, 1) = 1e-10 * scale;
    expect_fault({1, Vector3::Zero(), tensor}, InertiaFault::not_symmetric);
    EXPECT_DOUBLE_EQ(validity(SpatialInertia{1, Vector3::Zero(), tensor}).margin, -1e-10);
    tensor(1, 0) = tensor(0, 1);
    expect_fault({1, Vector3::Zero(), tensor}, InertiaFault::none);
  }
}

// A flat body whose moments were written with six digits misses the triangle inequality by half a unit of the last.
TEST(Validity, ForgivesWhatTheSlackAllows) {
  const SpatialInertia body = with_moments({0.333333, 0.333333, 0.666667}, Matrix3::Identity());
  EXPECT_EQ(validity(body).fault, InertiaFault::triangle_inequality);
  EXPECT_NEAR(validity(body).margin, -0.5e-6 / 0.666667, 4 * eps);
  EXPECT_TRUE(validity(body, 1e-6).is_valid());
  EXPECT_FALSE(validity(body, 0.5e-6).is_valid());
}

TEST(Validity, IsKeptByMotionMirroringAndScaling) {
  Random random(4);
  for (int i = 0; i < runs; ++i) {
    const SpatialInertia body = cloud(random, Vector3(1, 0.5, 1e-3), 40);
    const double margin = validity(body).margin;
    const SpatialInertia moved = transformed(Pose{random.rotation(), 100 * random.vector()}, body);
    EXPECT_NEAR(validity(moved).margin, margin, 32 * eps);
    Matrix3 mirror = Matrix3::Identity();
    mirror(i % 3, i % 3) = -1;
    const SpatialInertia mirrored = transformed(Pose{mirror, Vector3::Zero()}, body);
    EXPECT_NEAR(validity(mirrored).margin, margin, 32 * eps);
    const SpatialInertia small{1e-12 * body.mass, 1e-12 * body.centre, 1e-36 * body.about_centre};
    EXPECT_NEAR(validity(small).margin, margin, 32 * eps);
    EXPECT_TRUE(validity(body + moved).is_valid()) << "what is put together of bodies is a body";
  }
}

TEST(PrincipalInertia, MakesTheTensorAgain) {
  Random random(5);
  for (const double scale : {1e-160, 1.0, 1e150}) {
    for (int i = 0; i < runs; ++i) {
      const Matrix3 tensor = scale * cloud(random, Vector3::Ones(), i % 2 == 0 ? 40 : 3).about_centre;
      const auto principal = principal_inertia<double>(tensor);
      ASSERT_TRUE(principal);
      const Matrix3& axes = principal->axes;
      EXPECT_LE((axes.transpose() * axes - Matrix3::Identity()).cwiseAbs().maxCoeff(), 16 * eps);
      EXPECT_GT(axes.determinant(), 0);
      EXPECT_LE(principal->moments[0], principal->moments[1]);
      EXPECT_LE(principal->moments[1], principal->moments[2]);
      const Matrix3 again =
          inertia_from_principal_moments<double>(1, Vector3::Zero(), principal->moments, axes).about_centre;
      EXPECT_LE((again / scale - tensor / scale).norm(), 32 * eps * (tensor / scale).norm());
    }
  }
}

// Equal moments: the axes are not determined, but they are axes.
TEST(PrincipalInertia, FindsAxesWhereMomentsAreEqual) {
  Random random(6);
  for (int i = 0; i < runs; ++i) {
    for (const Vector3& moments : {Vector3(1, 1, 2), Vector3(1, 2, 2), Vector3(3, 3, 3), Vector3(0, 0, 0)}) {
      const Matrix3 tensor = with_moments(moments, random.rotation()).about_centre;
      const auto principal = principal_inertia<double>(tensor);
      ASSERT_TRUE(principal);
      EXPECT_LE((principal->moments - moments).norm(), 32 * eps * moments.norm());
      EXPECT_LE((principal->axes.transpose() * principal->axes - Matrix3::Identity()).norm(), 32 * eps);
      EXPECT_GT(principal->axes.determinant(), 0);
    }
  }
}

TEST(Validity, TakesHigherPrecision) {
  SpatialInertiaT<Long> body{1, Vector3T<Long>::Zero(), Vector3T<Long>(1, 1, 2).asDiagonal()};
  EXPECT_TRUE(validity(body).is_valid());
  body.about_centre(2, 2) += 1e-16L;
  EXPECT_EQ(validity(body).fault, InertiaFault::triangle_inequality) << "far above the rounding of long double";
}

}  // namespace
}  // namespace koppel::test
