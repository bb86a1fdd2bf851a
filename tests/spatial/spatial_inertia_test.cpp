// Spatial inertia: that of a body is what its mass points do together, whatever the frame, the order and the units.
#include "spatial/spatial_inertia.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "directions.hpp"
#include "spatial/dual.hpp"

namespace koppel::test {
namespace {

using Long = long double;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr int runs = 100;
constexpr int count = 40;

struct Here {};
struct There {};

/// Random mass points, spread by size about a centre.
std::vector<PointMass> cloud(Random& random, const Vector3& centre, double size, double mass, int points = count) {
  std::vector<PointMass> cloud;
  for (int i = 0; i < points; ++i) {
    const double part = random.between(0.1, 1);
    cloud.push_back({mass * part, centre + size * random.vector()});
  }
  return cloud;
}

SpatialInertia random_body(Random& random) { return inertia_from_points<double>(cloud(random, random.vector(), 1, 1)); }
Pose random_pose(Random& random) { return {random.rotation(), random.vector()}; }
Twist random_twist(Random& random) { return {random.vector(), random.vector()}; }

double total_mass(const std::vector<PointMass>& points) {
  double sum = 0;
  for (const PointMass& p : points) sum += p.mass;
  return sum;
}

/// Compares two bodies with the tolerance for numbers of the size of a body of some mass and extent.
void expect_same(const SpatialInertia& a, const SpatialInertia& b, double tolerance, double mass, double length) {
  EXPECT_LE(std::abs(a.mass - b.mass), tolerance * mass);
  EXPECT_LE((a.centre - b.centre).norm(), tolerance * length);
  EXPECT_LE((a.about_centre - b.about_centre).norm(), tolerance * mass * length * length);
}

// Sums of so many terms round as often: count eps of the sum of the sizes, and a few eps more for each term.
TEST(SpatialInertia, GivesEnergyAndMomentumOfTheMassPoints) {
  Random random(1);
  for (const double size : {1e-12, 1.0, 1e12}) {
    for (int i = 0; i < runs; ++i) {
      const std::vector<PointMass> points = cloud(random, size * random.vector(), size, 3);
      const SpatialInertia body = inertia_from_points<double>(points);
      const Twist twist{random.vector(), size * random.vector()};
      double energy = 0, energy_size = 0, linear_size = 0, angular_size = 0;
      Momentum sum;
      for (const PointMass& p : points) {
        const Vector3 v = velocity_at(twist, p.position);
        energy += 0.5 * p.mass * v.squaredNorm();
        sum = sum + Momentum{p.position.cross(p.mass * v), p.mass * v};
        const double speed = twist.linear.norm() + twist.angular.norm() * p.position.norm();
        energy_size += 0.5 * p.mass * speed * speed;
        linear_size += p.mass * speed;
        angular_size += p.mass * speed * p.position.norm();
      }
      const double tolerance = (count + 24) * eps;
      EXPECT_NEAR(kinetic_energy(body, twist), energy, tolerance * energy_size);
      const Momentum m = momentum(body, twist);
      EXPECT_LE((m.linear - sum.linear).norm(), tolerance * linear_size);
      EXPECT_LE((m.angular - sum.angular).norm(), tolerance * angular_size);
    }
  }
}

TEST(SpatialInertia, IsTheSymmetricMatrixOfTheMomentum) {
  Random random(2);
  for (int i = 0; i < runs; ++i) {
    const SpatialInertia body = random_body(random);
    const Twist twist = random_twist(random);
    const Matrix6 m = body.matrix();
    const double size = m.norm() * twist.vector().norm();
    EXPECT_LE((m * twist.vector() - momentum(body, twist).vector()).norm(), 16 * eps * size);
    EXPECT_LE((m - m.transpose()).norm(), 4 * eps * m.norm());
    EXPECT_NEAR(0.5 * twist.vector().dot(m * twist.vector()), kinetic_energy(body, twist),
                16 * eps * size * twist.vector().norm());
    EXPECT_EQ(Matrix3(m.topLeftCorner<3, 3>()), body.about_origin());
  }
}

TEST(SpatialInertia, AddsWhatSteinersTheoremSays) {
  // A point of 2 kg at (3, 0, 0): nothing about x, 18 kg m^2 about y and z.
  const SpatialInertia point{2, {3, 0, 0}, Matrix3::Zero()};
  EXPECT_EQ(point.about_origin(), Matrix3(Vector3(0, 18, 18).asDiagonal()));
  Random random(3);
  for (int i = 0; i < runs; ++i) {
    const SpatialInertia body = random_body(random);
    const Vector3& c = body.centre;
    const Matrix3 expected =
        body.about_centre + body.mass * (c.squaredNorm() * Matrix3::Identity() - dyad<double>(c, c));
    EXPECT_LE((body.about_origin() - expected).norm(), 8 * eps * expected.norm());
    // And back, where the tensor about the origin is all that is known.
    const SpatialInertia back = inertia_from_tensor_about_origin<double>(body.mass, body.centre, body.about_origin());
    EXPECT_LE((back.about_centre - body.about_centre).norm(), 8 * eps * body.about_origin().norm());
  }
}

TEST(SpatialInertia, LooksTheSameFromEveryFrame) {
  Random random(4);
  for (int i = 0; i < runs; ++i) {
    const std::vector<PointMass> points = cloud(random, random.vector(), 1, 1);
    const Pose x = random_pose(random);
    std::vector<PointMass> seen;
    seen.reserve(points.size());
    for (const PointMass& p : points) seen.push_back({p.mass, x * p.position});
    const SpatialInertia here = inertia_from_points<double>(points), there = transformed(x, here);
    const double mass = total_mass(points);
    expect_same(there, inertia_from_points<double>(seen), (count + 24) * eps, mass, 4);
    expect_same(transformed(x.inverse(), there), here, 32 * eps, mass, 4);

    const Twist twist = random_twist(random), twist_there = transformed(x, twist);
    const double size = mass * (twist.linear.norm() + 4 * twist.angular.norm());
    const double energy_size = size * size / mass;
    EXPECT_NEAR(kinetic_energy(there, twist_there), kinetic_energy(here, twist), 32 * eps * energy_size);
    const Momentum expected = transformed(x, momentum(here, twist)), found = momentum(there, twist_there);
    EXPECT_LE((found.linear - expected.linear).norm(), 32 * eps * size);
    EXPECT_LE((found.angular - expected.angular).norm(), 32 * eps * size * 4);
    // M_A = X^-T M_B X^-1 with the matrix that transforms twists.
    const Matrix6 back = adjoint(x.inverse());
    EXPECT_LE((there.matrix() - back.transpose() * here.matrix() * back).norm(), 64 * eps * mass * 16);
  }
}

// Energy is half the product of twist and momentum; that product does not depend on the frame, as the power of a
// wrench.
TEST(Momentum, ChangesFrameAsAWrenchDoes) {
  Random random(5);
  for (int i = 0; i < runs; ++i) {
    const SpatialInertia body = random_body(random);
    const Twist twist = random_twist(random);
    const Momentum m = momentum(body, twist);
    const double size = m.vector().norm() * twist.vector().norm();
    EXPECT_NEAR(0.5 * power(Wrench{m.angular, m.linear}, twist), kinetic_energy(body, twist), 16 * eps * size);
    const Pose x = random_pose(random);
    const Wrench as_wrench = transformed(x, Wrench{m.angular, m.linear});
    EXPECT_EQ(transformed(x, m).angular, as_wrench.moment);
    EXPECT_EQ(transformed(x, m).linear, as_wrench.force);
    EXPECT_EQ((m + m - m).vector(), m.vector());
    EXPECT_EQ((-m).vector(), Vector6(-m.vector()));
  }
}

TEST(SpatialInertia, OfSeveralBodiesDoesNotDependOnTheOrder) {
  Random random(6);
  for (int i = 0; i < runs; ++i) {
    const SpatialInertia a = random_body(random), b = random_body(random), c = random_body(random);
    const double mass = a.mass + b.mass + c.mass;
    expect_same(a + b, b + a, 4 * eps, mass, 4);
    expect_same((a + b) + c, a + (b + c), 16 * eps, mass, 4);
    expect_same((a + c) + b, a + (b + c), 16 * eps, mass, 4);
    EXPECT_LE(((a + b).matrix() - a.matrix() - b.matrix()).norm(), 16 * eps * mass * 16);
    const Pose x = random_pose(random);
    expect_same(transformed(x, a + b), transformed(x, a) + transformed(x, b), 32 * eps, mass, 4);
  }
}

TEST(SpatialInertia, OfABodyIsTheSumOverItsParts) {
  Random random(7);
  for (int i = 0; i < runs; ++i) {
    const std::vector<PointMass> points = cloud(random, random.vector(), 1, 1);
    SpatialInertia sum;
    for (const PointMass& p : points) sum = sum + SpatialInertia{p.mass, p.position, Matrix3::Zero()};
    expect_same(sum, inertia_from_points<double>(points), 2 * (count + 24) * eps, total_mass(points), 4);
  }
}

// The coordinates are whole multiples of a power of two, so that the far ones are exact; about the centre nothing is
// lost.
TEST(SpatialInertia, LosesNothingFarFromTheOrigin) {
  Random random(8);
  for (int i = 0; i < runs; ++i) {
    const Vector3 far(std::ldexp(1.0, 30), -std::ldexp(1.0, 31), std::ldexp(3.0, 29));
    std::vector<PointMass> near_by, far_away;
    for (int k = 0; k < count; ++k) {
      const Vector3 p = (std::ldexp(1.0, 20) * random.vector()).array().round() * std::ldexp(1.0, -20);
      near_by.push_back({1, p});
      far_away.push_back({1, far + p});
    }
    const SpatialInertia a = inertia_from_points<double>(near_by), b = inertia_from_points<double>(far_away);
    EXPECT_EQ(a.about_centre, b.about_centre) << "the same differences";
    EXPECT_LE((b.centre - far - a.centre).norm(), eps * far.norm());
    // And so do two halves put together, whose centres are rounded to eps of the distance.
    const SpatialInertia halves = inertia_from_points<double>(std::span<const PointMass>(far_away).first(count / 2)) +
                                  inertia_from_points<double>(std::span<const PointMass>(far_away).last(count / 2));
    EXPECT_LE((halves.about_centre - a.about_centre).norm(), 4 * count * eps * far.norm());
  }
}

TEST(SpatialInertia, IsMadeFromPrincipalMoments) {
  Random random(9);
  for (int i = 0; i < runs; ++i) {
    const Matrix3 axes = random.rotation();
    const Vector3 moments(3, 4, 5), centre = random.vector();
    const SpatialInertia body = inertia_from_principal_moments<double>(2, centre, moments, axes);
    EXPECT_EQ(body.mass, 2);
    EXPECT_EQ(body.centre, centre);
    for (int k = 0; k < 3; ++k) {
      EXPECT_LE((body.about_centre * axes.col(k) - moments[k] * axes.col(k)).norm(), 24 * eps * 5);
    }
  }
}

TEST(SpatialInertia, OfNothingIsZero) {
  const SpatialInertia none = inertia_from_points<double>({});
  EXPECT_EQ(none.matrix(), Matrix6::Zero());
  Random random(10);
  const SpatialInertia body = random_body(random);
  expect_same(none + body, body, 0, 1, 1);
  expect_same(body + none, body, 0, 1, 1);
  // Without mass there is no centre, but nothing that is not a number either.
  const std::vector<PointMass> massless{{0, {1, 2, 3}}, {0, {3, 2, 1}}};
  const SpatialInertia empty = inertia_from_points<double>(massless);
  EXPECT_EQ(empty.centre, Vector3(1, 2, 3));
  EXPECT_EQ(empty.about_centre, Matrix3::Zero());
  const SpatialInertia one{0, {1, 0, 0}, Matrix3::Zero()}, other{0, {3, 0, 0}, Matrix3::Zero()};
  EXPECT_EQ((one + other).centre, Vector3(2, 0, 0));
  EXPECT_EQ((one + other).about_centre, Matrix3::Zero());
  EXPECT_EQ(kinetic_energy(empty, random_twist(random)), 0);
}

// Units that are powers of two change no digit.
TEST(SpatialInertia, DoesNotDependOnTheUnits) {
  Random random(11);
  const std::vector<PointMass> points = cloud(random, random.vector(), 1, 1);
  const SpatialInertia body = inertia_from_points<double>(points);
  for (const int power : {-300, -40, 40, 300}) {
    const double length = std::ldexp(1.0, power), mass = std::ldexp(1.0, -power / 2);
    std::vector<PointMass> scaled;
    scaled.reserve(points.size());
    for (const PointMass& p : points) scaled.push_back({mass * p.mass, length * p.position});
    expect_same(inertia_from_points<double>(scaled),
                {mass * body.mass, length * body.centre, mass * length * length * body.about_centre}, 0, 1, 1);
  }
}

// Frames with names: only what is written in the same one goes together, and a pose leads over.
TEST(SpatialInertia, KnowsItsFrame) {
  using Body = SpatialInertiaT<double, There>;
  const Body body{2, {1, 0, 0}, Matrix3::Identity()};
  const TwistT<double, There> twist{{0, 0, 1}, {0, 0, 0}};
  const MomentumT<double, There> there = momentum(body, twist);
  EXPECT_EQ(there.linear, Vector3(0, 2, 0));
  EXPECT_EQ(there.angular, Vector3(0, 0, 3));
  const SpatialInertiaT<double, Here> seen = transformed<Here>(Pose{}, body);
  const MomentumT<double, Here> here = transformed<Here>(Pose{}, there);
  EXPECT_EQ(momentum(seen, transformed<Here>(Pose{}, twist)).vector(), here.vector());
}

// The derivative of the energy with respect to the twist is the momentum.
TEST(SpatialInertia, CarriesDerivativesAndHigherPrecision) {
  Random random(12);
  const SpatialInertia body = random_body(random);
  const Twist twist = random_twist(random);
  const Vector6 expected = momentum(body, twist).vector();
  const SpatialInertiaT<Dual<double>> still{Dual<double>(body.mass), body.centre.cast<Dual<double>>(),
                                            body.about_centre.cast<Dual<double>>()};
  for (int k = 0; k < 6; ++k) {
    TwistT<Dual<double>> moving{twist.angular.cast<Dual<double>>(), twist.linear.cast<Dual<double>>()};
    (k < 3 ? moving.angular[k] : moving.linear[k - 3]).dual = 1;
    EXPECT_NEAR(kinetic_energy(still, moving).dual, expected[k], 32 * eps * body.matrix().norm() * 3);
  }

  std::vector<PointMassT<Long>> points;
  points.reserve(count);
  for (int k = 0; k < count; ++k) points.push_back({1, random.vector().cast<Long>()});
  const SpatialInertiaT<Long> precise = inertia_from_points<Long>(points);
  const TwistT<Long> moving{random.vector().cast<Long>(), random.vector().cast<Long>()};
  Long energy = 0;
  for (const PointMassT<Long>& p : points) energy += velocity_at(moving, p.position).squaredNorm() / 2;
  EXPECT_LE(std::abs(kinetic_energy(precise, moving) - energy), (count + 24) * epsilon<Long>() * count * 8);
}

}  // namespace
}  // namespace koppel::test
