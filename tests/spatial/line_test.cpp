// Lines: their moment, points beside them, and what lies between two of them, in general and in every special position.
#include "spatial/line.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "directions.hpp"

namespace koppel::test {
namespace {

using Long = long double;
using D = Dual<double>;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double pi = std::numbers::pi;
constexpr std::array<double, 5> sizes{1e-160, 1e-9, 1.0, 1e9, 1e150};

Line line_at(const Vector3& point, const Vector3& direction) { return *line_through<double>(point, direction); }
Pose random_pose(Random& random) { return {random.rotation(), random.vector()}; }
double length(const Vector3& v) {
  const auto p = polar<double>(v);
  return p ? p->length : 0.0;
}

// Checks K-I-6.2.1. The points are rounded by half a unit each, moment and nearest point by two at their sizes.
TEST(Line, MomentDoesNotDependOnThePoint) {
  Random random(1);
  for (const double size : sizes) {
    for (int i = 0; i < 200; ++i) {
      const Vector3 p = size * random.vector(), u = random.direction();
      const Line line = line_at(p, random.between(0.1, 9) * u);
      const Line other = line_at(p + size * random.between(-9, 9) * u, u);
      EXPECT_LE((other.direction - line.direction).norm(), 4 * eps);
      EXPECT_LE(length(other.moment - line.moment), 4 * eps * 12 * size) << "12: the farthest point";
      EXPECT_LE(std::abs(line.direction.norm() - 1), 2 * eps);
      EXPECT_LE(std::abs(line.direction.dot(line.moment)), 4 * eps * 2 * size);
      const Vector3 nearest = line.nearest_to_origin();
      EXPECT_LE(length(nearest.cross(line.direction) - line.moment), 8 * eps * 2 * size) << "is on the line";
      EXPECT_LE(std::abs(nearest.dot(line.direction)), 4 * eps * 2 * size) << "and the nearest";
    }
  }
}

// Checks K-I-6.2.1.
TEST(Line, IsADualUnitVector) {
  Random random(2);
  const Line line = line_at(random.vector(), random.direction());
  const Vector3T<D> l = line.dual();
  EXPECT_NEAR(l.dot(l).real, 1, 4 * eps);
  EXPECT_NEAR(l.dot(l).dual, 0, 8 * eps);
  EXPECT_EQ(Line::of_dual(l).direction, line.direction);
  EXPECT_EQ(Line::of_dual(l).moment, line.moment);
  const Line back = -line;
  EXPECT_EQ(back.direction, -line.direction);
  EXPECT_EQ(back.nearest_to_origin(), line.nearest_to_origin());
}

// Checks K-I-6.2.1.
TEST(Line, NeedsADirection) {
  const Vector3 p(1, 2, 3), none = Vector3::Zero();
  EXPECT_FALSE(line_through<double>(p, none));
  EXPECT_FALSE(line_through<double>(p, Vector3(0, infinity, 0)));
  EXPECT_FALSE(line_through<double>(p, Vector3(0, std::nan(""), 0)));
  EXPECT_FALSE(line_through_points<double>(p, p));
  const Line z = *line_through_points<double>(none, Vector3(0, 0, 1e-200));
  EXPECT_EQ(z.direction, Vector3::UnitZ());
  EXPECT_EQ(Line().moment, none) << "without data, the z axis";
  EXPECT_EQ(Line().direction, Vector3::UnitZ());
}

// Checks K-I-6.2.1.
TEST(Line, MovesWithItsPoints) {
  Random random(3);
  for (const double size : sizes) {
    for (int i = 0; i < 200; ++i) {
      const Pose x{random.rotation(), size * random.vector()};
      const Vector3 p = size * random.vector(), q = size * random.vector();
      const Line line = *line_through_points<double>(p, q), moved = transformed(x, line);
      const Line expected = *line_through_points<double>(x * p, x * q);
      // The points of the line that is expected are rounded at four sizes; their direction, over their distance.
      const double condition = 1 + 4 * size / length(q - p);
      EXPECT_LE((moved.direction - expected.direction).norm(), 4 * eps * condition);
      EXPECT_LE(length(moved.moment - expected.moment), 8 * eps * 4 * size * condition);
      EXPECT_LE(length(transformed(x.inverse(), moved).moment - line.moment), 8 * eps * 4 * size);
    }
  }
}

// Checks K-I-6.2.1.
TEST(Line, HasAFootOfThePerpendicularFromEveryPoint) {
  Random random(4);
  for (const double size : sizes) {
    for (int i = 0; i < 200; ++i) {
      const Vector3 on = size * random.vector(), u = random.direction(), across = tangents<double>(u).col(i % 2);
      const double height = size * random.between(0, 1);
      const Line line = line_at(on, u);
      const Vector3 p = on + height * across;
      EXPECT_LE(length(foot_point(line, p) - on), 16 * eps * 3 * size);
      EXPECT_NEAR(distance(line, p) / size, height / size, 16 * eps * 3);
      EXPECT_LE(distance(line, on) / size, 16 * eps * 2);
    }
  }
  EXPECT_EQ(distance(Line(), Vector3(3, 4, 1e9)), 5);
  EXPECT_EQ(distance(Line(), Vector3(0, 0, 7)), 0);
}

// Checks K-I-6.2.3c. The reference is the cross product in long double: 64 digits, of which 1e-15 leaves 14.
TEST(CrossOfUnits, HasAllDigitsNearParallelAndNearOpposite) {
  Random random(5);
  for (const double off : {1.0, 1e-3, 1e-8, 1e-12, 3e-15}) {
    for (int i = 0; i < 400; ++i) {
      const Vector3 a = random.direction();
      const Vector3 b = (i % 2 == 0 ? 1 : -1) * (a + off * random.direction()).normalized();
      const Vector3T<Long> exact = a.cast<Long>().cross(b.cast<Long>());
      const Vector3 c = cross_of_units(a, b);
      const auto sine = static_cast<double>(exact.norm());
      EXPECT_LE(static_cast<double>((c.cast<Long>() - exact).norm()), 4 * eps * sine + 1e-19);
      EXPECT_LE(std::abs(c.dot(a)), 4 * eps * sine + 1e-32);
      EXPECT_LE(std::abs(c.dot(b)), 4 * eps * sine + 1e-32);
    }
  }
}

// Checks K-I-6.2.3c.
TEST(LinePair, OfTheXAxisAndALineAboveParallelToY) {
  const LinePair pair = line_pair(line_at({0, 0, 0}, Vector3::UnitX()), line_at({0, 0, 2}, Vector3::UnitY()));
  EXPECT_EQ(pair.relation, LineRelation::skew);
  EXPECT_EQ(pair.angle, pi / 2);
  EXPECT_EQ(pair.distance, 2);
  ASSERT_TRUE(pair.normal);
  EXPECT_EQ(pair.normal->direction, Vector3::UnitZ());
  EXPECT_EQ(pair.normal->moment, Vector3::Zero());
  EXPECT_EQ(pair.foot_1, Vector3::Zero());
  EXPECT_EQ(pair.foot_2, Vector3(0, 0, 2));
  EXPECT_EQ(pair.dual_angle(), D(pi / 2, 2));
  const LinePair below = line_pair(line_at({0, 0, 0}, Vector3::UnitX()), line_at({0, 0, -2}, Vector3::UnitY()));
  EXPECT_EQ(below.distance, -2) << "the normal is along e1 x e2, and the distance has a sign";
  EXPECT_EQ(below.normal->direction, Vector3::UnitZ());
}

/// Two lines built from the dual angle, the line of the normal, and the place of the feet on it.
struct Known {
  Known(Random& random, double size)
      : angle(random.between(0.1, pi - 0.1)), distance(size * random.between(-1, 1)), n(random.direction()) {
    foot_1 = size * random.vector();
    foot_2 = foot_1 + distance * n;
    const Vector3 e1 = tangents<double>(n).col(0);
    line_1 = line_at(foot_1 + size * random.between(-1, 1) * e1, e1);
    const Vector3 e2 = rotation_about<double>(n, angle) * e1;
    line_2 = line_at(foot_2 + size * random.between(-1, 1) * e2, e2);
  }
  double angle, distance;
  Vector3 n, foot_1, foot_2;
  Line line_1, line_2;
};

/// What rounding can do to feet and distance: every position is rounded at the size of the farthest, some sixteen times
/// by half a unit, and directions off by rounding meet elsewhere, by their distance from the origin over the sine.
double uncertainty(double size, double angle) { return 8 * eps * size / std::sin(angle); }

// Checks K-I-6.2.3b, K-I-6.2.3c.
TEST(LinePair, HasTheDualAngleAndTheNormalThatItWasBuiltWith) {
  Random random(6);
  for (const double size : sizes) {
    for (int i = 0; i < 500; ++i) {
      const Known known(random, size);
      const LinePair pair = line_pair(known.line_1, known.line_2);
      const double tolerance = uncertainty(3, known.angle);  // the lines are up to three sizes from the origin
      ASSERT_EQ(pair.relation, LineRelation::skew);
      EXPECT_NEAR(pair.angle, known.angle, 8 * eps);
      EXPECT_NEAR(pair.distance / size, known.distance / size, tolerance);
      EXPECT_LE(length(pair.foot_1 - known.foot_1) / size, tolerance);
      EXPECT_LE(length(pair.foot_2 - known.foot_2) / size, tolerance);
      EXPECT_LE((pair.normal->direction - known.n).norm(), 8 * eps / std::sin(known.angle));
      EXPECT_LE(distance(*pair.normal, pair.foot_1) / size, tolerance);
      EXPECT_LE(distance(*pair.normal, pair.foot_2) / size, tolerance);
    }
  }
}

// Checks K-I-6.2.3b, K-I-6.2.3c. e1.e2 = cos b - eps d sin b; e1 x e2 = sin(b + eps d) e_n.
TEST(LinePair, SatisfiesTheProductsOfDualVectors) {
  Random random(7);
  for (int i = 0; i < 1000; ++i) {
    const Known known(random, 1);
    const LinePair pair = line_pair(known.line_1, known.line_2);
    const Vector3T<D> l1 = known.line_1.dual(), l2 = known.line_2.dual();
    const D cosine = l1.dot(l2), expected = cos(pair.dual_angle());
    const double tolerance = uncertainty(3, known.angle);
    EXPECT_NEAR(cosine.real, expected.real, 8 * eps);
    EXPECT_NEAR(cosine.dual, expected.dual, tolerance);
    EXPECT_NEAR(expected.dual, -pair.distance * std::sin(pair.angle), 2 * eps);
    const Vector3T<D> normal = pair.normal->dual() * sin(pair.dual_angle()), product = l1.cross(l2);
    EXPECT_LE(real_part(product - normal).norm(), 8 * eps);
    EXPECT_LE(dual_part(product - normal).norm(), tolerance);
  }
}

// Checks K-I-6.2.3c.
// Special positions stay what they are. Directions moved are off by rounding, and positions at four.
TEST(LinePair, KeepsItsNameInEveryFrame) {
  Random random(15);
  const IncidenceTolerance rounded{8 * eps, 32 * eps * 4};
  for (int i = 0; i < 1000; ++i) {
    const Pose x = random_pose(random);
    const Vector3 p = random.vector(), u = random.direction(), n = tangents<double>(u).col(0);
    const Line line = line_at(p, u), parallel = line_at(p + random.between(0.1, 1) * n, i % 2 == 0 ? u : -u),
               same = line_at(p + u, i % 2 == 0 ? u : -u), crossing = line_at(p + u, u + n);
    for (const Line& other : {parallel, same, crossing}) {
      const LinePair pair = line_pair(line, other, rounded);
      const LinePair moved = line_pair(transformed(x, line), transformed(x, other), rounded);
      EXPECT_EQ(moved.relation, pair.relation);
      EXPECT_NEAR(moved.angle, pair.angle, 8 * eps);
      EXPECT_NEAR(moved.distance, pair.distance, 32 * eps * 4);
    }
    EXPECT_EQ(line_pair(line, parallel, rounded).relation, LineRelation::parallel);
    EXPECT_EQ(line_pair(line, same, rounded).relation, LineRelation::coincident);
    EXPECT_EQ(line_pair(line, crossing, rounded).relation, LineRelation::intersecting);
  }
}

/// Feet by going to and fro: the point of line 2 nearest to the last one of line 1, and back. Every round multiplies
/// what is missing by cos^2 of the angle.
struct ToAndFro {
  ToAndFro(const Line& line_1, const Line& line_2, int rounds) {
    const LineT<Long> a{line_1.direction.cast<Long>().normalized(), line_1.moment.cast<Long>()},
        b{line_2.direction.cast<Long>().normalized(), line_2.moment.cast<Long>()};
    for (int i = 0; i < rounds; ++i) {
      foot_2 = foot_point<Long>(b, foot_1);
      foot_1 = foot_point<Long>(a, foot_2);
    }
    distance = static_cast<double>((foot_2 - foot_1).norm());
    angle = static_cast<double>(std::acos(a.direction.dot(b.direction)));
  }
  Vector3T<Long> foot_1 = Vector3T<Long>::Zero(), foot_2 = Vector3T<Long>::Zero();
  double distance, angle;
};

// Checks K-I-6.2.3b, K-I-6.2.3c.
TEST(LinePair, HasTheShortestDistance) {
  Random random(8);
  for (int i = 0; i < 300; ++i) {
    const Known known(random, 1);
    if (std::sin(known.angle) < 0.3) continue;
    const LinePair pair = line_pair(known.line_1, known.line_2);
    const ToAndFro nearest(known.line_1, known.line_2, 500);  // 0.91^500 = 1e-20
    const double tolerance = uncertainty(3, known.angle);
    EXPECT_NEAR(std::abs(pair.distance), nearest.distance, tolerance);
    EXPECT_LE((pair.foot_1 - nearest.foot_1.cast<double>()).norm(), tolerance);
    EXPECT_LE((pair.foot_2 - nearest.foot_2.cast<double>()).norm(), tolerance);
    EXPECT_NEAR(pair.angle, nearest.angle, 8 * eps);
  }
}

// Checks K-I-6.2.3c.
// The same movement takes normal and feet along and leaves angle and distance alone.
TEST(LinePair, DoesNotDependOnTheFrame) {
  Random random(9);
  for (int i = 0; i < 1000; ++i) {
    const Known known(random, 1);
    const Pose x = random_pose(random);
    const LinePair pair = line_pair(known.line_1, known.line_2);
    const LinePair moved = line_pair(transformed(x, known.line_1), transformed(x, known.line_2));
    const double tolerance = uncertainty(5, known.angle);
    EXPECT_EQ(moved.relation, pair.relation);
    EXPECT_NEAR(moved.angle, pair.angle, 16 * eps);
    EXPECT_NEAR(moved.distance, pair.distance, tolerance);
    EXPECT_LE((moved.foot_1 - x * pair.foot_1).norm(), tolerance);
    EXPECT_LE((moved.foot_2 - x * pair.foot_2).norm(), tolerance);
    const Line normal = transformed(x, *pair.normal);
    EXPECT_LE((moved.normal->direction - normal.direction).norm(), 16 * eps / std::sin(known.angle));
    EXPECT_LE((moved.normal->moment - normal.moment).norm(), tolerance);
  }
}

// Checks K-I-6.2.3b, K-I-6.2.3c.
TEST(LinePair, OfLinesThroughAPointHasItAsFeet) {
  Random random(10);
  for (const double size : sizes) {
    for (int i = 0; i < 300; ++i) {
      const Vector3 p = size * random.vector();
      const double angle = random.between(0.1, pi - 0.1);
      const Vector3 n = random.direction(), e1 = tangents<double>(n).col(0), e2 = rotation_about<double>(n, angle) * e1;
      const LinePair pair = line_pair(line_at(p, e1), line_at(p, e2), {rounding_floor<double>(), 32 * eps * size});
      const double tolerance = uncertainty(2, angle);
      ASSERT_EQ(pair.relation, LineRelation::intersecting);
      EXPECT_LE(std::abs(pair.distance) / size, tolerance);
      EXPECT_LE(length(pair.foot_1 - p) / size, tolerance);
      EXPECT_LE(length(pair.foot_2 - p) / size, tolerance);
      EXPECT_LE((pair.normal->direction - n).norm(), 8 * eps / std::sin(angle));
    }
  }
  // At right angles, both parts of the scalar product vanish.
  const Line x = line_at({0, 3, 1}, Vector3::UnitX()), y = line_at({-2, 0, 1}, Vector3::UnitY());
  EXPECT_EQ(x.dual().dot(y.dual()), D(0, 0));
  const LinePair corner = line_pair(x, y);
  EXPECT_EQ(corner.relation, LineRelation::intersecting);
  EXPECT_EQ(corner.dual_angle(), D(pi / 2, 0));
  EXPECT_EQ(corner.foot_1, Vector3(-2, 3, 1));
  EXPECT_EQ(corner.foot_2, Vector3(-2, 3, 1));
  EXPECT_EQ(corner.normal->direction, Vector3::UnitZ());
}

// Checks K-I-6.2.3b, K-I-6.2.3c.
// The dual part of the scalar product is the same at every distance of parallel lines; the vector product has it.
TEST(LinePair, OfParallelLinesHasTheDistanceAndANormalFromOneToTheOther) {
  Random random(11);
  for (const double size : sizes) {
    for (int i = 0; i < 400; ++i) {
      const Vector3 u = random.direction(), p = size * random.vector();
      const Vector3 n = rotation_about<double>(u, random.between(-3, 3)) * tangents<double>(u).col(0);
      const double apart = size * random.between(0.1, 1), sense = i % 2 == 0 ? 1 : -1;
      const Line a = line_at(p, u), b = line_at(p + apart * n + size * random.between(-1, 1) * u, sense * u);
      const LinePair pair = line_pair(a, b);
      const double tolerance = 16 * eps * 3;
      ASSERT_EQ(pair.relation, LineRelation::parallel);
      EXPECT_NEAR(pair.angle, sense > 0 ? 0 : pi, 4 * eps);
      EXPECT_NEAR(pair.distance / size, apart / size, tolerance);
      ASSERT_TRUE(pair.normal);
      EXPECT_LE((pair.normal->direction - n).norm(), tolerance * size / apart);
      EXPECT_LE(length(pair.foot_1 - a.nearest_to_origin()) / size, tolerance);
      EXPECT_LE(length(pair.foot_2 - b.nearest_to_origin()) / size, tolerance);
      EXPECT_NEAR(a.dual().dot(b.dual()).dual / size, 0, tolerance);
      const Vector3 product = dual_part(a.dual().cross(b.dual()));
      EXPECT_LE(length(sense * product - pair.distance * pair.normal->direction) / size, tolerance);
    }
  }
}

// Checks K-I-6.2.3c.
TEST(LinePair, OfTheSameLineHasNoNormal) {
  Random random(12);
  for (const double size : sizes) {
    for (int i = 0; i < 300; ++i) {
      const Line line = line_at(size * random.vector(), random.direction());
      for (const Line& other : {line, -line}) {
        const LinePair pair = line_pair(line, other);
        ASSERT_EQ(pair.relation, LineRelation::coincident);
        EXPECT_FALSE(pair.normal);
        EXPECT_LE(pair.distance / size, 4 * eps * 2);
        EXPECT_LE(distance(line, pair.foot_1) / size, 8 * eps * 2);
      }
      EXPECT_NEAR(line_pair<double>(line, -line).angle, pi, eps);
      EXPECT_EQ(real_part(line.dual().cross(line.dual())), Vector3(Vector3::Zero()));
    }
  }
  EXPECT_EQ(line_pair(Line(), Line()).relation, LineRelation::coincident);
}

// Checks K-I-6.2.3b, K-I-6.2.3c. The reference: other formulas, by reciprocal product and moments, in long double.
TEST(LinePair, OfNearlyParallelLinesIsExactToRoundingAtTheDistanceOfTheFeet) {
  Random random(13);
  for (const double off : {1e-3, 1e-7, 1e-10, 1e-13}) {
    for (int i = 0; i < 300; ++i) {
      const Vector3 u = random.direction();
      const Line a = line_at(random.vector(), u);
      const Line b = line_at(random.vector(), (i % 2 == 0 ? 1 : -1) * (u + off * random.direction()));
      const LinePair pair = line_pair(a, b);
      const Vector3T<Long> e1 = a.direction.cast<Long>(), e2 = b.direction.cast<Long>(),
                           c = e1.cross(i % 2 == 0 ? Vector3T<Long>(e2 - e1) : Vector3T<Long>(e2 + e1)),
                           m1 = a.moment.cast<Long>(), m2 = b.moment.cast<Long>();
      const Long sine = c.norm();
      if (sine < 0.1L * off) continue;  // the random change was along u
      ASSERT_NE(pair.relation, LineRelation::parallel);
      EXPECT_NEAR(pair.angle, static_cast<double>(std::atan2(sine, e1.dot(e2))), 4 * eps);
      const Vector3T<Long> n = c / sine, apart = e2.cross(m2) - e1.cross(m1);
      const Long d = -(e1.dot(m2) + e2.dot(m1)) / sine, t = apart.cross(e2).dot(n) / sine;
      const double tolerance = 4 * eps * 4 / static_cast<double>(sine);
      EXPECT_NEAR(pair.distance, static_cast<double>(d), tolerance);
      EXPECT_LE(static_cast<double>((pair.foot_1.cast<Long>() - e1.cross(m1) - t * e1).norm()), tolerance);
      EXPECT_LE(distance(a, pair.foot_1), tolerance);
      EXPECT_LE(distance(b, pair.foot_2), tolerance);
      EXPECT_LE((pair.normal->direction.cast<Long>() - n).norm(), 8 * eps);
    }
  }
}

// Checks K-I-6.2.3b. Lines close together and nearly parallel, but far from the origin: what is left of their moments
// is uncertain by rounding there, and that is not divided by the sine, as it is in d = -(e1.m2 + e2.m1) / sin b.
TEST(LinePair, FarFromTheOriginLosesNoMoreThanThePositionsDo) {
  Random random(16);
  constexpr double far = 1e6, off = 1e-4;
  double other_way = 0;
  for (int i = 0; i < 300; ++i) {
    const Vector3 u = random.direction(), p = far * tangents<double>(u).col(0);
    const Line a = line_at(p, u), b = line_at(p + random.vector(), u + off * random.direction());
    const LinePair pair = line_pair(a, b);
    const auto exact = line_pair<Long>({a.direction.cast<Long>(), a.moment.cast<Long>()},
                                       {b.direction.cast<Long>(), b.moment.cast<Long>()});
    const double tolerance = 8 * eps * far;
    EXPECT_NEAR(pair.distance, static_cast<double>(exact.distance), tolerance);
    const double moments = -(a.direction.dot(b.moment) + b.direction.dot(a.moment)) / std::sin(pair.angle);
    other_way = std::max(other_way, std::abs(moments - static_cast<double>(exact.distance)) / tolerance);
  }
  EXPECT_GT(other_way, 10) << "the way not to do it";
}

// Checks K-I-6.2.3c. The caller may know better what is meant to be parallel, or to meet.
TEST(LinePair, IsNamedByTheTolerance) {
  const Line z, tilted = line_at({0, 1, 0}, {1e-9, 0, 1}), near = line_at({1e-7, 0, 0}, Vector3::UnitY());
  EXPECT_EQ(line_pair(z, tilted).relation, LineRelation::skew);
  EXPECT_NEAR(line_pair(z, tilted).angle, 1e-9, 1e-9 * eps);
  const LinePair loosely = line_pair<double>(z, tilted, {1e-8, 0});
  EXPECT_EQ(loosely.relation, LineRelation::parallel);
  EXPECT_NEAR(loosely.angle, 1e-9, 1e-9 * eps) << "the angle is what it is";
  EXPECT_NEAR(loosely.distance, 1, eps);
  EXPECT_EQ(line_pair<double>(z, tilted, {1e-8, 2}).relation, LineRelation::coincident);
  EXPECT_EQ(line_pair(z, near).relation, LineRelation::skew);
  const LinePair meeting = line_pair<double>(z, near, {rounding_floor<double>(), 1e-6});
  EXPECT_EQ(meeting.relation, LineRelation::intersecting);
  EXPECT_NEAR(meeting.distance, -1e-7, 1e-7 * eps);
  // By themselves, lines are judged by their sizes: a gap of 1e-12 m counts near the origin, and nowhere else.
  const auto gap = [](double z0, double y0) {
    return line_pair(line_at({0, y0, z0}, Vector3::UnitX()), line_at({0, y0, z0 + 1e-12}, Vector3::UnitY())).relation;
  };
  EXPECT_EQ(gap(0, 0), LineRelation::skew);
  EXPECT_EQ(gap(1, 1), LineRelation::skew);
  EXPECT_EQ(gap(0, 1e6), LineRelation::intersecting);
}

// Checks K-I-6.2.3b. Line 2 moved by a screw about the common normal changes the dual angle by the screw's rates;
// moved by screws about either line it keeps it.
TEST(LinePair, CarriesTheRatesOfTheDualAngle) {
  Random random(14);
  for (int i = 0; i < 300; ++i) {
    const Known known(random, 1);
    const LineT<D> a{known.line_1.direction.unaryExpr([](double v) { return D(v); }),
                     known.line_1.moment.unaryExpr([](double v) { return D(v); })};
    const D rate(random.between(-1, 1), random.between(-1, 1));
    const auto rate_about = [&](const Line& axis) {
      // The rate of a line carried by the screw s is s x l.
      const Vector3T<D> s = axis.dual() * rate, change = s.cross(known.line_2.dual());
      const LineT<D> b{dual(known.line_2.direction, real_part(change)), dual(known.line_2.moment, dual_part(change))};
      const auto pair = line_pair<D>(a, b);
      return D(pair.angle.dual, pair.distance.dual);
    };
    const double tolerance = uncertainty(3, known.angle) / std::sin(known.angle);
    const D about_normal = rate_about({known.n, known.foot_1.cross(known.n)});
    EXPECT_NEAR(about_normal.real, rate.real, 16 * eps / std::sin(known.angle));
    EXPECT_NEAR(about_normal.dual, rate.dual, tolerance);
    for (const Line& axis : {known.line_1, known.line_2}) {
      EXPECT_NEAR(rate_about(axis).real, 0, 16 * eps / std::sin(known.angle));
      EXPECT_NEAR(rate_about(axis).dual, 0, tolerance);
    }
  }
}

// Checks K-I-6.2.1, K-I-6.2.3c.
TEST(LinePair, KnowsOtherNumbers) {
  const LineT<Long> a = *line_through_points<Long>({0, 0, 0}, {1, 0, 0}), b = *line_through<Long>({0, 0, 2}, {0, 3, 0});
  const auto pair = line_pair<Long>(a, b);
  EXPECT_EQ(pair.distance, 2);
  EXPECT_EQ(pair.angle, std::atan2(Long(1), Long(0)));
  // Parallel lines of dual numbers: the roots and angles without derivative do no harm.
  const auto same = line_pair(LineT<D>(), LineT<D>());
  EXPECT_EQ(same.relation, LineRelation::coincident);
  EXPECT_TRUE(isfinite(same.angle) && isfinite(same.distance));
}

}  // namespace
}  // namespace koppel::test
