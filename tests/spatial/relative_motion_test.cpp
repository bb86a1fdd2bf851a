// Motions relative to one another: every formula against poses differentiated exactly by dual numbers.
#include "spatial/relative_motion.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "motions.hpp"

namespace koppel::test {
namespace {

using Long = long double;
using Time = Dual<Dual<double>>;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr int runs = 500;

RelativeMotion motion_at(const RandomMotion& pose, double t) { return relative_motion(pose, t); }

/// Sizes of the terms that the velocities and accelerations of several motions in a row are sums of.
struct Sizes {
  double rate = 0, length = 0, linear_velocity = 0, angular_acceleration = 0, linear_acceleration = 0;

  Sizes& operator+=(const RelativeMotion& m) {
    rate += m.angular_velocity.norm();
    length += m.pose.position.norm();
    linear_velocity += m.linear_velocity.norm();
    angular_acceleration += m.angular_acceleration.norm();
    linear_acceleration += m.linear_acceleration.norm();
    return *this;
  }
  double velocity() const { return linear_velocity + rate * length; }
  double angular() const { return angular_acceleration + rate * rate; }
  double acceleration() const {
    return linear_acceleration + 2 * rate * linear_velocity + (angular_acceleration + 2 * rate * rate) * length;
  }
};

void expect_same(const RelativeMotion& a, const RelativeMotion& b, const Sizes& sizes, double units) {
  const double tolerance = units * eps;
  EXPECT_LE((a.pose.rotation - b.pose.rotation).norm(), tolerance);
  EXPECT_LE((a.pose.position - b.pose.position).norm(), tolerance * sizes.length);
  EXPECT_LE((a.angular_velocity - b.angular_velocity).norm(), tolerance * sizes.rate);
  EXPECT_LE((a.linear_velocity - b.linear_velocity).norm(), tolerance * sizes.velocity());
  EXPECT_LE((a.angular_acceleration - b.angular_acceleration).norm(), tolerance * sizes.angular());
  EXPECT_LE((a.linear_acceleration - b.linear_acceleration).norm(), tolerance * sizes.acceleration());
}

// Checks K-I-3.2.2, K-I-3.2.3.
// Turning about a fixed axis and moving along a line.
TEST(RelativeMotion, IsReadFromAPoseThatDependsOnTime) {
  Random random(1);
  for (int i = 0; i < runs; ++i) {
    const Vector3 u = random.direction(), line = random.vector();
    const Cubic angle(random), way(random);
    const double t = random.between(-1, 1);
    const auto pose = [&](const Time& time) -> PoseT<Time> {
      return {rotation_about<Time>(constant<Time>(u), angle(time)), constant<Time>(line) * way(time)};
    };
    const RelativeMotion motion = relative_motion(pose, t);
    const Time a = angle(differentiable_time(t)), w = way(differentiable_time(t));
    const double size = std::abs(a.dual.dual) + a.real.dual * a.real.dual;
    EXPECT_LE((motion.pose.rotation - rotation_about<double>(u, a.real.real)).norm(), 8 * eps);
    EXPECT_LE((motion.angular_velocity - a.real.dual * u).norm(), 16 * eps * std::abs(a.real.dual));
    EXPECT_LE((motion.angular_acceleration - a.dual.dual * u).norm(), 16 * eps * size);
    EXPECT_LE((motion.linear_velocity - w.real.dual * line).norm(), 4 * eps * std::abs(w.real.dual) * line.norm());
    EXPECT_LE((motion.linear_acceleration - w.dual.dual * line).norm(), 4 * eps * std::abs(w.dual.dual) * line.norm());
  }
}

// Checks K-I-3.3.2a, K-I-3.3.3.
// A point fixed in the body has a path in A; dual numbers differentiate it.
TEST(BodyPoint, HasTheVelocityAndAccelerationOfItsPath) {
  Random random(2);
  for (int i = 0; i < runs; ++i) {
    const RandomMotion pose(random);
    const double t = random.between(-1, 1);
    const Vector3 p = 3 * random.vector();
    const PointMotion path =
        point_motion([&](const Time& time) { return Vector3T<Time>(pose(time) * constant<Time>(p)); }, t);
    const RelativeMotion motion = motion_at(pose, t);
    Sizes sizes;
    sizes += motion;
    sizes.length += p.norm();
    EXPECT_LE((velocity_at<double>(motion, p) - path.velocity).norm(), 64 * eps * sizes.velocity());
    EXPECT_LE((acceleration_at<double>(motion, p) - path.acceleration).norm(), 64 * eps * sizes.acceleration());
  }
}

// Checks K-I-3.3.2a, K-I-3.3.3.
// Distances of a body's points are constant: d^2 has neither a first nor a second derivative.
TEST(BodyPoint, KeepsItsDistanceFromTheOthers) {
  Random random(3);
  for (int i = 0; i < runs; ++i) {
    const RelativeMotion motion = motion_at(RandomMotion(random), random.between(-1, 1));
    const Vector3 p = random.vector(), q = random.vector();
    const Vector3 apart = motion.pose * q - motion.pose * p;
    const Vector3 velocity = velocity_at<double>(motion, q) - velocity_at<double>(motion, p);
    const Vector3 acceleration = acceleration_at<double>(motion, q) - acceleration_at<double>(motion, p);
    Sizes sizes;
    sizes += motion;
    sizes.length += p.norm() + q.norm();
    const double size = apart.norm() * sizes.velocity();
    EXPECT_NEAR(velocity.dot(apart), 0, 32 * eps * size);
    const double second = apart.norm() * sizes.acceleration() + sizes.velocity() * sizes.velocity();
    EXPECT_NEAR(acceleration.dot(apart) + velocity.squaredNorm(), 0, 32 * eps * second);
  }
}

// Checks K-I-5.2.
TEST(Composition, IsTheMotionOfTheProductOfThePoses) {
  Random random(4);
  for (int i = 0; i < runs; ++i) {
    const RandomMotion x_ab(random), x_bc(random);
    const double t = random.between(-1, 1);
    const RelativeMotion ab = motion_at(x_ab, t), bc = motion_at(x_bc, t);
    const RelativeMotion exact = relative_motion([&](const Time& time) { return x_ab(time) * x_bc(time); }, t);
    Sizes sizes;
    (sizes += ab) += bc;
    expect_same(composed(ab, bc).motion, exact, sizes, 64);
  }
}

// Checks K-I-5.2.
TEST(Composition, NamesThePartsOfWhichItIsMade) {
  Random random(5);
  for (int i = 0; i < runs; ++i) {
    const RelativeMotion ab = motion_at(RandomMotion(random), 0.3), bc = motion_at(RandomMotion(random), -0.2);
    const ComposedMotion c = composed(ab, bc);
    // The guiding parts are those of the point of B at C's origin; the relative ones are C's as B sees them.
    EXPECT_EQ(c.guiding_velocity, velocity_at<double>(ab, bc.pose.position));
    Sizes sizes;
    (sizes += ab) += bc;
    const double velocity = 4 * eps * sizes.velocity(), acceleration = 4 * eps * sizes.acceleration();
    EXPECT_LE((c.guiding_acceleration - acceleration_at<double>(ab, bc.pose.position)).norm(), acceleration);
    EXPECT_LE((c.relative_velocity - ab.pose.rotation * bc.linear_velocity).norm(), velocity);
    EXPECT_LE((c.relative_acceleration - ab.pose.rotation * bc.linear_acceleration).norm(), acceleration);
    EXPECT_LE((c.motion.linear_velocity - c.guiding_velocity - c.relative_velocity).norm(), velocity);
    EXPECT_LE(
        (c.motion.linear_acceleration - c.guiding_acceleration - c.relative_acceleration - c.coriolis_acceleration)
            .norm(),
        acceleration);
    EXPECT_LE(
        (c.guiding_acceleration - ab.linear_acceleration - c.euler_acceleration - c.centripetal_acceleration).norm(),
        acceleration);
    // Each in its direction: Coriolis across omega and the relative velocity, centripetal towards the axis.
    EXPECT_NEAR(c.coriolis_acceleration.dot(ab.angular_velocity), 0, acceleration * sizes.rate);
    EXPECT_NEAR(c.coriolis_acceleration.dot(c.relative_velocity), 0, acceleration * sizes.velocity());
    EXPECT_LE(c.centripetal_acceleration.dot(c.motion.pose.position - ab.pose.position), acceleration);
    const Vector3 rest = c.motion.angular_acceleration - ab.angular_acceleration -
                         ab.pose.rotation * bc.angular_acceleration - c.gyroscopic;
    EXPECT_LE(rest.norm(), 4 * eps * sizes.angular());
    EXPECT_NEAR(c.gyroscopic.dot(ab.angular_velocity), 0, 4 * eps * sizes.angular() * sizes.rate);
  }
}

// Checks K-I-5.2.
// A disc turns with Omega about z; a point goes outwards on it with the speed u, at the distance r.
TEST(Turntable, PushesSidewaysWhatMovesOutwards) {
  const double speed = 0.75, rate = 3, distance = 2;
  RelativeMotion disc, point;
  disc.angular_velocity = {0, 0, rate};
  disc.pose.rotation = rotation_about<double>(Vector3::UnitZ(), 0.0, 1.0);  // a quarter turn: B's x is A's y
  point.pose.position = {distance, 0, 0};
  point.linear_velocity = {speed, 0, 0};
  const ComposedMotion c = composed(disc, point);
  EXPECT_EQ(c.coriolis_acceleration, Vector3(-2 * rate * speed, 0, 0));
  EXPECT_EQ(c.centripetal_acceleration, Vector3(0, -rate * rate * distance, 0));
  EXPECT_EQ(c.guiding_velocity, Vector3(-rate * distance, 0, 0));
  EXPECT_EQ(c.relative_velocity, Vector3(0, speed, 0));
  EXPECT_EQ(c.euler_acceleration, Vector3::Zero());
  EXPECT_EQ(c.relative_acceleration, Vector3::Zero());
  EXPECT_EQ(c.motion.linear_acceleration, Vector3(-2 * rate * speed, -rate * rate * distance, 0));
}

// Checks K-I-5.2.
// A wheel spins about x on a carrier that yaws about z: omega_01 x omega_12, however steady both are.
TEST(Turntable, TiltsWhatSpinsOnIt) {
  RelativeMotion carrier, wheel;
  carrier.angular_velocity = {0, 0, 0.5};
  wheel.angular_velocity = {8, 0, 0};
  const ComposedMotion c = composed(carrier, wheel);
  EXPECT_EQ(c.gyroscopic, Vector3(0, 4, 0));
  EXPECT_EQ(c.motion.angular_velocity, Vector3(8, 0, 0.5));
  EXPECT_EQ(c.motion.angular_acceleration, Vector3(0, 4, 0));
}

// Checks K-I-5.2.
TEST(Composition, IsAssociativeAndHasRestForItsUnit) {
  Random random(6);
  for (int i = 0; i < runs; ++i) {
    const RelativeMotion ab = motion_at(RandomMotion(random), 0.1), bc = motion_at(RandomMotion(random), 0.5),
                         cd = motion_at(RandomMotion(random), -0.7);
    Sizes sizes;
    ((sizes += ab) += bc) += cd;
    expect_same(composed(composed(ab, bc).motion, cd).motion, composed(ab, composed(bc, cd).motion).motion, sizes, 64);
    expect_same(composed(ab, RelativeMotion{}).motion, ab, Sizes{}, 0);
    expect_same(composed(RelativeMotion{}, ab).motion, ab, Sizes{}, 0);
  }
}

// Checks K-I-5.2.
TEST(InverseMotion, IsTheMotionOfTheInversePose) {
  Random random(7);
  for (int i = 0; i < runs; ++i) {
    const RandomMotion x(random);
    const double t = random.between(-1, 1);
    const RelativeMotion ab = motion_at(x, t);
    Sizes sizes;
    sizes += ab;
    expect_same(inverse(ab), relative_motion([&](const Time& time) { return x(time).inverse(); }, t), sizes, 64);
    expect_same(inverse(inverse(ab)), ab, sizes, 64);
  }
}

// Checks K-I-5.2.
TEST(InverseMotion, ComposedWithTheMotionGivesRest) {
  Random random(8);
  for (int i = 0; i < runs; ++i) {
    const RelativeMotion ab = motion_at(RandomMotion(random), random.between(-1, 1));
    Sizes sizes;
    (sizes += ab) += ab;
    expect_same(composed(ab, inverse(ab)).motion, RelativeMotion{}, sizes, 32);
    expect_same(composed(inverse(ab), ab).motion, RelativeMotion{}, sizes, 32);
  }
  expect_same(inverse(RelativeMotion{}), RelativeMotion{}, Sizes{}, 0);
}

RelativeMotion in_units(const RelativeMotion& m, double length, double rate) {
  return {{m.pose.rotation, length * m.pose.position},
          rate * m.angular_velocity,
          length * rate * m.linear_velocity,
          rate * rate * m.angular_acceleration,
          length * rate * rate * m.linear_acceleration};
}

// Checks K-I-5.2.
// Units that are powers of two change no digit.
TEST(Composition, DoesNotDependOnTheUnits) {
  Random random(9);
  const RelativeMotion ab = motion_at(RandomMotion(random), 0.4), bc = motion_at(RandomMotion(random), -0.6);
  const RelativeMotion whole = composed(ab, bc).motion, back = inverse(ab);
  for (const int power : {-500, -40, 40, 500}) {
    for (const int pace : {-150, 0, 150}) {
      const double length = std::ldexp(1.0, power), rate = std::ldexp(1.0, pace);
      const auto in = [&](const RelativeMotion& m) { return in_units(m, length, rate); };
      expect_same(composed(in(ab), in(bc)).motion, in(whole), Sizes{}, 0);
      expect_same(inverse(in(ab)), in(back), Sizes{}, 0);
    }
  }
}

// Checks K-I-5.2.
TEST(RelativeMotion, TakesHigherPrecision) {
  Random random(10);
  const RandomMotion x_ab(random), x_bc(random);
  using LongTime = Dual<Dual<Long>>;
  const Long t = Long(1) / 3;
  const RelativeMotionT<Long> exact = relative_motion([&](const LongTime& s) { return x_ab(s) * x_bc(s); }, t);
  const RelativeMotionT<Long> whole = composed(relative_motion(x_ab, t), relative_motion(x_bc, t)).motion;
  const RelativeMotion ab = motion_at(x_ab, 1.0 / 3), bc = motion_at(x_bc, 1.0 / 3);
  Sizes sizes;
  (sizes += ab) += bc;
  // The axes of the rotations are unit vectors to eps only: the motions agree to that, as those in double do.
  EXPECT_LE((whole.linear_acceleration - exact.linear_acceleration).norm(), 32 * eps * sizes.acceleration());
  EXPECT_LE((whole.linear_acceleration.cast<double>() - composed(ab, bc).motion.linear_acceleration).norm(),
            64 * eps * sizes.acceleration());
  EXPECT_LE((inverse(inverse(whole)).linear_velocity - whole.linear_velocity).norm(), 32 * eps * sizes.velocity());
}

}  // namespace
}  // namespace koppel::test
