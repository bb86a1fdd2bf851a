// Rates of rotations: angular velocity and acceleration from the matrix and its rates, and back, all differentiated
// exactly.
#include "spatial/rotation_rates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "motions.hpp"
#include "spatial/path.hpp"

namespace koppel::test {
namespace {

using Long = long double;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr int runs = 500;

using Turning = TimeDerivatives<Matrix3T<Dual<Dual<double>>>>;

Turning turning_at(const RandomTurning& rotation, double t) { return Turning(rotation(differentiable_time(t))); }

double greatest(const Matrix3& m) { return m.cwiseAbs().maxCoeff(); }

/// Rates of the two angles of a RandomTurning.
struct AngleRates {
  AngleRates(const Cubic& angle, double t) {
    const Dual<Dual<double>> x = angle(differentiable_time(t));
    rate = x.real.dual;
    second_rate = x.dual.dual;
  }
  double rate, second_rate;
};

/// What the matrices' entries are made of: their second rates are sums of terms of this size.
double size_of_second_rates(const AngleRates& a, const AngleRates& b) {
  const double rates = std::abs(a.rate) + std::abs(b.rate);
  return rates * rates + std::abs(a.second_rate) + std::abs(b.second_rate);
}

// Checks K-I-3.2.2, K-I-3.2.3.
// Two turns, one carried by the other: omega = a' u + b' R1 w, and alpha by differentiating that by hand. Three
// products of matrices, of a few units of rounding each.
TEST(AngularVelocityAndAcceleration, AreThoseOfTheTurnsThatMakeTheRotation) {
  Random random(1);
  for (int i = 0; i < runs; ++i) {
    const RandomTurning rotation(random);
    const double t = random.between(-1, 1);
    const Turning turning = turning_at(rotation, t);
    const AngleRates a(rotation.first_angle, t), b(rotation.second_angle, t);
    const Vector3 u = rotation.first;
    const Vector3 w = rotation_about<double>(u, rotation.first_angle(t)) * rotation.second;
    const Vector3 omega = a.rate * u + b.rate * w;
    const Vector3 alpha = a.second_rate * u + b.second_rate * w + (a.rate * u).cross(b.rate * w);
    const double rates = std::abs(a.rate) + std::abs(b.rate);
    EXPECT_LE((angular_velocity<double>(turning.value, turning.rate) - omega).norm(), 32 * eps * rates);
    EXPECT_LE((angular_acceleration<double>(turning.value, turning.second_rate) - alpha).norm(),
              32 * eps * size_of_second_rates(a, b));
  }
}

// Checks K-I-3.2.2.
// dR/dt R^T is skew to rounding, by differentiating R R^T = I; a body-fixed vector has the rate omega x rho.
TEST(AngularVelocity, IsAllThatTheRateOfARotationHolds) {
  Random random(2);
  for (int i = 0; i < runs; ++i) {
    const RandomTurning rotation(random);
    const double t = random.between(-1, 1);
    const Turning turning = turning_at(rotation, t);
    const double rates =
        std::abs(AngleRates(rotation.first_angle, t).rate) + std::abs(AngleRates(rotation.second_angle, t).rate);
    const Vector3 omega = angular_velocity<double>(turning.value, turning.rate);
    const Matrix3 c = turning.rate * turning.value.transpose();
    EXPECT_LE(greatest(c + c.transpose()), 32 * eps * rates);
    EXPECT_LE(greatest(c - skew(omega)), 32 * eps * rates);
    EXPECT_NEAR(omega.x(), -c(1, 2), 32 * eps * rates);
    EXPECT_NEAR(omega.y(), c(0, 2), 32 * eps * rates);
    EXPECT_NEAR(omega.z(), -c(0, 1), 32 * eps * rates);
    const Vector3 rho_b = random.vector(), rho = turning.value * rho_b;
    EXPECT_LE((turning.rate * rho_b - omega.cross(rho)).norm(), 32 * eps * rates * rho.norm());
  }
}

// Checks K-I-3.2.2.
// A rate that would pull the matrix out of the rotations: the symmetric part is left out of account.
TEST(AngularVelocity, DoesNotSeeTheSymmetricPart) {
  Random random(3);
  for (int i = 0; i < runs; ++i) {
    const Matrix3 r = random.rotation();
    const Vector3 omega = random.vector(), a = random.vector();
    const Matrix3 stretching = (skew(omega) + a * a.transpose()) * r;
    EXPECT_LE((angular_velocity<double>(r, stretching) - omega).norm(), 32 * eps * (omega.norm() + a.squaredNorm()));
  }
}

// Checks K-I-3.2.3.
// Dual numbers differentiate the angular velocity itself, as R and dR/dt go on.
TEST(AngularAcceleration, IsTheRateOfTheAngularVelocity) {
  Random random(4);
  for (int i = 0; i < runs; ++i) {
    const RandomTurning rotation(random);
    const double t = random.between(-1, 1);
    const Turning turning = turning_at(rotation, t);
    Matrix3T<Dual<double>> r, rate;
    for (int k = 0; k < 9; ++k) {
      r(k) = {turning.value(k), turning.rate(k)};
      rate(k) = {turning.rate(k), turning.second_rate(k)};
    }
    const Vector3T<Dual<double>> omega = angular_velocity<Dual<double>>(r, rate);
    const Vector3 alpha = angular_acceleration<double>(turning.value, turning.second_rate);
    const double size = size_of_second_rates({rotation.first_angle, t}, {rotation.second_angle, t});
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(omega[k].dual, alpha[k], 32 * eps * size);
    const Matrix3 whole = turning.second_rate * turning.value.transpose() + turning.rate * turning.rate.transpose();
    EXPECT_LE(greatest(whole - skew(alpha)), 32 * eps * size);
  }
}

// Checks K-I-3.2.3, K-I-4.1.2.
TEST(RotationRates, FollowFromAngularVelocityAndAcceleration) {
  Random random(5);
  for (int i = 0; i < runs; ++i) {
    const RandomTurning rotation(random);
    const double t = random.between(-1, 1);
    const Turning turning = turning_at(rotation, t);
    const Matrix3& r = turning.value;
    const AngleRates a(rotation.first_angle, t), b(rotation.second_angle, t);
    const double rates = std::abs(a.rate) + std::abs(b.rate), size = size_of_second_rates(a, b);
    const Vector3 omega = angular_velocity<double>(r, turning.rate);
    const Vector3 alpha = angular_acceleration<double>(r, turning.second_rate);
    const Vector3 omega_b = r.transpose() * omega;
    EXPECT_LE(greatest(rotation_rate<double>(r, omega) - turning.rate), 32 * eps * rates);
    EXPECT_LE(greatest(rotation_rate_in_body_axes<double>(r, omega_b) - turning.rate), 32 * eps * rates);
    EXPECT_LE(greatest(r * skew(omega_b) * r.transpose() - skew(omega)), 32 * eps * rates);
    EXPECT_LE(greatest(rotation_second_rate<double>(r, omega, alpha) - turning.second_rate), 64 * eps * size);

    const Vector3 rho_b = random.vector(), rho = r * rho_b;
    const Vector3 expected = alpha.cross(rho) + omega.cross(omega.cross(rho));
    EXPECT_LE((turning.second_rate * rho_b - expected).norm(), 64 * eps * size * rho.norm());
  }
}

/// Integrates Poisson's equation with a constant angular velocity by the classical Runge-Kutta method.
Matrix3 integrated(const Matrix3& start, const Vector3& omega, double duration, int steps) {
  const double h = duration / steps;
  Matrix3 r = start;
  for (int i = 0; i < steps; ++i) {
    const Matrix3 k1 = rotation_rate<double>(r, omega);
    const Matrix3 k2 = rotation_rate<double>(r + h / 2 * k1, omega);
    const Matrix3 k3 = rotation_rate<double>(r + h / 2 * k2, omega);
    const Matrix3 k4 = rotation_rate<double>(r + h * k3, omega);
    r += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return r;
}

// Checks K-I-4.1.2.
// A step is the Taylor polynomial of fourth order of exp(skew(omega h)). With z = |omega| h its error is z^5/120 (1 +
// z) at most; it shortens by z^6/144, twice that in R^T R - I: the drift, known beforehand. Each step rounds the
// matrix.
TEST(PoissonEquation, IntegratesToTheExponentialWithAKnownDrift) {
  Random random(6);
  for (int i = 0; i < 20; ++i) {
    const Matrix3 start = random.rotation();
    const Vector3 u = random.direction();
    const double rate = random.between(0.5, 2), duration = random.between(1, 5);
    for (const int steps : {20, 40, 80, 2000}) {
      const Matrix3 r = integrated(start, rate * u, duration, steps);
      const double z = rate * duration / steps;
      const double rounding = 4 * eps * (steps + 4);
      const Matrix3 exact = rotation_about<double>(u, rate * duration) * start;
      EXPECT_LE(greatest(r - exact), steps * std::pow(z, 5) / 120 * (1 + z) + rounding);
      const double drift = orthonormality_residual<double>(r);
      const double predicted = steps * std::pow(z, 6) / 72;
      EXPECT_LE(drift, predicted * (1 + z) + rounding);
      // The axis itself does not drift: of the directions of the frame one shows at least two thirds of it.
      EXPECT_GE(drift, 2 * predicted / 3 * (1 - z) - rounding);
    }
  }
}

// Checks K-I-4.1.2.
// At rest nothing changes, and a unit of time is no matter.
TEST(PoissonEquation, ScalesWithTheUnitOfTime) {
  Random random(7);
  const Matrix3 r = random.rotation();
  const Vector3 omega = random.vector(), alpha = random.vector();
  EXPECT_EQ(rotation_rate<double>(r, Vector3::Zero()), Matrix3::Zero());
  EXPECT_EQ(rotation_second_rate<double>(r, Vector3::Zero(), Vector3::Zero()), Matrix3::Zero());
  for (const int power : {-400, -40, 40, 400}) {
    const double unit = std::ldexp(1.0, power);
    EXPECT_EQ(rotation_rate<double>(r, unit * omega), unit * rotation_rate<double>(r, omega));
    EXPECT_EQ(rotation_second_rate<double>(r, unit * omega, unit * unit * alpha),
              unit * unit * rotation_second_rate<double>(r, omega, alpha));
    EXPECT_EQ(angular_velocity<double>(r, unit * skew(omega)), unit * angular_velocity<double>(r, skew(omega)));
  }
}

// Checks K-I-3.2.2, K-I-3.2.3.
TEST(RotationRates, TakeHigherPrecision) {
  Random random(8);
  const RandomTurning rotation(random);
  const TimeDerivatives<Matrix3T<Dual<Dual<Long>>>> turning(rotation(differentiable_time(Long(0.3))));
  const Vector3T<Long> omega = angular_velocity<Long>(turning.value, turning.rate);
  const Vector3T<Long> alpha = angular_acceleration<Long>(turning.value, turning.second_rate);
  // The axes are unit vectors to eps only: the rates are consistent with each other to that, and no better.
  const Long size = turning.second_rate.norm() + turning.rate.squaredNorm();
  EXPECT_LE((rotation_second_rate<Long>(turning.value, omega, alpha) - turning.second_rate).norm(), 64 * eps * size);
  EXPECT_LE((rotation_rate<Long>(turning.value, omega) - turning.rate).norm(), 32 * eps * turning.rate.norm());
}

}  // namespace
}  // namespace koppel::test
