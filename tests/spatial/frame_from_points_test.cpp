// Frames from three points: axes, thin triangles, and points that define none.
#include "spatial/frame_from_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "directions.hpp"

namespace koppel::test {
namespace {

using Long = long double;
using D = Dual<double>;
constexpr double eps = std::numeric_limits<double>::epsilon();

FrameFromPoints frame_of(const Vector3& p, const Vector3& q, const Vector3& r) {
  return frame_from_points<double>(p, q, r);
}

// Checks K-I-2.1.4.
TEST(FrameFromPoints, HasZAlongTheFirstEdgeAndXTowardsTheThirdPoint) {
  const FrameFromPoints frame = frame_of({0, 0, 0}, {0, 0, 2}, {3, 0, 5});
  EXPECT_EQ(frame.kind, PointsKind::regular);
  EXPECT_EQ(frame.rotation, Matrix3::Identity());
  EXPECT_NEAR(frame.sine, 3 / std::sqrt(34.0), 2 * eps);
}

// Checks K-I-2.1.4. Exact for the edges as stored; they are sums of two sizes.
TEST(FrameFromPoints, IsOrthonormalAndHoldsTheThirdPointInItsPlane) {
  Random random(1);
  for (const double size : {1e-160, 1e-9, 1.0, 1e9, 1e150}) {
    for (int i = 0; i < 300; ++i) {
      const Vector3 p = size * random.vector(), q = size * random.vector(), r = size * random.vector();
      const FrameFromPoints frame = frame_of(p, q, r);
      ASSERT_EQ(frame.kind, PointsKind::regular);
      const Matrix3& t = frame.rotation;
      EXPECT_LE(orthonormality_residual(t), 6 * eps);
      EXPECT_GT(t.determinant(), 0);
      const Vector3 edge = (r - p) / size, z = (q - p) / size;
      EXPECT_LE(std::abs(t.col(1).dot(edge)), 4 * eps * edge.norm());
      EXPECT_GT(t.col(0).dot(edge), 0) << "on the side of positive x";
      EXPECT_LE((t.col(2) * z.norm() - z).norm(), 4 * eps * z.norm());
      EXPECT_NEAR(frame.sine, edge.cross(z).norm() / (edge.norm() * z.norm()), 8 * eps);
    }
  }
}

// Checks K-I-2.1.4. The frame moves with the points.
TEST(FrameFromPoints, TurnsWithThePoints) {
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    const Pose x{random.rotation(), random.vector()};
    const Vector3 p = random.vector(), q = random.vector(), r = random.vector();
    const FrameFromPoints frame = frame_of(p, q, r), moved = frame_of(x * p, x * q, x * r);
    // Points moved are rounded at four, which the shorter edge and the height over the first edge see.
    const double height = std::min({(q - p).norm(), (r - p).norm(), frame.sine * (r - p).norm()});
    EXPECT_LE((moved.rotation - x.rotation * frame.rotation).norm(), 8 * eps * 4 / height);
  }
}

// Checks K-I-2.1.4. However thin the triangle is, the axes stay orthonormal, and the measured sine has its digits.
TEST(FrameFromPoints, OfAThinTriangleIsOrthonormalAndWarnedOf) {
  Random random(3);
  for (const double off : {1e-2, 2e-6, 5e-7, 1e-9, 1e-12, 1e-14}) {
    for (int i = 0; i < 300; ++i) {
      const Vector3 z = random.direction(), across = tangents<double>(z).col(0);
      const Vector3 p = Vector3::Zero(), r = random.between(0.5, 1) * (i % 2 == 0 ? 1 : -1) * z + off * across;
      const FrameFromPoints frame = frame_of(p, z, r);
      ASSERT_TRUE(frame.has_frame());
      EXPECT_EQ(frame.kind, frame.sine < 1e-6 ? PointsKind::nearly_collinear : PointsKind::regular);
      EXPECT_LE(orthonormality_residual(frame.rotation), 6 * eps);
      const Vector3T<Long> a = z.cast<Long>(), b = r.cast<Long>();
      const auto sine = static_cast<double>(a.cross(b).norm() / (a.norm() * b.norm()));
      EXPECT_NEAR(frame.sine, sine, 4 * eps) << "of edges rounded to unit length";
      EXPECT_NEAR(frame.rotation.col(1).dot(r), 0, 4 * eps);
    }
  }
  EXPECT_EQ(frame_of({0, 0, 0}, {0, 0, 1}, {0.99e-6, 0, 1}).kind, PointsKind::nearly_collinear);
  EXPECT_EQ(frame_of({0, 0, 0}, {0, 0, 1}, {1.01e-6, 0, 1}).kind, PointsKind::regular);
}

// Checks K-I-2.1.4.
TEST(FrameFromPoints, NeedsThreePointsThatAreNotInLine) {
  Random random(4);
  for (const double size : {1e-160, 1e-9, 1.0, 1e9, 1e150}) {
    for (int i = 0; i < 100; ++i) {
      const Vector3 p = size * random.vector(), edge = size * random.direction();
      const Vector3 none = Vector3::Zero();
      for (const auto& [q, r] :
           {std::array{p, Vector3(p + edge)}, std::array{Vector3(p + edge), p}, std::array{p, p}}) {
        EXPECT_EQ(frame_of(p, q, r).kind, PointsKind::coincident);
        EXPECT_EQ(frame_of(p, q, r).sine, 0);
      }
      for (const double part : {1.0, 0.5, -1.0, 2.0}) {
        const FrameFromPoints line = frame_of(none, edge, part * edge);
        EXPECT_EQ(line.kind, PointsKind::collinear);
        EXPECT_EQ(line.sine, 0);
        EXPECT_EQ(line.rotation, Matrix3::Identity());
        EXPECT_FALSE(line.has_frame());
      }
    }
  }
}

// Checks K-I-2.1.4. Points in line, far from the origin in coordinates that are rounded there: that they are not quite
// in line any more says nothing.
TEST(FrameFromPoints, DoesNotTakeTheRoundingOfCoordinatesForATriangle) {
  Random random(5);
  int off_line = 0;
  for (const double far : {1e3, 1e6, 1e9}) {
    for (int i = 0; i < 300; ++i) {
      const Vector3 p = far * random.vector() + Vector3(far, 0, 0), edge = random.direction();
      const FrameFromPoints frame = frame_of(p, p + edge, p + random.between(0.5, 1) * edge);
      EXPECT_EQ(frame.kind, PointsKind::collinear);
      EXPECT_LE(frame.sine, 4 * eps * 4 * far);
      if (frame.sine > rounding_floor<double>()) ++off_line;
    }
  }
  EXPECT_GT(off_line, 800) << "or the test says nothing";
  EXPECT_EQ(frame_of({1e9, 0, 0}, {1e9, 0, 1}, {1e9 + 1, 0, 0}).rotation, Matrix3::Identity());
  EXPECT_EQ(frame_of({1, 1, 1}, {1, 1, 1 + 2 * eps}, {2, 1, 1}).kind, PointsKind::coincident);
}

// Checks K-I-2.1.4. Turned as a whole at the rate w, the axes have the rates w x e.
TEST(FrameFromPoints, KnowsOtherNumbers) {
  EXPECT_EQ(frame_from_points<Long>({0, 0, 0}, {0, 0, 2}, {3, 0, 5}).rotation, Matrix3T<Long>::Identity());
  Random random(6);
  for (int i = 0; i < 300; ++i) {
    const Vector3 w = random.vector();
    const auto turning = [&](const Vector3& p) { return Vector3T<D>(dual(p, w.cross(p))); };
    const Vector3 p = random.vector(), q = random.vector(), r = random.vector();
    const auto frame = frame_from_points<D>(turning(p), turning(q), turning(r));
    const Matrix3 expected = skew(w) * real_part(frame.rotation);
    const double height = std::min({(q - p).norm(), (r - p).norm(), frame.sine.real * (r - p).norm()});
    EXPECT_LE((dual_part(frame.rotation) - expected).norm(), 8 * eps * 4 / height);
    EXPECT_NEAR(frame.sine.dual, 0, 8 * eps * 4 / height);
  }
  EXPECT_EQ(frame_from_points<D>({0, 0, 0}, {0, 0, 1}, {0, 0, 2}).kind, PointsKind::collinear);
}

}  // namespace
}  // namespace koppel::test
