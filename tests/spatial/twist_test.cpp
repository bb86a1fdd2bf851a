// Twists and wrenches: a field of velocities that keeps distances, a choice of reference point and axes that changes
// nothing, and sums that only make sense in one frame.
#include "spatial/twist.hpp"

#include <limits>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "directions.hpp"
#include "spatial/dual.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

struct Ground {};
struct Hand {};

template <typename A, typename B>
concept Addable = requires(const A& a, const B& b) {
  a + b;
};
template <typename A, typename B>
concept Subtractable = requires(const A& a, const B& b) {
  a - b;
};
template <typename W, typename V>
concept Powering = requires(const W& w, const V& v) {
  power(w, v);
};

Twist random_twist(Random& random) { return {random.vector(), random.vector()}; }
Wrench random_wrench(Random& random) { return {random.vector(), random.vector()}; }
Pose random_pose(Random& random) { return {random.rotation(), random.vector()}; }

/// Angular and linear part each relative to what was given, at the scale of both where they mix.
double apart(const Twist& a, const Twist& b) { return (a.vector() - b.vector()).cwiseAbs().maxCoeff(); }
double apart(const Wrench& a, const Wrench& b) { return (a.vector() - b.vector()).cwiseAbs().maxCoeff(); }

// Checks K-I-6.2.3a. Sums over different reference points or axes do not compile.
TEST(Twist, OfDifferentFramesCannotBeAdded) {
  static_assert(Addable<TwistT<double, Ground>, TwistT<double, Ground>>);
  static_assert(Addable<WrenchT<double, Hand>, WrenchT<double, Hand>>);
  static_assert(!Addable<TwistT<double, Ground>, TwistT<double, Hand>>);
  static_assert(!Addable<TwistT<double, Ground>, Twist>);
  static_assert(!Subtractable<TwistT<double, Hand>, TwistT<double, Ground>>);
  static_assert(!Addable<WrenchT<double, Ground>, WrenchT<double, Hand>>);
  static_assert(!Addable<TwistT<double, Ground>, WrenchT<double, Ground>>);
  static_assert(Powering<WrenchT<double, Ground>, TwistT<double, Ground>>);
  static_assert(!Powering<WrenchT<double, Ground>, TwistT<double, Hand>>);

  const TwistT<double, Ground> a{{1, 2, 3}, {4, 5, 6}}, b{{1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ((a + b).vector(), (Vector6() << 2, 2, 3, 4, 6, 6).finished());
  EXPECT_EQ((a - b).vector(), (Vector6() << 0, 2, 3, 4, 4, 6).finished());
  EXPECT_EQ((2.0 * a).vector(), 2 * a.vector());
  EXPECT_EQ((-a).vector(), -a.vector());
  // Written in one frame, they can: the compiler has been told which.
  const TwistT<double, Hand> h{{0, 0, 1}, {0, 0, 0}};
  const Pose x_gh{Matrix3::Identity(), {1, 0, 0}};
  EXPECT_EQ((b + transformed<Ground>(x_gh, h)).vector(), (Vector6() << 1, 0, 1, 0, 0, 0).finished());
}

// Checks K-I-3.3.2a. Velocities of two points differ only across the line between them. Each component is a handful of
// products of numbers below three.
TEST(VelocityField, KeepsDistances) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Twist twist = random_twist(random);
    const Vector3 p = random.vector(), q = random.vector();
    EXPECT_NEAR((velocity_at(twist, q) - velocity_at(twist, p)).dot(q - p), 0, 64 * eps);
  }
  const Twist twist = random_twist(random);
  EXPECT_EQ(velocity_at<double>(twist, Vector3::Zero()), twist.linear);
}

// Checks K-I-3.3.2a. The velocity of a point of a moving body, by differentiating its way: exact with dual numbers.
TEST(VelocityField, IsTheDerivativeOfThePosition) {
  using D = Dual<double>;
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Vector3 axis = random.direction(), start = random.vector(), rate = random.vector(), rho = random.vector();
    const double angle = random.between(-3, 3), speed = random.between(-2, 2);
    const PoseT<D> moving{rotation_about<D>(axis.cast<D>(), D(angle, speed)), dual(start, rate)};
    const Vector3T<D> point = moving * Vector3T<D>(rho.cast<D>());
    // The twist of the body at the ground's origin, where no point of it need be.
    const Twist twist{speed * axis, rate - speed * axis.cross(start)};
    EXPECT_LE((velocity_at<double>(twist, real_part(point)) - dual_part(point)).norm(), 64 * eps);
  }
}

// Checks K-I-3.3.2b. Lengths up to three metres and back: a few products of that size.
TEST(Twist, ComesBackFromAnotherReferencePoint) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Twist twist = random_twist(random);
    const Vector3 p = random.vector();
    const Twist there = shifted(twist, p);
    EXPECT_EQ(there.angular, twist.angular);
    EXPECT_LE(apart(shifted<Unnamed, double>(there, -p), twist), 8 * eps);
    EXPECT_NEAR(there.angular.dot(there.linear), twist.angular.dot(twist.linear), 32 * eps) << "the invariant";
    const Vector3 q = random.vector();
    EXPECT_LE((velocity_at<double>(there, q - p) - velocity_at(twist, q)).norm(), 32 * eps) << "of the same point";
  }
}

// Checks K-I-6.2.5. A pure shift is the pose without a rotation, seen from the other side.
TEST(Twist, ShiftIsATransformation) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const Vector3 p = random.vector();
    const Pose x{Matrix3::Identity(), -p};
    const Twist twist = random_twist(random);
    const Wrench wrench = random_wrench(random);
    EXPECT_LE(apart(shifted(twist, p), transformed(x, twist)), 4 * eps);
    EXPECT_LE(apart(shifted(wrench, p), transformed(x, wrench)), 4 * eps);
  }
}

// Checks K-I-6.2.5.
TEST(Adjoint, IsTheTransformationOfTwists) {
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const Pose x = random_pose(random), y = random_pose(random);
    const Twist twist = random_twist(random);
    EXPECT_LE((adjoint(x) * twist.vector() - transformed(x, twist).vector()).norm(), 32 * eps);
    EXPECT_LE((adjoint(x) * adjoint(y) - adjoint(x * y)).cwiseAbs().maxCoeff(), 64 * eps);
    EXPECT_LE((adjoint(x) * adjoint(x.inverse()) - Matrix6::Identity()).cwiseAbs().maxCoeff(), 64 * eps);
    EXPECT_NEAR(adjoint(x).determinant(), 1, 256 * eps);
    const Wrench wrench = random_wrench(random);
    // [moment; force] goes with [angular; linear]: the inverse transpose.
    const Vector6 moved = adjoint(x.inverse()).transpose() * wrench.vector();
    EXPECT_LE((moved - transformed(x, wrench).vector()).norm(), 64 * eps);
    EXPECT_LE(apart(transformed(x.inverse(), transformed(x, twist)), twist), 64 * eps);
  }
}

// Checks K-I-6.2.5, K-I-3.3.2b. Power belongs to forces and motion, not to the frame that they are written in.
TEST(Power, IsTheSameInEveryFrame) {
  Random random(6);
  for (int i = 0; i < 1000; ++i) {
    const Pose x = random_pose(random);
    const Twist twist = random_twist(random);
    const Wrench wrench = random_wrench(random);
    const Vector3 p = random.vector();
    EXPECT_NEAR(power(transformed(x, wrench), transformed(x, twist)), power(wrench, twist), 128 * eps);
    EXPECT_NEAR(power(shifted(wrench, p), shifted(twist, p)), power(wrench, twist), 128 * eps);
  }
  // A force at a point does work on that point's velocity alone.
  const Twist twist = random_twist(random);
  const Vector3 force = random.vector(), p = random.vector();
  EXPECT_NEAR(power<double>({p.cross(force), force}, twist), force.dot(velocity_at(twist, p)), 16 * eps);
}

// The rate of the adjoint of a pose that moves with twist a is bracket(a) times it.
TEST(Bracket, IsTheRateOfTheAdjoint) {
  using D = Dual<double>;
  Random random(7);
  for (int i = 0; i < 100; ++i) {
    const Pose x = random_pose(random);
    const Twist a = random_twist(random);
    const PoseT<D> moving{dual(x.rotation, skew(a.angular) * x.rotation), dual(x.position, velocity_at(a, x.position))};
    EXPECT_LE((dual_part(adjoint(moving)) - bracket(a) * adjoint(x)).cwiseAbs().maxCoeff(), 64 * eps);
    EXPECT_LE((bracket(a) * a.vector()).norm(), 8 * eps) << "nothing changes when carried along with itself";
  }
}

TEST(Twist, ExistsInOtherPrecisions) {
  const TwistT<long double> twist{{0, 0, 2}, {1, 0, 0}};
  EXPECT_EQ((velocity_at<long double>(twist, {0, 0.5L, 0})), Vector3T<long double>::Zero());
}

}  // namespace
}  // namespace koppel::test
