// The instantaneous screw axis: where it lies, who may choose the reference point, what happens far away and at rest;
// and the surfaces that it leaves behind.
#include "spatial/screw_axis.hpp"

#include <array>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "directions.hpp"
#include "spatial/displacement.hpp"
#include "spatial/planar_motion.hpp"

namespace koppel::test {
namespace {

using D = Dual<double>;
using Time = Dual<D>;
using DualVector = Vector3T<D>;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The twist of a turn about a line, with an advance along it.
Twist screwing(const Vector3& point, const Vector3& omega, double pitch) {
  return {omega, pitch * omega - omega.cross(point)};
}

// Checks K-I-3.3.2c. The axis' points have a velocity along omega alone, pitch times as large. All lengths are below 20
// m, as the rates are above 0.1 of the greatest.
TEST(ScrewAxis, MovesAlongItself) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Twist twist{random.between(0.1, 1) * random.direction(), random.vector()};
    const ScrewAxis axis = screw_axis(twist, 1.0);
    ASSERT_EQ(axis.kind, MotionKind::screw);
    const double rate = twist.angular.norm(), far = twist.linear.norm() / rate;
    EXPECT_LE((velocity_at<double>(twist, axis.point()) - axis.pitch * twist.angular).norm(), 16 * eps * (1 + far));
    EXPECT_NEAR(axis.rate, rate, 2 * eps);
    EXPECT_NEAR(axis.pitch, twist.angular.dot(twist.linear) / twist.angular.squaredNorm(), 16 * eps * far);
    const Vector3 nearest = twist.angular.cross(twist.linear) / twist.angular.squaredNorm();
    EXPECT_LE((axis.point() - nearest).norm(), 16 * eps * far);
    EXPECT_LE((axis.line.direction - twist.angular / rate).norm(), 4 * eps);
  }
}

// Checks K-I-3.3.2c, K-I-6.5.1. It is the line, and the pitch, of the velocity screw.
TEST(ScrewAxis, IsThatOfTheVelocityScrew) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 point = random.vector(), omega = random.direction();
    const double pitch = random.between(-1, 1);
    const Twist twist = screwing(point, omega, pitch);
    const ScrewAxis axis = screw_axis(twist, 1.0);
    const DualVector v = dual_vector(twist);
    EXPECT_NEAR(axis.rate, sqrt(v.dot(v)).real, 4 * eps);
    EXPECT_NEAR(axis.rate * axis.pitch, sqrt(v.dot(v)).dual, 32 * eps);
    EXPECT_NEAR(axis.pitch, pitch, 32 * eps);
    EXPECT_LE((axis.line.moment - point.cross(omega)).norm(), 32 * eps);
    const DualVector again = axis.line.dual() * D(axis.rate, axis.rate * axis.pitch);
    EXPECT_LE((twist_of_dual(again).vector() - twist.vector()).norm(), 32 * eps);
  }
}

// Checks K-I-3.3.2c.
TEST(ScrewAxis, DoesNotDependOnTheReferencePoint) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Twist twist{random.direction(), random.vector()};
    const Vector3 p = 3 * random.vector();
    const ScrewAxis here = screw_axis(twist, 1.0), there = screw_axis(shifted(twist, p), 1.0);
    EXPECT_NEAR(here.pitch, there.pitch, 64 * eps);
    EXPECT_NEAR(here.rate, there.rate, 2 * eps);
    // The point nearest to the other reference is another one of the same line.
    EXPECT_LE(((there.point() + p).cross(here.line.direction) - here.line.moment).norm(), 128 * eps);
    // In another frame altogether, it is the same axis moved.
    const Pose x{random.rotation(), p};
    const ScrewAxis moved = screw_axis(transformed(x, twist), 1.0), expected = transformed(x, here);
    EXPECT_EQ(moved.kind, expected.kind);
    EXPECT_NEAR(moved.pitch, expected.pitch, 64 * eps);
    EXPECT_LE((moved.line.moment - expected.line.moment).norm(), 128 * eps);
    EXPECT_LE((moved.line.direction - expected.line.direction).norm(), 16 * eps);
  }
}

// Checks K-I-3.3.2c.
TEST(ScrewAxis, NamesItsKinds) {
  const Vector3 z = Vector3::UnitZ(), x = Vector3::UnitX(), none = Vector3::Zero();
  for (const double scale : {1e-300, 1e-160, 1.0, 1e150}) {
    const auto found = [&](const Vector3& omega, const Vector3& v, double length) {
      return screw_axis<double>(Twist{scale * omega, scale * v}, length);
    };
    EXPECT_EQ(found(none, none, 1).kind, MotionKind::rest);
    EXPECT_EQ(found(none, none, 1).rate, 0);
    EXPECT_EQ(found(none, none, 1).pitch, 0);
    const ScrewAxis translation = found(none, {0, 3, 4}, 1);
    EXPECT_EQ(translation.kind, MotionKind::translation);
    EXPECT_EQ(translation.pitch, infinity);
    EXPECT_NEAR(translation.rate / scale, 5, 8 * eps);
    EXPECT_LE((translation.line.direction - Vector3(0, 0.6, 0.8)).norm(), 2 * eps);
    EXPECT_EQ(translation.point(), none);
    const ScrewAxis rotation = found(2 * z, 4 * x, 1);
    EXPECT_EQ(rotation.kind, MotionKind::rotation);
    EXPECT_EQ(rotation.pitch, 0);
    EXPECT_NEAR(rotation.rate / scale, 2, 4 * eps);
    EXPECT_LE((rotation.point() - Vector3(0, 2, 0)).norm(), 4 * eps);
    EXPECT_EQ(found(z, x + 1e-3 * z, 1).kind, MotionKind::screw);
    EXPECT_EQ(found(z, z, 1).kind, MotionKind::screw);
    // What counts is how far the body is from its axis, by its own length.
    EXPECT_EQ(found(1e-17 * z, x, 1).kind, MotionKind::translation);
    EXPECT_EQ(found(1e-17 * z, x, 1e6).kind, MotionKind::rotation);
  }
  EXPECT_EQ(transformed<double>({Matrix3::Identity(), {1, 2, 3}}, screw_axis(Twist{none, x}, 1.0)).line.moment, none)
      << "a translation has no place";
}

// Checks K-I-3.3.2c. In plane motion it goes through the pole, across the plane.
TEST(ScrewAxis, OfAPlaneMotionStandsOnItsPole) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const Vector3 p = random.vector(), v = random.vector();
    const PlanarMotion plane{.position = p.head<2>(), .velocity = v.head<2>(), .rate = random.between(0.5, 2)};
    const Vector3 omega(0, 0, plane.rate), place(p.x(), p.y(), 0), velocity(v.x(), v.y(), 0);
    const ScrewAxis axis = screw_axis<double>(Twist{omega, velocity - omega.cross(place)}, 1.0);
    EXPECT_EQ(axis.kind, MotionKind::rotation);
    EXPECT_LE((axis.point().head<2>() - velocity_pole(plane, 1.0).fixed).norm(), 16 * eps);
    EXPECT_EQ(axis.line.direction, Vector3::UnitZ());
  }
}

/// The twist at the fixed origin of a pose that carries its derivative by time, and the pose without.
template <typename T>
MotionSampleT<T> sample_of(const PoseT<Dual<T>>& x) {
  const Matrix3T<T> r = real_part(x.rotation);
  const Vector3T<T> p = real_part(x.position), omega = axial(dual_part(x.rotation) * r.transpose());
  return {{r, p}, {omega, dual_part(x.position) - omega.cross(p)}};
}

template <typename T>
Matrix3T<T> about_y(double angle) {
  return rotation_about<T>(Vector3::UnitY().cast<T>(), T(angle));
}
template <typename T>
Matrix3T<T> about_z(const T& angle) {
  return rotation_about<T>(Vector3::UnitZ().cast<T>(), angle);
}

// Checks K-II-1.2.1c. A cone of half angle b rolls on one of half angle a: these are the axodes, with the common apex.
TEST(Axodes, OfARollingConeAreBothCones) {
  const double a = 0.7, b = 0.4;
  const Vector3 apex(0.3, -0.2, 0.5);
  std::vector<MotionSample> samples;
  for (int i = 0; i < 40; ++i) {
    const D turn(0.15 * i, 1);
    // Equal arcs: the moving cone turns about its own axis sin(a) / sin(b) times as fast as that axis turns about z.
    const Matrix3T<D> r = about_z<D>(turn) * about_y<D>(a + b) * about_z<D>(turn * D(std::sin(a) / std::sin(b)));
    samples.push_back(sample_of<double>({r, apex.cast<D>()}));
  }
  const auto surfaces = axodes<double>(samples, 1.0);
  ASSERT_EQ(surfaces.fixed.size(), samples.size());
  ASSERT_EQ(surfaces.moving.size(), samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const ScrewAxis &fixed = surfaces.fixed[i], &moving = surfaces.moving[i];
    // Pure rolling, up to a pitch of rounding, which may pass for a screw.
    EXPECT_NEAR(fixed.pitch, 0, 16 * eps);
    EXPECT_LE((apex.cross(fixed.line.direction) - fixed.line.moment).norm(), 32 * eps) << "through the apex";
    EXPECT_LE(moving.line.moment.norm(), 32 * eps) << "the apex is the moving origin";
    EXPECT_NEAR(fixed.line.direction.z(), std::cos(a), 32 * eps);
    EXPECT_NEAR(moving.line.direction.z(), std::cos(b), 32 * eps);
    // The generator on top leads the moving axis by no angle: it is the one in the plane of both axes.
    const Vector3 contact = about_z<double>(0.15 * static_cast<double>(i)) * (about_y<double>(a) * Vector3::UnitZ());
    EXPECT_LE((fixed.line.direction - contact).norm(), 64 * eps);
    EXPECT_NEAR(fixed.rate, std::sin(a + b) / std::sin(b), 32 * eps);
  }
}

/// A motion without any symmetry, as function of time.
struct Tumbling {
  explicit Tumbling(Random& random)
      : u1(random.direction()), u2(random.direction()), a(random.vector()), b(random.vector()) {}
  template <typename T>
  PoseT<T> operator()(const T& t) const {
    return {rotation_about<T>(u1.cast<T>(), T(2) * t) * rotation_about<T>(u2.cast<T>(), sin(t)),
            Vector3T<T>(t * a.cast<T>() + t * t * b.cast<T>())};
  }
  Vector3 u1, u2, a, b;
};

// Checks K-II-1.2.1c. The surfaces have one line in common, and, as both its rates are the same vector but for the
// turn, one tangent plane at each of its points, and one parameter of distribution. The axes carry their rate by time
// here.
TEST(Axodes, TouchAlongTheScrewAxis) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const Tumbling motion(random);
    const Time t(D(random.between(-0.5, 0.5), 1), D(1));
    const std::array<MotionSampleT<D>, 1> samples{sample_of<D>(motion(t))};
    const auto surfaces = axodes<D>(samples, D(1));
    const auto &fixed = surfaces.fixed[0], &moving = surfaces.moving[0];
    ASSERT_EQ(fixed.kind, MotionKind::screw);
    const Pose x{real_part(samples[0].x_01.rotation), real_part(samples[0].x_01.position)};
    const auto line = [](const ScrewAxisT<D>& axis) -> DualVector {
      return dual(real_part(axis.line.direction), real_part(axis.line.moment));
    };
    const auto line_rate = [](const ScrewAxisT<D>& axis) -> DualVector {
      return dual(dual_part(axis.line.direction), dual_part(axis.line.moment));
    };
    // Velocities and accelerations, below ten, over a rate that may be small.
    const double far = 10 / fixed.rate.real;
    const double rounding = 32 * eps * (1 + far) * (1 + far) * (1 + far);
    const DualVector apart = line(fixed) - transform_screw<double>(x, line(moving));
    EXPECT_LE(real_part(apart).norm(), rounding);
    EXPECT_LE(dual_part(apart).norm(), rounding);
    const DualVector f = line_rate(fixed), m = line_rate(moving);
    const DualVector rates_apart = f - transform_screw<double>(x, m);
    EXPECT_LE(real_part(rates_apart).norm(), rounding);
    EXPECT_LE(dual_part(rates_apart).norm(), rounding);
    const double square = real_part(f).squaredNorm();
    const double fixed_parameter = real_part(f).dot(dual_part(f)), moving_parameter = real_part(m).dot(dual_part(m));
    EXPECT_NEAR(fixed_parameter / square, moving_parameter / real_part(m).squaredNorm(), rounding * (1 + 1 / square));
    EXPECT_EQ(fixed.pitch.real, moving.pitch.real);
  }
}

// Checks K-II-1.2.1c, K-I-3.3.2c. Gears on skew axes: seen from one, the axis of the other's motion keeps its angle and
// its distance, a hyperboloid; and slides along itself, pitch times the rate.
TEST(Axodes, OfSkewGearsAreHyperboloids) {
  const double rate_1 = 1, rate_2 = -1.7, shaft_angle = 0.9, distance = 0.4;
  const Vector3 axis_2(std::sin(shaft_angle), 0, std::cos(shaft_angle)), centre_2(0, distance, 0);
  std::vector<MotionSample> samples, back;
  for (int i = 0; i < 30; ++i) {
    const D t(0.2 * i, 1);
    const PoseT<D> x_1{about_z<D>(t * D(rate_1)), Vector3T<D>::Zero()};
    const Matrix3T<D> r_2 = rotation_about<D>(axis_2.cast<D>(), t * D(rate_2));
    const PoseT<D> x_2{r_2, centre_2.cast<D>()};
    samples.push_back(relative_sample(sample_of(x_1), sample_of(x_2)));
    back.push_back(relative_sample(sample_of(x_2), sample_of(x_1)));
    // It is the motion of the relative pose.
    const MotionSample direct = sample_of(x_1.inverse() * x_2);
    EXPECT_LE((direct.twist.vector() - samples.back().twist.vector()).norm(), 64 * eps);
    EXPECT_LE((direct.x_01.position - samples.back().x_01.position).norm(), 16 * eps);
  }
  const auto surfaces = axodes<double>(samples, 1.0), inverse = axodes<double>(back, 1.0);
  // The difference of both rates, a dual vector that stands still in space.
  const DualVector v = dual(Vector3(rate_2 * axis_2), Vector3(-rate_2 * axis_2.cross(centre_2))) -
                       dual(Vector3(0, 0, rate_1), Vector3::Zero().eval());
  const D length = sqrt(v.dot(v));
  const Vector3 direction = real_part(v) / length.real;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const ScrewAxis& axis = surfaces.fixed[i];
    EXPECT_NEAR(axis.pitch, length.dual / length.real, 32 * eps);
    EXPECT_NEAR(axis.line.direction.z(), direction.z(), 16 * eps) << "angle with the axis of gear 1";
    // The reciprocal product: distance times the sine of the angle.
    EXPECT_NEAR(axis.line.moment.z(), surfaces.fixed[0].line.moment.z(), 32 * eps);
    EXPECT_NEAR(surfaces.moving[i].line.direction.dot(axis_2), direction.dot(axis_2), 32 * eps) << "the same on gear 2";
    const Vector3 p = axis.point() + 0.3 * axis.line.direction;
    const Vector3 sliding = velocity_at<double>(samples[i].twist, p);
    EXPECT_LE((sliding - axis.pitch * axis.rate * axis.line.direction).norm(), 32 * eps);
    // Seen from the other gear: the same lines, opposite senses.
    EXPECT_LE((inverse.fixed[i].line.direction + surfaces.moving[i].line.direction).norm(), 32 * eps);
    EXPECT_LE((inverse.fixed[i].line.moment + surfaces.moving[i].line.moment).norm(), 64 * eps);
  }
}

// Checks K-II-1.2.1c. Of three bodies, the relative axes have one common normal (Aronhold and Kennedy).
TEST(ScrewAxis, ThreeBodiesHaveACommonNormal) {
  Random random(6);
  for (int i = 0; i < 1000; ++i) {
    const Twist a{random.direction(), random.vector()}, b{random.direction(), random.vector()};
    const double apart = (b.angular - a.angular).norm();
    const auto line = [](const Twist& twist) { return screw_axis(twist, 1.0).line.dual(); };
    const DualVector normal = line(a).cross(line(b));
    const D product = normal.dot(line(b - a));
    EXPECT_NEAR(product.real, 0, 16 * eps / apart);
    EXPECT_NEAR(product.dual, 0, 128 * eps / (apart * apart));
  }
}

TEST(Axodes, KeepAPlaceForEverySample) {
  std::array<MotionSample, 3> samples;
  samples[1].twist.linear = Vector3::UnitX();
  samples[2].twist.angular = Vector3::UnitZ();
  const auto surfaces = axodes<double>(samples, 1.0);
  EXPECT_EQ(surfaces.fixed[0].kind, MotionKind::rest);
  EXPECT_EQ(surfaces.fixed[1].kind, MotionKind::translation);
  EXPECT_EQ(surfaces.moving[1].kind, MotionKind::translation);
  EXPECT_EQ(surfaces.fixed[2].kind, MotionKind::rotation);
  EXPECT_TRUE(axodes<double>(std::span<const MotionSample>{}, 1.0).fixed.empty());
}

TEST(ScrewAxis, ExistsInOtherPrecisions) {
  const TwistT<long double> twist{{0, 0, 2}, {4, 0, 1}};
  const auto axis = screw_axis<long double>(twist, 1.0L);
  EXPECT_EQ(axis.pitch, 0.5L);
  EXPECT_EQ(axis.point()[1], 2.0L);
}

}  // namespace
}  // namespace koppel::test
