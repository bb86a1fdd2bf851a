// Derivatives of one vector seen from two frames, against coordinates differentiated exactly in both.
#include "spatial/relative_derivative.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "motions.hpp"
#include "spatial/path.hpp"
#include "spatial/rotation_rates.hpp"

namespace koppel::test {
namespace {

using Long = long double;
using Time = Dual<Dual<double>>;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr int runs = 500;

/// A vector with cubics as coordinates in B, and B turning in A: everything at one moment.
struct Seen {
  Seen(const RandomTurning& rotation, const CubicVector& s, double t)
      : turning(rotation(differentiable_time(t))),
        in_b(s(differentiable_time(t))),
        in_a(Vector3T<Time>(rotation(differentiable_time(t)) * s(differentiable_time(t)))),
        omega(angular_velocity<double>(turning.value, turning.rate)),
        size(turning.rate.norm() * in_b.value.norm() + in_b.rate.norm()) {}

  TimeDerivatives<Matrix3T<Time>> turning;
  TimeDerivatives<Vector3T<Time>> in_b, in_a;
  Vector3 omega;  ///< in A's axes
  double size;    ///< of the terms of the rates
};

Seen random_view(Random& random) {
  const RandomTurning rotation(random);
  const CubicVector s(random);
  return {rotation, s, random.between(-1, 1)};
}

// Checks K-I-5.1a, K-I-5.1b.
TEST(CoordinateRates, AreThoseOfTheCoordinatesInBothFrames) {
  Random random(1);
  for (int i = 0; i < runs; ++i) {
    const Seen s = random_view(random);
    const Matrix3& r = s.turning.value;
    const Vector3 omega_b = r.transpose() * s.omega;
    const Vector3 in_a = base_coordinate_rates<double>(r, s.in_b.value, s.in_b.rate, omega_b);
    EXPECT_LE((in_a - s.in_a.rate).norm(), 64 * eps * s.size);
    const Vector3 in_b = body_coordinate_rates<double>(r, s.in_a.value, s.in_a.rate, s.omega);
    EXPECT_LE((in_b - s.in_b.rate).norm(), 64 * eps * s.size);
  }
}

// Checks K-I-5.1b.
// The coordinates of each derivative may be transformed, but they stay those of two vectors, apart by omega x s.
TEST(CoordinateRates, BelongToTwoVectors) {
  Random random(2);
  for (int i = 0; i < runs; ++i) {
    const Seen s = random_view(random);
    const Vector3 in_body = s.turning.value * s.in_b.rate, in_base = s.in_a.rate;
    const Vector3 apart = s.omega.cross(s.in_a.value);
    EXPECT_LE((in_base - in_body - apart).norm(), 64 * eps * s.size);
    EXPECT_GT(apart.norm(), 1e-4 * s.size);
  }
}

// Checks K-I-5.1a.
// The rule is one of vectors: in A's axes, in B's and in those of any third frame.
TEST(RelativeDerivative, HoldsInTheAxesOfAnyFrame) {
  Random random(3);
  for (int i = 0; i < runs; ++i) {
    const Seen s = random_view(random);
    const Vector3 in_body = s.turning.value * s.in_b.rate;
    for (const Matrix3& axes :
         {Matrix3(Matrix3::Identity()), Matrix3(s.turning.value.transpose()), random.rotation()}) {
      const Vector3 here = axes * s.in_a.value, turning = axes * s.omega;
      const Vector3 base = axes * s.in_a.rate, body = axes * in_body;
      EXPECT_LE((derivative_in_base<double>(here, body, turning) - base).norm(), 64 * eps * s.size);
      EXPECT_LE((derivative_in_body<double>(here, base, turning) - body).norm(), 64 * eps * s.size);
    }
  }
}

// Checks K-I-5.1a.
TEST(RelativeDerivative, OfABodyFixedVectorIsOmegaCrossIt) {
  Random random(4);
  for (int i = 0; i < runs; ++i) {
    const RandomTurning rotation(random);
    const TimeDerivatives<Matrix3T<Time>> turning(rotation(differentiable_time(random.between(-1, 1))));
    const Vector3 omega = angular_velocity<double>(turning.value, turning.rate);
    for (int k = 0; k < 3; ++k) {
      const Vector3 axis = turning.value.col(k), axis_rate = turning.rate.col(k);
      const Vector3 in_base = derivative_in_base<double>(axis, Vector3::Zero(), omega);
      EXPECT_LE((in_base - omega.cross(axis)).norm(), 2 * eps * omega.norm());
      EXPECT_LE((in_base - axis_rate).norm(), 32 * eps * turning.rate.norm());
      EXPECT_LE(derivative_in_body<double>(axis, axis_rate, omega).norm(), 32 * eps * turning.rate.norm());
    }
    // And what is fixed in A moves in B the other way round.
    const Vector3 fixed = random.vector();
    const Vector3 in_body = derivative_in_body<double>(fixed, Vector3::Zero(), omega);
    EXPECT_LE((in_body + omega.cross(fixed)).norm(), 2 * eps * omega.norm() * fixed.norm());
  }
}

/// The integral from 0 to 1, by Simpson's rule: exact up to cubics.
template <typename Rates>
Vector3 integral(const Rates& rates) {
  return (rates(0.0) + 4 * rates(0.5) + rates(1.0)) / 6;
}

// Checks K-I-5.1c.
// The coordinates in one frame are cubics of time, so that Simpson's rule integrates their rates exactly; in the other
// frame, which turns, they are not. The rates come from that other frame.
TEST(RelativeDerivative, IsIntegratedInTheFrameInWhichItWasTaken) {
  Random random(5);
  for (int i = 0; i < runs; ++i) {
    const RandomTurning rotation(random);
    const CubicVector s_b(random);
    const auto body_rates = [&](double t) -> Vector3 {
      const Seen s(rotation, s_b, t);
      return body_coordinate_rates<double>(s.turning.value, s.in_a.value, s.in_a.rate, s.omega);
    };
    const Seen start(rotation, s_b, 0), end(rotation, s_b, 1);
    const Vector3 change = integral(body_rates);
    const double size = start.size + Seen(rotation, s_b, 0.5).size + end.size;
    EXPECT_LE((start.in_b.value + change - end.in_b.value).norm(), 64 * eps * size);
    EXPECT_GT((change - end.in_b.value).norm(), 1e-3) << "the initial value counts";

    // The same derivative, but integrated by its coordinates in A, leads elsewhere.
    const auto misplaced = [&](double t) -> Vector3 { return rotation(t) * body_rates(t); };
    EXPECT_GT((start.in_a.value + integral(misplaced) - end.in_a.value).norm(), 1e-3);
  }
}

// Checks K-I-5.1c.
// The other way round: cubics in A, rates from their coordinates in B.
TEST(RelativeDerivative, IsIntegratedInTheBaseWhereTakenThere) {
  Random random(6);
  for (int i = 0; i < runs; ++i) {
    const RandomTurning rotation(random);
    const CubicVector s_a(random);
    double size = 0;
    const auto base_rates = [&](double t) -> Vector3 {
      const TimeDerivatives<Matrix3T<Time>> turning(rotation(differentiable_time(t)));
      const TimeDerivatives<Vector3T<Time>> s_b(
          Vector3T<Time>(rotation(differentiable_time(t)).transpose() * s_a(differentiable_time(t))));
      size += turning.rate.norm() * s_b.value.norm() + s_b.rate.norm();
      const Vector3 omega_b = turning.value.transpose() * angular_velocity<double>(turning.value, turning.rate);
      return base_coordinate_rates<double>(turning.value, s_b.value, s_b.rate, omega_b);
    };
    const Vector3 end = s_a(0.0) + integral(base_rates);
    EXPECT_LE((end - s_a(1.0)).norm(), 64 * eps * size);
  }
}

// Checks K-I-5.1d.
// Coordinates of omega in A and in B, both differentiated by dual numbers: one vector.
TEST(RelativeDerivative, OfTheAngularVelocityIsTheSameInBothFrames) {
  Random random(7);
  for (int i = 0; i < runs; ++i) {
    const RandomTurning rotation(random);
    const TimeDerivatives<Matrix3T<Time>> turning(rotation(differentiable_time(random.between(-1, 1))));
    Matrix3T<Dual<double>> r, rate;
    for (int k = 0; k < 9; ++k) {
      r(k) = {turning.value(k), turning.rate(k)};
      rate(k) = {turning.rate(k), turning.second_rate(k)};
    }
    const Vector3T<Dual<double>> omega_a = angular_velocity<Dual<double>>(r, rate), omega_b = r.transpose() * omega_a;
    Vector3 omega, in_a, in_b;
    for (int k = 0; k < 3; ++k) {
      omega[k] = omega_a[k].real;
      in_a[k] = omega_a[k].dual;
      in_b[k] = omega_b[k].dual;
    }
    const double size = turning.second_rate.norm() + turning.rate.squaredNorm();
    EXPECT_LE((in_a - turning.value * in_b).norm(), 64 * eps * size);
    EXPECT_LE((derivative_in_base<double>(omega, in_a, omega) - in_a).norm(), 2 * eps * omega.squaredNorm());
    EXPECT_LE((derivative_in_body<double>(omega, in_a, omega) - in_a).norm(), 2 * eps * omega.squaredNorm());
  }
}

// Checks K-I-5.1a, K-I-5.1b.
TEST(RelativeDerivative, TakesOtherScalars) {
  const Vector3T<Long> s(1, 2, 3), rate(4, 5, 6), omega(0, 0, 2);
  EXPECT_EQ(derivative_in_base<Long>(s, rate, omega), Vector3T<Long>(0, 7, 6));
  EXPECT_EQ(derivative_in_body<Long>(s, derivative_in_base<Long>(s, rate, omega), omega), rate);
  const Matrix3T<Long> quarter = rotation_about<Long>(Vector3T<Long>::UnitZ(), 0, 1);
  EXPECT_EQ(base_coordinate_rates<Long>(quarter, s, rate, omega), Vector3T<Long>(-7, 0, 6));
  EXPECT_EQ(body_coordinate_rates<Long>(quarter, quarter * s, Vector3T<Long>(-7, 0, 6), omega), rate);
  // Twice as fast, twice the difference: the derivative with respect to the rate of turning.
  Vector3T<Dual<double>> vector, still = Vector3T<Dual<double>>::Zero(), turning = still;
  for (int k = 0; k < 3; ++k) vector[k] = k + 1;
  turning.z() = {2, 1};
  EXPECT_EQ(derivative_in_base<Dual<double>>(vector, still, turning).x(), Dual<double>(-4, -2));
}

}  // namespace
}  // namespace koppel::test
