// Dual vectors: taken apart into line, size and pitch and put together again; sums, products, coordinates; the
// velocities, accelerations and forces of bodies among them.
#include "spatial/screw.hpp"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "directions.hpp"

namespace koppel::test {
namespace {

using D = Dual<double>;
using DualVector = Vector3T<D>;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// a + eps (r x a + h a)
DualVector screw_through(const Vector3& point, const Vector3& a, double pitch) {
  return dual(a, point.cross(a) + pitch * a);
}
DualVector line_through_point(const Vector3& point, const Vector3& direction) {
  return screw_through(point, direction, 0);
}

double real_apart(const DualVector& a, const DualVector& b) { return real_part(a - b).cwiseAbs().maxCoeff(); }
double dual_apart(const DualVector& a, const DualVector& b) { return dual_part(a - b).cwiseAbs().maxCoeff(); }

// Checks K-I-6.2.2. Lengths below two metres: four operations on the way to line and pitch, as many back.
TEST(Screw, TakenApartAndPutTogetherIsTheSame) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 a = random.between(0.1, 2) * random.direction(), point = random.vector();
    const double pitch = random.between(-1, 1);
    const DualVector v = screw_through(point, a, pitch);
    const Screw s = screw_of(v, 1.0);
    ASSERT_EQ(s.kind, ScrewKind::screw);
    EXPECT_LE(real_apart(s.dual(), v), 2 * eps * a.norm());
    EXPECT_LE(dual_apart(s.dual(), v), 16 * eps * a.norm());
    EXPECT_NEAR(s.pitch(), pitch, 16 * eps);
    EXPECT_NEAR(s.pitch(), real_part(v).dot(dual_part(v)) / real_part(v).squaredNorm(), 16 * eps);
    EXPECT_LE((s.axis.direction - a.normalized()).norm(), 4 * eps);
    EXPECT_LE((s.axis.moment - point.cross(s.axis.direction)).norm(), 16 * eps) << "the line through the point";
    EXPECT_NEAR(s.axis.direction.dot(s.axis.moment), 0, 4 * eps);
  }
}

// Checks K-I-6.2.2. The dual magnitude is the root of the scalar product with itself, a + eps a.a' / a.
TEST(Screw, MagnitudeIsTheDualLength) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const DualVector v = dual(random.direction(), random.vector());
    const D length = sqrt(v.dot(v)), magnitude = screw_of(v, 1.0).magnitude;
    EXPECT_NEAR(magnitude.real, length.real, 4 * eps);
    EXPECT_NEAR(magnitude.dual, length.dual, 16 * eps);
  }
}

// Checks K-I-6.2.2.
TEST(Screw, KindsAreToldApartByTheLengthWhateverTheSize) {
  const Vector3 u(0, 0, 1), across(3, 4, 0), none = Vector3::Zero();
  for (const double scale : {1e-300, 1e-160, 1.0, 1e150}) {
    const auto kind = [&](const Vector3& real, const Vector3& moment, double length) {
      return screw_of<double>(dual(scale * real, scale * moment), length).kind;
    };
    EXPECT_EQ(kind(none, none, 1), ScrewKind::zero);
    EXPECT_EQ(kind(none, across, 1), ScrewKind::free_vector);
    EXPECT_EQ(kind(u, none, 1), ScrewKind::line);
    EXPECT_EQ(kind(u, across, 1), ScrewKind::line);
    EXPECT_EQ(kind(u, across + u, 1), ScrewKind::screw);
    EXPECT_EQ(kind(u, u, 1), ScrewKind::screw);
    // A line 1e17 m away is none for a machine of a metre, but may be for a planet's orbit.
    EXPECT_EQ(kind(1e-17 * u, across, 1), ScrewKind::free_vector);
    EXPECT_EQ(kind(1e-17 * u, across, 1e12), ScrewKind::line);
    // A pitch of 1e-17 m is none for a machine of a metre, but may be for a molecule.
    EXPECT_EQ(kind(u, 1e-17 * u, 1), ScrewKind::line);
    EXPECT_EQ(kind(u, 1e-17 * u, 1e-9), ScrewKind::screw);
    EXPECT_EQ(kind(u, across + 1e-16 * u, 1e-9), ScrewKind::line) << "rounding, beside the distance of the line";
  }
}

// Checks K-I-6.2.2. Every kind is put together again from magnitude and axis, at every size of the numbers.
TEST(Screw, OfEveryKindIsPutTogetherAgain) {
  const Vector3 u(0.6, 0, 0.8), none = Vector3::Zero();
  for (const double scale : {1e-300, 1e-160, 1.0, 1e150}) {
    const std::array<DualVector, 4> all{dual(none, none), dual(none, scale * u),
                                        dual(scale * u, scale * Vector3::UnitY()),
                                        dual(scale * u, scale * Vector3(1, 2, 3))};
    const std::array<ScrewKind, 4> kinds{ScrewKind::zero, ScrewKind::free_vector, ScrewKind::line, ScrewKind::screw};
    for (std::size_t i = 0; i < 4; ++i) {
      const Screw s = screw_of(all[i], 1.0);
      EXPECT_EQ(s.kind, kinds[i]);
      EXPECT_LE(real_apart(s.dual(), all[i]), 4 * eps * scale);
      EXPECT_LE(dual_apart(s.dual(), all[i]), 16 * eps * scale);
    }
  }
}

// Checks K-I-6.2.2.
TEST(Screw, WithoutARealPartIsAFreeVector) {
  const Screw couple = screw_of<double>(dual(Vector3::Zero(), Vector3(0, 0, -5)), 1.0);
  EXPECT_EQ(couple.kind, ScrewKind::free_vector);
  EXPECT_EQ(couple.pitch(), infinity);
  EXPECT_EQ(couple.magnitude, D(0, 5));
  EXPECT_EQ(couple.axis.direction, Vector3(0, 0, -1));
  EXPECT_EQ(couple.axis.moment, Vector3::Zero());
  const Screw zero = screw_of<double>(dual(Vector3::Zero(), Vector3::Zero()), 1.0);
  EXPECT_EQ(zero.pitch(), 0);
  EXPECT_EQ(zero.magnitude, D(0, 0));
  EXPECT_EQ(screw_of<double>(dual(Vector3::UnitX(), Vector3::UnitY()), 1.0).pitch(), 0);
}

// Checks K-I-6.2.2.
TEST(Screw, KindsOfMotionsHaveNamesOfTheirOwn) {
  EXPECT_EQ(motion_kind(ScrewKind::zero), MotionKind::rest);
  EXPECT_EQ(motion_kind(ScrewKind::free_vector), MotionKind::translation);
  EXPECT_EQ(motion_kind(ScrewKind::line), MotionKind::rotation);
  EXPECT_EQ(motion_kind(ScrewKind::screw), MotionKind::screw);
}

// Checks K-I-6.2.3a. Two rotations about parallel lines make one about the line that divides their distance by the
// rates.
TEST(DualSum, OfParallelRotationsIsARotationAboutTheWeightedLine) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 e = random.direction(), p = random.vector(), q = random.vector();
    const double w1 = random.between(0.1, 1), w2 = random.between(-0.05, 1);
    const DualVector sum = line_through_point(p, w1 * e) + line_through_point(q, w2 * e);
    const Screw s = screw_of(sum, 1.0);
    ASSERT_EQ(s.kind, ScrewKind::line);
    EXPECT_NEAR(s.magnitude.real, w1 + w2, 4 * eps);
    const Vector3 weighted = (w1 * p + w2 * q) / (w1 + w2);
    EXPECT_LE((s.axis.moment - weighted.cross(e)).norm(), 32 * eps / (w1 + w2));
  }
}

// Checks K-I-6.2.3a.
TEST(DualSum, OfOppositeParallelRotationsIsATranslation) {
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 e = random.direction(), p = random.vector(), q = random.vector();
    const double w = random.between(0.1, 1);
    const Screw s = screw_of<double>(line_through_point(p, w * e) + line_through_point(q, -w * e), 1.0);
    ASSERT_EQ(s.kind, ScrewKind::free_vector);
    const Vector3 velocity = w * (p - q).cross(e);
    EXPECT_LE((s.magnitude.dual * s.axis.direction - velocity).norm(), 16 * eps);
  }
  const Vector3 e(0, 0, 1), p(1, 2, 3);
  EXPECT_EQ(screw_of<double>(line_through_point(p, e) + line_through_point(p, -e), 1.0).kind, ScrewKind::zero);
}

/// Two lines at a dual angle, and the line of their common normal, about and along which it counts.
struct Pair {
  explicit Pair(Random& random)
      : angle(random.between(0.1, 3), random.between(-1, 1)), normal_direction(random.direction()) {
    const Vector3 foot = random.vector(), e1 = tangents<double>(normal_direction).col(0);
    normal = line_through_point(foot, normal_direction);
    first = line_through_point(foot, e1);
    const Vector3 e2 = rotation_about<double>(normal_direction, angle.real) * e1;
    second = line_through_point(foot + angle.dual * normal_direction, e2);
  }
  D angle;
  Vector3 normal_direction;
  DualVector normal, first, second;
};

// Checks K-I-6.2.3b. e1.e2 = cos b - eps d sin b, and for screws times both dual lengths.
TEST(DualScalarProduct, IsTheCosineOfTheDualAngle) {
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const Pair lines(random);
    const D product = lines.first.dot(lines.second), cosine = cos(lines.angle);
    EXPECT_NEAR(product.real, cosine.real, 8 * eps);
    EXPECT_NEAR(product.dual, cosine.dual, 32 * eps);
    EXPECT_NEAR(cosine.dual, -lines.angle.dual * std::sin(lines.angle.real), 2 * eps);
    const D a(2, 0.5), b(-1, 3);
    const D scaled = (lines.first * a).dot(lines.second * b), expected = a * b * cosine;
    EXPECT_NEAR(scaled.real, expected.real, 32 * eps);
    EXPECT_NEAR(scaled.dual, expected.dual, 256 * eps);
  }
}

// Checks K-I-6.2.3c. e1 x e2 = sin(b + eps d) times the line of the common normal.
TEST(DualVectorProduct, IsTheCommonNormal) {
  Random random(6);
  for (int i = 0; i < 1000; ++i) {
    const Pair lines(random);
    const DualVector product = lines.first.cross(lines.second), expected = lines.normal * sin(lines.angle);
    EXPECT_LE(real_apart(product, expected), 8 * eps);
    EXPECT_LE(dual_apart(product, expected), 32 * eps);
  }
  // Parallel lines: a free vector, their distance along the normal.
  const DualVector x = line_through_point({0, 0, 0}, Vector3::UnitX()),
                   above = line_through_point({5, 0, 2}, Vector3::UnitX());
  EXPECT_EQ(real_part(x.cross(above)), Vector3::Zero());
  EXPECT_EQ(dual_part(x.cross(above)), Vector3(0, 0, 2));
  EXPECT_EQ(x.cross(x), DualVector(DualVector::Zero()));
}

// Checks K-I-6.2.4. Three lines through a point; projections on them, and the screw again.
TEST(DualBasis, GivesCoordinatesThatMakeTheScrewAgain) {
  Random random(7);
  for (int i = 0; i < 1000; ++i) {
    const Pose x{random.rotation(), random.vector()};
    const Matrix3T<D> basis = dual_basis(x);
    const DualVector s = dual(random.vector(), random.vector());
    const DualVector coordinates = components<D>(s, basis);
    const DualVector again = basis * coordinates;
    EXPECT_LE(real_apart(again, s), 16 * eps);
    EXPECT_LE(dual_apart(again, s), 64 * eps);
    // Real parts: coordinates of the direction. Dual parts: coordinates of the moment about the lines' common point.
    EXPECT_LE((real_part(coordinates) - x.rotation.transpose() * real_part(s)).norm(), 8 * eps);
    const Vector3 moment = dual_part(s) - x.position.cross(real_part(s));
    EXPECT_LE((dual_part(coordinates) - x.rotation.transpose() * moment).norm(), 32 * eps);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(basis.col(k).dot(s).dual, coordinates[k].dual, 16 * eps) << "projection on line " << k;
    }
  }
}

// Checks K-I-6.5.1.
TEST(VelocityScrew, IsTheTwist) {
  Random random(8);
  const Twist twist{random.vector(), random.vector()};
  const DualVector v = dual_vector(twist);
  EXPECT_EQ(real_part(v), twist.angular);
  EXPECT_EQ(dual_part(v), twist.linear);
  EXPECT_EQ(twist_of_dual(v).vector(), twist.vector());
}

// Checks K-I-6.2.2. Any forces are one force along a line and a couple about it: the central axis.
TEST(ForceScrew, HasItsForceOnTheCentralAxis) {
  Random random(9);
  for (int i = 0; i < 100; ++i) {
    const Wrench wrench{random.vector(), random.direction()};
    const DualVector v = dual_vector(wrench);
    EXPECT_EQ(real_part(v), wrench.force);
    EXPECT_EQ(wrench_of_dual(v).vector(), wrench.vector());
    const Screw s = screw_of(v, 1.0);
    const Vector3 point = s.axis.direction.cross(s.axis.moment);
    const Wrench there = shifted(wrench, point);
    EXPECT_LE((there.moment - s.pitch() * wrench.force).norm(), 32 * eps) << "moment along the force alone";
  }
}

// Checks K-I-6.5.2. With another reference point it becomes what the field of accelerations says; the plain pair does
// not.
TEST(AccelerationScrew, IsADualVector) {
  Random random(10);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 omega = random.vector(), alpha = random.vector(), v = random.vector(), a = random.vector();
    const Vector3 p = random.vector();
    const Twist here{omega, v}, there = shifted(here, p);
    const Vector3 a_there = a + alpha.cross(p) + omega.cross(omega.cross(p));
    const DualVector at_here = acceleration_screw<double>(here, alpha, a);
    const DualVector at_there = acceleration_screw<double>(there, alpha, a_there);
    const Vector3 carried = dual_part(at_here) + alpha.cross(p);
    EXPECT_LE((dual_part(at_there) - carried).norm(), 64 * eps);
    EXPECT_EQ(real_part(at_there), alpha);
    EXPECT_LE((acceleration_at_origin(dual_vector(there), at_there) - a_there).norm(), 32 * eps);
    const Vector3 plain_error = a_there - (a + alpha.cross(p));
    EXPECT_NEAR(plain_error.norm(), omega.cross(omega.cross(p)).norm(), 32 * eps) << "what the plain pair misses";
  }
  // A wheel that turns evenly about its hub: the point above accelerates downwards, though hub and rates have no
  // acceleration.
  const Twist hub{{0, 0, 2}, Vector3::Zero()};
  const Vector3 none = Vector3::Zero();
  EXPECT_EQ(acceleration_screw<double>(hub, none, none), DualVector(DualVector::Zero()));
  const Twist above = shifted<Unnamed, double>(hub, {0, 1, 0});
  EXPECT_EQ(dual_part(acceleration_screw<double>(above, none, {0, -4, 0})), none);
}

// Checks K-I-6.5.2. It is the rate of the velocity screw for a reference point that stays: differentiated by time,
// exactly.
TEST(AccelerationScrew, IsTheRateOfTheVelocityScrew) {
  using DD = Dual<D>;
  Random random(11);
  for (int i = 0; i < 100; ++i) {
    const DD t(D(random.between(-1, 1), 1), D(1));
    // A body that turns about an axis that itself turns, and travels.
    const auto turn = [&](const Vector3& u, const DD& angle) { return rotation_about<DD>(u.cast<DD>(), angle); };
    const Matrix3T<DD> r = turn(random.direction(), t * t) * turn(random.direction(), sin(t));
    const Vector3T<DD> p = random.vector().cast<DD>() * t + random.vector().cast<DD>() * (t * t);
    // Derivatives of first order, each with its own rate.
    const Matrix3T<D> r0 = real_part(r), r1 = dual_part(r);
    const Vector3T<D> omega = axial(r1 * r0.transpose());
    const Vector3T<D> at_origin = dual_part(p) - omega.cross(real_part(p));
    const Vector3 w = real_part(omega), alpha = dual_part(omega), place = real_part(real_part(p));
    const Vector3 a = dual_part(dual_part(p)) - alpha.cross(place) - w.cross(w.cross(place));
    const DualVector screw = acceleration_screw<double>(Twist{w, real_part(at_origin)}, alpha, a);
    EXPECT_LE((dual_part(screw) - dual_part(at_origin)).norm(), 256 * eps);
  }
}

TEST(Screw, ExistsInOtherPrecisionsAndWithDerivatives) {
  const DualVector v = screw_through({1, 2, 3}, {0.3, -0.4, 1.2}, 0.25);
  const auto wide =
      screw_of<long double>(v.unaryExpr([](const D& d) { return Dual<long double>(d.real, d.dual); }), 1.0L);
  EXPECT_EQ(wide.kind, ScrewKind::screw);
  EXPECT_NEAR(static_cast<double>(wide.pitch()), 0.25, 8 * eps);
  // A line that travels with 2 m/s across, while the pitch grows by 3 m/s: parts that are dual themselves, in time.
  const Vector3T<D> e(0, 0, 1), point(D(1, 2), 0, 0);
  const Vector3T<D> moment = point.cross(e) + D(0.5, 3) * e;
  const auto moving = screw_of<D>(dual(e, moment), D(1));
  EXPECT_EQ(moving.pitch(), D(0.5, 3));
  EXPECT_EQ(moving.axis.moment[1], D(-1, -2));
}

}  // namespace
}  // namespace koppel::test
