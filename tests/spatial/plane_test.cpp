// Planes: through points, beside points, across lines, and with each other, in general and in every special position.
#include "spatial/plane.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "directions.hpp"

namespace koppel::test {
namespace {

using Long = long double;
using D = Dual<double>;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;
constexpr std::array<double, 5> sizes{1e-160, 1e-9, 1.0, 1e9, 1e150};

Line line_at(const Vector3& point, const Vector3& direction) { return *line_through<double>(point, direction); }
Plane plane_at(const Vector3& point, const Vector3& normal) { return *plane_through<double>(point, normal); }
double length(const Vector3& v) {
  const auto p = polar<double>(v);
  return p ? p->length : 0.0;
}
/// A unit vector at an angle to a unit vector.
Vector3 tilted(const Vector3& n, double angle, Random& random) {
  const Vector3 across = rotation_about<double>(n, random.between(-3, 3)) * tangents<double>(n).col(0);
  return std::cos(angle) * n + std::sin(angle) * across;
}

TEST(Plane, HasAFootOfThePerpendicularFromEveryPoint) {
  Random random(1);
  for (const double size : sizes) {
    for (int i = 0; i < 200; ++i) {
      const Vector3 n = random.direction(), on = size * random.vector();
      const double height = size * random.between(-1, 1);
      const Plane plane = plane_at(on, random.between(0.1, 9) * n);
      const Vector3 p = on + height * n;
      EXPECT_NEAR(signed_distance(plane, p) / size, height / size, 8 * eps * 3);
      EXPECT_LE(length(foot_point(plane, p) - on) / size, 16 * eps * 3);
      EXPECT_NEAR(signed_distance(-plane, p), -signed_distance(plane, p), 0);
      EXPECT_NEAR(signed_distance(plane, plane.nearest_to_origin()) / size, 0, 4 * eps * 2);
    }
  }
  EXPECT_FALSE(plane_through<double>({1, 2, 3}, {0, 0, 0}));
  EXPECT_FALSE(plane_through<double>({1, 2, 3}, {0, std::nan(""), 1}));
}

// The corners are off by the rounding of the normal, over edges of up to three sizes.
TEST(Plane, ContainsTheThreePointsThatItIsThrough) {
  Random random(2);
  for (const double size : sizes) {
    for (int i = 0; i < 300; ++i) {
      const Vector3 p = size * random.vector(), q = size * random.vector(), r = size * random.vector();
      const auto plane = plane_through_points<double>(p, q, r);
      ASSERT_TRUE(plane);
      for (const Vector3& point : {p, q, r}) EXPECT_NEAR(signed_distance(*plane, point) / size, 0, 16 * eps * 3);
      const Vector3 area = ((q - p) / size).cross((r - p) / size);
      EXPECT_GT(plane->normal.dot(area), 0) << "counterclockwise from the positive side";
      const auto turned = plane_through_points<double>(q, r, p), mirrored = plane_through_points<double>(q, p, r);
      EXPECT_LE((turned->normal - plane->normal).norm(), 32 * eps / area.norm());
      EXPECT_LE((mirrored->normal + plane->normal).norm(), 32 * eps / area.norm());
    }
  }
}

// The thin side may be at any corner.
TEST(Plane, ThroughAThinTriangleIsExact) {
  const Vector3 p(0, 0, 0), q(1, 0, 0);
  for (const double thin : {1e-3, 1e-8, 1e-13}) {
    for (const Vector3& r : {Vector3(1, thin, 0), Vector3(0, thin, 0), Vector3(0.5, thin, 0), Vector3(-3, thin, 0)}) {
      for (const auto& plane : {plane_through_points<double>(p, q, r), plane_through_points<double>(r, p, q)}) {
        ASSERT_TRUE(plane);
        EXPECT_EQ(plane->normal, Vector3::UnitZ());
        EXPECT_EQ(plane->offset, 0);
      }
    }
  }
}

TEST(Plane, NeedsThreePointsThatAreNotInLine) {
  Random random(3);
  for (const double size : sizes) {
    for (int i = 0; i < 200; ++i) {
      const Vector3 p = size * random.vector(), edge = size * random.direction();
      const Vector3 q = p + edge, r = p + random.between(-2, 2) * edge;
      EXPECT_FALSE(plane_through_points<double>(p, q, r));
      EXPECT_FALSE(plane_through_points<double>(q, r, p));
      EXPECT_FALSE(plane_through_points<double>(p, p, q));
      EXPECT_FALSE(plane_through_points<double>(p, q, p));
      EXPECT_FALSE(plane_through_points<double>(q, p, p));
      EXPECT_FALSE(plane_through_points<double>(p, p, p));
    }
  }
}

TEST(Plane, MovesWithItsPoints) {
  Random random(4);
  for (const double size : sizes) {
    for (int i = 0; i < 200; ++i) {
      const Pose x{random.rotation(), size * random.vector()};
      const Plane plane = plane_at(size * random.vector(), random.direction()), moved = transformed(x, plane);
      const Vector3 p = size * random.vector();
      EXPECT_NEAR(signed_distance(moved, x * p) / size, signed_distance(plane, p) / size, 16 * eps * 4);
      EXPECT_LE((moved.normal - x.rotation * plane.normal).norm(), 4 * eps);
    }
  }
}

TEST(Angles, OfLinesAndPlanesAreExactAtBothEnds) {
  Random random(5);
  for (const double angle : {0.0, 1e-12, 1e-7, 0.3, 1.0, pi / 2, 2.0, pi - 1e-7, pi}) {
    for (int i = 0; i < 100; ++i) {
      const Vector3 n = random.direction(), m = tilted(n, angle, random);
      const Plane plane = plane_at(random.vector(), n);
      EXPECT_NEAR(dihedral_angle(plane, plane_at(random.vector(), m)), angle, 8 * eps);
      EXPECT_NEAR(inclination(plane, line_at(random.vector(), m)), pi / 2 - angle, 8 * eps);
    }
  }
}

// The point is on both, within rounding at the distance of the farthest of line, plane and point.
TEST(LineAndPlane, MeetInAPoint) {
  Random random(6);
  for (const double size : sizes) {
    for (const double angle : {1.5, 0.5, -0.5, 1e-3, 1e-7, 1e-12}) {
      for (int i = 0; i < 100; ++i) {
        const Vector3 n = random.direction(), p = size * random.vector();
        const Line line = line_at(p, tilted(n, pi / 2 - angle, random));
        const Plane plane = plane_at(p + size * random.between(-1, 1) * tangents<double>(n).col(0), n);
        const auto meeting = intersection(plane, line);
        ASSERT_EQ(meeting.kind, Intersection::point);
        const double tolerance = 16 * eps * 3 / std::abs(std::sin(angle));
        EXPECT_LE(length(meeting.point - p) / size, tolerance);
        const double reach = 3 + length(meeting.point) / size;
        EXPECT_LE(distance(line, meeting.point) / size, 8 * eps * reach);
        EXPECT_NEAR(signed_distance(plane, meeting.point) / size, 0, 16 * eps * reach);
      }
    }
  }
  const auto corner = intersection(plane_at({0, 0, 2}, {0, 0, 1}), line_at({3, 4, 7}, {0, 0, -1}));
  EXPECT_EQ(corner.point, Vector3(3, 4, 2));
}

TEST(LineAndPlane, ParallelLinesLieInThePlaneOrBesideIt) {
  Random random(7);
  for (const double size : sizes) {
    for (int i = 0; i < 200; ++i) {
      const Vector3 n = random.direction(), on = size * random.vector();
      const Plane plane = plane_at(on, n);
      const double height = size * random.between(0.1, 1) * (i % 2 == 0 ? 1 : -1);
      const Vector3 u = rotation_about<double>(n, random.between(-3, 3)) * tangents<double>(n).col(0);
      // Built with rounding at the normal, the direction, and the points, which are at most three sizes away.
      const IncidenceTolerance rounded{8 * eps, 32 * eps * size};
      const auto beside = intersection(plane, line_at(on + height * n, u), rounded);
      EXPECT_EQ(beside.kind, Intersection::none);
      EXPECT_NEAR(beside.distance / size, height / size, 16 * eps * 3);
      const Line line = line_at(on + size * u, u);
      const auto inside = intersection(plane, line, rounded);
      EXPECT_EQ(inside.kind, Intersection::line);
      EXPECT_NEAR(inside.distance / size, 0, 32 * eps);
      EXPECT_EQ(inside.point, line.nearest_to_origin());
    }
  }
  EXPECT_EQ(intersection(Plane(), line_at({5, 0, 0}, Vector3::UnitY())).kind, Intersection::line);
  EXPECT_EQ(intersection(Plane(), line_at({5, 0, 1e-300}, Vector3::UnitY())).kind, Intersection::line);
  EXPECT_EQ(intersection(Plane(), line_at({0, 0, 1e-300}, Vector3::UnitY())).kind, Intersection::none);
}

// The line is in both planes, to rounding at the distance of its nearest point.
TEST(TwoPlanes, CrossInALine) {
  Random random(8);
  for (const double size : sizes) {
    for (const double angle : {1.5, 0.5, 2.5, pi - 1e-3, 1e-7, 1e-12}) {
      for (int i = 0; i < 100; ++i) {
        const Vector3 n = random.direction(), p = size * random.vector();
        const Vector3 m = tilted(n, angle, random);
        const Plane a = plane_at(p, n), b = plane_at(p, m);
        const auto pair = intersection(a, b);
        ASSERT_EQ(pair.kind, Intersection::line);
        ASSERT_TRUE(pair.line);
        const Line& line = *pair.line;
        EXPECT_NEAR(line.direction.dot(n), 0, 4 * eps);
        EXPECT_NEAR(line.direction.dot(m), 0, 4 * eps);
        EXPECT_GT(n.cross(m).dot(line.direction), 0);
        const Vector3 near = line.nearest_to_origin();
        const double reach = 3 + length(near) / size;
        EXPECT_NEAR(line.direction.dot(line.moment) / size, 0, 8 * eps * reach);
        EXPECT_NEAR(signed_distance(a, near) / size, 0, 16 * eps * reach);
        EXPECT_NEAR(signed_distance(b, near) / size, 0, 16 * eps * reach);
        EXPECT_LE(distance(line, p) / size, 16 * eps * 3 / std::sin(angle));
      }
    }
  }
  const auto edge = intersection(plane_at({0, 0, 2}, {0, 0, 1}), plane_at({3, 0, 0}, {1, 0, 0}));
  EXPECT_EQ(edge.line->direction, Vector3::UnitY());
  EXPECT_EQ(edge.line->nearest_to_origin(), Vector3(3, 0, 2));
}

TEST(TwoPlanes, MayBeParallelOrTheSame) {
  Random random(9);
  for (const double size : sizes) {
    for (int i = 0; i < 200; ++i) {
      const Vector3 n = random.direction(), p = size * random.vector();
      const double apart = size * random.between(0.1, 1) * (i % 2 == 0 ? 1 : -1), sense = i % 3 == 0 ? -1 : 1;
      const Plane a = plane_at(p, n), b = plane_at(p + apart * n, sense * n);
      const auto pair = intersection(a, b);
      EXPECT_EQ(pair.kind, Intersection::none);
      EXPECT_FALSE(pair.line);
      EXPECT_NEAR(pair.distance / size, apart / size, 8 * eps * 3);
      EXPECT_EQ(intersection(a, a).kind, Intersection::plane);
      EXPECT_EQ(intersection<double>(a, -a).kind, Intersection::plane);
    }
  }
  EXPECT_EQ(intersection(Plane(), Plane()).kind, Intersection::plane);
}

// The point is in all three; with the planes' normals as rows, its uncertainty is that of linear equations.
TEST(ThreePlanes, MeetInAPoint) {
  Random random(10);
  for (const double size : sizes) {
    for (int i = 0; i < 500; ++i) {
      const Vector3 p = size * random.vector(), n = random.direction();
      const double angle = i % 2 == 0 ? 1.0 : 1e-5;
      const Plane a = plane_at(p, n), b = plane_at(p, tilted(n, angle, random)),
                  c = plane_at(p, tilted(n, -angle, random));
      Matrix3 normals;
      normals << a.normal.transpose(), b.normal.transpose(), c.normal.transpose();
      const double volume = std::abs(normals.determinant());
      if (volume < 0.05 * angle * angle) continue;
      const auto triple = intersection(a, b, c);
      ASSERT_EQ(triple.kind, Intersection::point);
      EXPECT_FALSE(triple.line);
      EXPECT_LE(length(*triple.point - p) / size, 8 * eps * 3 / volume);
    }
  }
  const auto corner =
      intersection(plane_at({1, 0, 0}, {1, 0, 0}), plane_at({0, 2, 0}, {0, -1, 0}), plane_at({0, 0, 3}, {0, 0, 1}));
  EXPECT_EQ(*corner.point, Vector3(1, 2, 3));
}

TEST(ThreePlanes, MayHaveALineInCommonOrAPlaneOrNothing) {
  Random random(11);
  for (const double size : sizes) {
    for (int i = 0; i < 300; ++i) {
      const Vector3 u = random.direction(), p = size * random.vector();
      const Vector3 n = tangents<double>(u).col(0), m = rotation_about<double>(u, random.between(0.5, 1)) * n,
                    k = rotation_about<double>(u, random.between(-1, -0.5)) * n;
      const IncidenceTolerance rounded{16 * eps, 64 * eps * size};
      const Plane a = plane_at(p, n), b = plane_at(p, m), c = plane_at(p, k), beside = plane_at(p + size * n, k),
                  over = plane_at(p + size * n, n);
      // The leaves of a book.
      const auto book = intersection(a, b, c, rounded);
      ASSERT_EQ(book.kind, Intersection::line);
      EXPECT_LE(distance(*book.line, p) / size, 64 * eps);
      EXPECT_EQ(intersection(a, b, a).kind, Intersection::line);
      EXPECT_EQ(intersection<double>(a, -a, b).kind, Intersection::line);
      // A prism.
      EXPECT_EQ(intersection(a, b, beside, rounded).kind, Intersection::none);
      // Two or three are parallel.
      EXPECT_EQ(intersection(a, over, b, rounded).kind, Intersection::none);
      EXPECT_EQ(intersection(b, over, a, rounded).kind, Intersection::none);
      EXPECT_EQ(intersection(over, a, a).kind, Intersection::none);
      EXPECT_EQ(intersection(a, a, over).kind, Intersection::none);
      EXPECT_EQ(intersection(a, a, a).kind, Intersection::plane);
    }
  }
}

// All answers move with the frame.
TEST(Intersections, DoNotDependOnTheFrame) {
  Random random(12);
  for (int i = 0; i < 500; ++i) {
    const Pose x{random.rotation(), random.vector()};
    const Vector3 p = random.vector(), n = random.direction();
    const Plane a = plane_at(p, n), b = plane_at(random.vector(), tilted(n, random.between(0.3, 2.8), random));
    const Line line = line_at(random.vector(), tilted(n, random.between(0, 1.2), random));
    const auto pair = intersection(a, b), moved = intersection(transformed(x, a), transformed(x, b));
    const Line expected = transformed(x, *pair.line);
    const double tolerance = 8 * eps * 4 / std::sin(0.3);
    EXPECT_LE((moved.line->direction - expected.direction).norm(), tolerance);
    EXPECT_LE((moved.line->moment - expected.moment).norm(), tolerance * (1 + expected.moment.norm()));
    const Vector3 point = intersection(a, line).point;
    EXPECT_LE((intersection(transformed(x, a), transformed(x, line)).point - x * point).norm(),
              8 * eps * 4 / std::cos(1.2) * (1 + point.norm()));
    EXPECT_NEAR(dihedral_angle(transformed(x, a), transformed(x, b)), dihedral_angle(a, b), 16 * eps);
    EXPECT_NEAR(inclination(transformed(x, a), transformed(x, line)), inclination(a, line), 16 * eps);
  }
}

// A plane that rises at a rate, cut by a line at rest: the point runs along the line, by the rate over the sine.
TEST(Intersections, KnowOtherNumbers) {
  Random random(13);
  for (int i = 0; i < 200; ++i) {
    const Vector3 n = random.direction(), u = tilted(n, random.between(0, 1.2), random);
    const Vector3T<D> normal = dual(n, Vector3::Zero());
    const PlaneT<D> rising{normal, D(random.between(-1, 1), 1)};
    const LineT<D> line{dual(u, Vector3::Zero()), dual(random.vector().cross(u), Vector3::Zero())};
    const auto meeting = intersection(rising, line);
    ASSERT_EQ(meeting.kind, Intersection::point);
    EXPECT_LE((dual_part(meeting.point) - u / u.dot(n)).norm(), 16 * eps / std::cos(1.2));
  }
  const auto plane = plane_through_points<Long>({0, 0, 2}, {1, 0, 2}, {0, 1, 2});
  EXPECT_EQ(plane->normal, Vector3T<Long>::UnitZ());
  EXPECT_EQ(plane->offset, 2);
  EXPECT_EQ(intersection(PlaneT<D>(), PlaneT<D>(), PlaneT<D>()).kind, Intersection::plane);
}

}  // namespace
}  // namespace koppel::test
