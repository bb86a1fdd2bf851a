// Plane motion: where its poles are, how the polodes roll, and the positions in which there is no pole.
#include "spatial/planar_motion.hpp"

#include <array>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "directions.hpp"
#include "spatial/dual.hpp"

namespace koppel::test {
namespace {

using D = Dual<double>;
using DD = Dual<D>;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;

/// The motion at a time, of a position and an angle as functions of it; exact derivatives, of a scalar T that may
/// itself have some.
template <typename T, typename Course>
PlanarMotionT<T> motion_at(const Course& course, const T& time) {
  using Time = Dual<Dual<T>>;
  const auto [position, angle] = course(Time(Dual<T>(time, T(1)), Dual<T>(T(1))));
  PlanarMotionT<T> m;
  for (int i = 0; i < 2; ++i) {
    m.position[i] = position[i].real.real;
    m.velocity[i] = position[i].real.dual;
    m.acceleration[i] = position[i].dual.dual;
  }
  m.angle = angle.real.real;
  m.rate = angle.real.dual;
  m.angular_acceleration = angle.dual.dual;
  return m;
}

template <typename T>
struct Place {
  Vector2T<T> position;
  T angle;
};

/// The coupler of the four-bar in terms of the crank's angle: origin in the crank's pin B, x axis to the rocker's pin.
struct Coupler {
  template <typename T>
  Place<T> operator()(const T& crank) const {
    const T ground(0.40), coupler(0.35), rocker(0.25);
    const Vector2T<T> b(T(0.12) * cos(crank), T(0.12) * sin(crank));
    const Vector2T<T> way = Vector2T<T>(ground, T(0)) - b;
    const T apart = way.norm(), along = (apart * apart + coupler * coupler - rocker * rocker) / (T(2) * apart);
    const Vector2T<T> e = way / apart;
    const Vector2T<T> rod = along * e + sqrt(coupler * coupler - along * along) * quarter_turned<T>(e);
    return {b, atan2(rod.y(), rod.x())};
  }
};

/// A wheel of radius 0.3 m that rolls along the x axis, with a speed that varies.
struct Wheel {
  template <typename T>
  Place<T> operator()(const T& time) const {
    const T way = T(2) * time + sin(time);
    return {Vector2T<T>(way, T(0.3)), -way / T(0.3)};
  }
};

/// A rod whose ends, its origin and the point (1, 0), slide along the x and the y axis.
struct Trammel {
  template <typename T>
  Place<T> operator()(const T& time) const {
    return {Vector2T<T>(-cos(time), T(0)), time};
  }
};

/// A run of samples, from a start in equal steps.
template <typename Course>
std::vector<PlanarMotion> sampled(const Course& course, double start, double step, int steps) {
  std::vector<PlanarMotion> samples;
  samples.reserve(static_cast<std::size_t>(steps) + 1);
  for (int i = 0; i <= steps; ++i) samples.push_back(motion_at<double>(course, start + step * i));
  return samples;
}

Vector2 random_vector(Random& random) { return {random.between(-1, 1), random.between(-1, 1)}; }

// Checks K-II-1.2.1c. The published numbers of the four-bar, at a crank angle of 60 degrees; nine decimals.
TEST(VelocityPole, OfTheFourBarCoupler) {
  const PlanarMotion m = motion_at<double>(Coupler{}, pi / 3);
  const auto pole = velocity_pole(m, 0.4);
  ASSERT_EQ(pole.kind, PlanarKind::rotation);
  constexpr double printed = 0.5e-9 + 32 * eps;
  EXPECT_NEAR(m.position.x(), 0.06, printed);
  EXPECT_NEAR(m.position.y(), 0.103923048, printed);
  EXPECT_NEAR(m.angle, 24.501199565 * pi / 180, printed * pi / 180 + 4 * eps);
  EXPECT_NEAR(m.rate, -0.208377411, printed);
  EXPECT_NEAR(pole.fixed.x(), 0.347939080, printed);
  EXPECT_NEAR(pole.fixed.y(), 0.602648164, printed);
  EXPECT_NEAR(pole.moving.x(), 0.468838347, printed);
  EXPECT_NEAR(pole.moving.y(), 0.334404333, printed);
}

// Checks K-I-3.3.2c. The pole has no velocity: what is left is the rounding of two velocities that cancel.
TEST(VelocityPole, IsAtRest) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const PlanarMotion m{.position = random_vector(random),
                         .angle = random.between(-3, 3),
                         .velocity = random_vector(random),
                         .rate = random.between(-2, 2)};
    const auto pole = velocity_pole(m, 1.0);
    ASSERT_EQ(pole.kind, PlanarKind::rotation);
    EXPECT_LE(m.velocity_at(pole.fixed).norm(), 4 * eps * (m.velocity.norm() + std::abs(m.rate) * pole.fixed.norm()));
    EXPECT_LE((m.in_body(pole.fixed) - pole.moving).norm(), 8 * eps * (pole.fixed - m.position).norm());
    EXPECT_NEAR(pole.moving.norm(), m.velocity.norm() / std::abs(m.rate),
                8 * eps * (pole.moving.norm() + m.position.norm()));
  }
}

// Checks K-I-3.3.2c. Motions are told apart by the length, not by their size.
TEST(VelocityPole, CasesDoNotDependOnTheScale) {
  for (const double scale : {1e-300, 1e-160, 1.0, 1e150}) {
    const Vector2 v(scale, 0);
    EXPECT_EQ(velocity_pole<double>({.velocity = v}, 1.0).kind, PlanarKind::translation);
    EXPECT_EQ(velocity_pole<double>({.velocity = v, .rate = 1e-17 * scale}, 1.0).kind, PlanarKind::translation);
    EXPECT_EQ(velocity_pole<double>({.velocity = v, .rate = 1e-17 * scale}, 1e6).kind, PlanarKind::rotation);
    const auto turn = velocity_pole<double>({.velocity = v, .rate = scale}, 1.0);
    EXPECT_EQ(turn.kind, PlanarKind::rotation);
    EXPECT_LE((turn.fixed - Vector2(0, 1)).norm(), eps);
    EXPECT_EQ(velocity_pole<double>({.rate = scale}, 1.0).fixed, Vector2::Zero());
  }
  EXPECT_EQ(velocity_pole<double>({}, 1.0).kind, PlanarKind::rest);
}

// Checks K-II-1.2.1c. The fixed polode is the road, the moving one the rim.
TEST(Polodes, OfARollingWheelAreRoadAndRim) {
  const auto samples = sampled(Wheel{}, 0, 0.1, 50);
  const auto pieces = polodes<double>(samples, 0.3);
  ASSERT_EQ(pieces.size(), 1U);
  ASSERT_EQ(pieces[0].fixed.size(), samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double way = samples[i].position.x();
    EXPECT_LE((pieces[0].fixed[i] - Vector2(way, 0)).norm(), 2 * eps);
    EXPECT_NEAR(pieces[0].moving[i].norm(), 0.3, 4 * eps);
    if (i == 0) continue;
    // Rolled off the rim: the arc between two points of contact, exact from the chord.
    const double arc = 0.6 * std::asin((pieces[0].moving[i] - pieces[0].moving[i - 1]).norm() / 0.6);
    EXPECT_NEAR(arc, way - samples[i - 1].position.x(), 8 * eps * (1 + way));
  }
}

// Checks K-II-1.2.1c. Cardan's circles: the small one rolls inside the other, twice as large.
TEST(Polodes, OfATrammelAreTwoCircles) {
  const auto samples = sampled(Trammel{}, 0, 0.1, 60);
  const auto pieces = polodes<double>(samples, 1.0);
  ASSERT_EQ(pieces.size(), 1U);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_NEAR(pieces[0].fixed[i].norm(), 1, 4 * eps);
    EXPECT_NEAR((pieces[0].moving[i] - Vector2(0.5, 0)).norm(), 0.5, 4 * eps);
  }
}

// Checks K-II-1.2.1c. The point of contact travels along both polodes with the same velocity: their tangents coincide
// and their arcs are equal. The positions carry the derivative by time here.
TEST(Polodes, RollWithoutSliding) {
  for (int i = 0; i < 62; ++i) {
    const double crank = 0.1 * i;
    const auto m = motion_at<D>(Coupler{}, D(crank, 1));
    const auto pole = velocity_pole<D>(m, D(0.4));
    ASSERT_EQ(pole.kind, PlanarKind::rotation);
    const Vector2 fixed = dual_part(pole.fixed), moving = dual_part(pole.moving);
    const double c = std::cos(m.angle.real), s = std::sin(m.angle.real);
    const Vector2 turned(c * moving.x() - s * moving.y(), s * moving.x() + c * moving.y());
    // The pole is far off, and fast, where the rod hardly turns: the rounding of the coupler's rate and acceleration,
    // of the order of one, counts 1 / rate and 1 / rate^2 times.
    const double far = 1 / std::abs(m.rate.real);
    EXPECT_LE((turned - fixed).norm(), 64 * eps * (1 + far) * (1 + far)) << crank;
    const auto circle = inflection<D>(m, D(0.4));
    ASSERT_TRUE(circle.has_value());
    EXPECT_LE((real_part(circle->pole_velocity) - fixed).norm(), 64 * eps * (1 + far) * (1 + far)) << crank;
  }
}

double length_of(const std::vector<Vector2>& curve) {
  double sum = 0;
  for (std::size_t i = 1; i < curve.size(); ++i) sum += (curve[i] - curve[i - 1]).norm();
  return sum;
}

// Checks K-II-1.2.1c. The lengths of two polygons on curves of equal length differ by the square of the step: twice as
// many steps, a quarter of the difference, up to the square of the step once more [rad of the crank].
TEST(Polodes, HaveEqualArcs) {
  std::vector<double> differences;
  for (const int steps : {100, 200, 400}) {
    const auto pieces = polodes<double>(sampled(Coupler{}, 0.8, 0.6 / steps, steps), 0.4);
    ASSERT_EQ(pieces.size(), 1U);
    EXPECT_GT(length_of(pieces[0].fixed), 0.1);
    differences.push_back(std::abs(length_of(pieces[0].fixed) - length_of(pieces[0].moving)));
  }
  constexpr double step = 0.6 / 100;
  EXPECT_NEAR(differences[0] / differences[1], 4, 4 * step * step);
  EXPECT_NEAR(differences[1] / differences[2], 4, step * step);
}

// Checks K-II-1.2.1c. Where there is no pole, or it has gone through infinity in between, the curves break.
TEST(Polodes, BreakWhereThePoleIsInfinitelyFar) {
  std::vector<PlanarMotion> samples;
  for (const double rate : {1.0, 2.0, -1.0, -2.0, 0.0, -1.0, 1.0}) {
    samples.push_back({.velocity = Vector2(1, 0), .rate = rate});
  }
  samples.push_back({});
  const auto pieces = polodes<double>(samples, 1.0);
  ASSERT_EQ(pieces.size(), 4U);
  const std::array<std::size_t, 4> first{0, 2, 5, 6}, count{2, 2, 1, 1};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(pieces[i].first, first[i]);
    EXPECT_EQ(pieces[i].fixed.size(), count[i]);
    EXPECT_EQ(pieces[i].moving.size(), count[i]);
  }
  EXPECT_TRUE(polodes<double>(std::span<const PlanarMotion>{}, 1.0).empty());
}

// Checks K-II-1.2.1c. Aronhold and Kennedy: the relative poles of three bodies lie on one line.
TEST(VelocityPole, ThreeBodiesHaveTheirPolesOnALine) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const PlanarMotion a{.velocity = random_vector(random), .rate = random.between(0.5, 1)};
    const PlanarMotion b{.velocity = random_vector(random), .rate = random.between(-1, -0.5)};
    const PlanarMotion ab{.velocity = b.velocity - a.velocity, .rate = b.rate - a.rate};
    const Vector2 p = velocity_pole(a, 1.0).fixed, q = velocity_pole(b, 1.0).fixed, r = velocity_pole(ab, 1.0).fixed;
    // All within 3 m of the origin.
    EXPECT_NEAR(quarter_turned<double>(q - p).dot(r - p), 0, 128 * eps);
  }
}

TEST(AccelerationPole, HasNoAcceleration) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const PlanarMotion m{.position = random_vector(random),
                         .rate = random.between(-2, 2),
                         .acceleration = random_vector(random),
                         .angular_acceleration = random.between(-2, 2)};
    const auto pole = acceleration_pole(m, 1.0);
    ASSERT_TRUE(pole.has_value());
    const double turning = m.rate * m.rate + std::abs(m.angular_acceleration);
    EXPECT_LE(m.acceleration_at(*pole).norm(), 8 * eps * (m.acceleration.norm() + turning * pole->norm()));
  }
  const auto wheel = motion_at<double>([](const auto& t) { return Wheel{}(t - sin(t)); }, 0.0);
  EXPECT_FALSE(acceleration_pole(wheel, 0.3).has_value()) << "at rest, with neither acceleration";
  // At constant speed it is the hub.
  const PlanarMotion even{.position = Vector2(7, 0.3), .velocity = Vector2(3, 0), .rate = -10};
  EXPECT_EQ(*acceleration_pole(even, 0.3), even.position);
}

TEST(AccelerationPole, DoesNotExistWithoutTurning) {
  const Vector2 a(1, 2);
  EXPECT_FALSE(acceleration_pole<double>({}, 1.0).has_value());
  EXPECT_FALSE(acceleration_pole<double>({.acceleration = a}, 1.0).has_value());
  EXPECT_FALSE(acceleration_pole<double>({.rate = 1e-9, .acceleration = a}, 1.0).has_value())
      << "square below rounding";
  EXPECT_TRUE(acceleration_pole<double>({.rate = 1e-7, .acceleration = a}, 1.0).has_value());
  EXPECT_TRUE(acceleration_pole<double>({.acceleration = a, .angular_acceleration = 1e-14}, 1.0).has_value());
  const auto small = acceleration_pole<double>({.acceleration = 1e-200 * a, .angular_acceleration = 1e-200}, 1.0);
  ASSERT_TRUE(small.has_value());
  EXPECT_LE((*small - Vector2(-2, 1)).norm(), 4 * eps);
}

// The points on the circle over pole and inflection pole pass through points of their paths without curvature.
TEST(InflectionCircle, CarriesPathsWithoutCurvature) {
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const PlanarMotion m = motion_at<double>(Coupler{}, random.between(0.2, 2.0));
    const auto circle = inflection(m, 0.4);
    ASSERT_TRUE(circle.has_value());
    const Vector2 centre = (circle->pole + circle->inflection_pole) / 2;
    const double radius = (circle->inflection_pole - circle->pole).norm() / 2, turn = random.between(-3, 3);
    EXPECT_NEAR(2 * radius, circle->pole_velocity.norm() / std::abs(m.rate), 16 * eps * (1 + centre.norm()));
    const Vector2 p = centre + radius * Vector2(std::cos(turn), std::sin(turn));
    const Vector2 v = m.velocity_at(p), a = m.acceleration_at(p);
    const double size = m.acceleration.norm() + (m.rate * m.rate + std::abs(m.angular_acceleration)) * p.norm();
    EXPECT_LE(std::abs(quarter_turned<double>(v).dot(a)), 64 * eps * (m.velocity.norm() + v.norm()) * size);
  }
}

TEST(InflectionCircle, OfAWheelReachesItsHub) {
  for (const double time : {0.0, 0.7, 2.0}) {
    const PlanarMotion m = motion_at<double>(Wheel{}, time);
    const auto circle = inflection(m, 0.3);
    ASSERT_TRUE(circle.has_value());
    EXPECT_LE((circle->inflection_pole - m.position).norm(), 8 * eps * (1 + m.position.norm()));
    EXPECT_LE((circle->pole_velocity - m.velocity).norm(), 8 * eps * m.velocity.norm());
  }
  EXPECT_FALSE(inflection<double>({.velocity = Vector2(1, 0)}, 1.0).has_value());
}

TEST(PlanarMotion, ExistsInOtherPrecisions) {
  const auto m = motion_at<long double>(Coupler{}, std::numbers::pi_v<long double> / 3);
  const auto pole = velocity_pole<long double>(m, 0.4L);
  const auto low = velocity_pole<double>(motion_at<double>(Coupler{}, pi / 3), 0.4);
  EXPECT_LE((pole.fixed.cast<double>() - low.fixed).norm(), 64 * eps);
  EXPECT_LE((pole.moving.cast<double>() - low.moving).norm(), 64 * eps);
}

}  // namespace
}  // namespace koppel::test
