// Homogeneous solids: put together of smaller ones of their kind, and replaced by a few mass points.
#include "spatial/solids.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "directions.hpp"
#include "spatial/inertia_validity.hpp"

namespace koppel::test {
namespace {

using Long = long double;
constexpr double eps = std::numeric_limits<double>::epsilon();

Pose at(const Vector3& p) { return {Matrix3::Identity(), p}; }

void expect_same(const SpatialInertia& a, const SpatialInertia& b) {
  const double size = b.about_centre.norm();
  EXPECT_NEAR(a.mass, b.mass, 4 * eps * b.mass);
  EXPECT_LE((a.about_centre - b.about_centre).norm(), 16 * eps * size);
  EXPECT_LE((a.centre - b.centre).norm(), 16 * eps * std::sqrt(size / b.mass));
}

TEST(Solids, HaveTheMomentsOfTheTextbook) {
  EXPECT_EQ(solid_box<double>(12, {1, 2, 3}).about_centre, Matrix3(Vector3(13, 10, 5).asDiagonal()));
  EXPECT_EQ(solid_cylinder<double>(12, 2, 3).about_centre, Matrix3(Vector3(21, 21, 24).asDiagonal()));
  EXPECT_EQ(solid_sphere<double>(5, 1).about_centre, Matrix3(Vector3(2, 2, 2).asDiagonal()));
  EXPECT_EQ(thin_rod<double>(12, 2).about_centre, Matrix3(Vector3(4, 4, 0).asDiagonal()));
  EXPECT_EQ(solid_box<Long>(12, {1, 2, 3}).about_centre(0, 0), 13);
}

// Eight boxes of half the edges make the box; two halves of a cylinder make the cylinder.
TEST(Solids, AreMadeOfSmallerOnes) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Vector3 edges = random.vector().cwiseAbs();
    const double mass = random.between(0.1, 10), radius = random.between(0.1, 1), height = random.between(0.1, 1);
    SpatialInertia eight;
    for (const double x : {-0.25, 0.25}) {
      for (const double y : {-0.25, 0.25}) {
        for (const double z : {-0.25, 0.25}) {
          eight = eight + transformed(at(Vector3(x, y, z).cwiseProduct(edges)), solid_box<double>(mass / 8, edges / 2));
        }
      }
    }
    expect_same(eight, solid_box<double>(mass, edges));
    const SpatialInertia half = solid_cylinder<double>(mass / 2, radius, height / 2);
    expect_same(transformed(at({0, 0, height / 4}), half) + transformed(at({0, 0, -height / 4}), half),
                solid_cylinder<double>(mass, radius, height));
    const SpatialInertia half_rod = thin_rod<double>(mass / 2, height / 2);
    expect_same(transformed(at({0, 0, height / 4}), half_rod) + transformed(at({0, 0, -height / 4}), half_rod),
                thin_rod<double>(mass, height));
  }
}

// Points at nodes of Gauss integrate the squares of the coordinates exactly: at 1/sqrt(3) of half an edge, at 1/sqrt(2)
// of a disc's radius, at sqrt(3/5) of a sphere's.
TEST(Solids, AreReplacedByMassPoints) {
  const double mass = 2.5, radius = 0.7, height = 1.9;
  const Vector3 edges(0.3, 1.1, 2.3), node = edges / (2 * std::sqrt(3.0));
  const double disc = radius / std::sqrt(2.0), ball = radius * std::sqrt(0.6), end = height / (2 * std::sqrt(3.0));
  std::vector<PointMass> box, cylinder, sphere;
  for (const double x : {-1.0, 1.0}) {
    for (int k = 0; k < 3; ++k) sphere.push_back({mass / 6, x * ball * Vector3::Unit(k)});
    for (const double z : {-1.0, 1.0}) {
      cylinder.push_back({mass / 8, {x * disc, 0, z * end}});
      cylinder.push_back({mass / 8, {0, x * disc, z * end}});
      for (const double y : {-1.0, 1.0}) box.push_back({mass / 8, Vector3(x, y, z).cwiseProduct(node)});
    }
  }
  expect_same(inertia_from_points<double>(box), solid_box<double>(mass, edges));
  expect_same(inertia_from_points<double>(cylinder), solid_cylinder<double>(mass, radius, height));
  expect_same(inertia_from_points<double>(sphere), solid_sphere<double>(mass, radius));
}

TEST(Solids, ArePossibleAtEverySize) {
  for (const double size : {0.0, 1e-60, 1e-12, 1.0, 1e12, 1e60}) {
    for (const SpatialInertia& body :
         {solid_box<double>(size, {size, 2 * size, 0}), solid_box<double>(size, {size, 2 * size, 3 * size}),
          solid_cylinder<double>(size, size, 5 * size), solid_sphere<double>(size, size),
          thin_rod<double>(size, size)}) {
      EXPECT_TRUE(validity(body).is_valid()) << size;
      EXPECT_GE(validity(body).margin, -2 * eps);
    }
  }
  EXPECT_DOUBLE_EQ(validity(solid_sphere<double>(1, 1)).margin, 0.5);
}

}  // namespace
}  // namespace koppel::test
