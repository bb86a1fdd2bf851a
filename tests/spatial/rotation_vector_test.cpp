// Rotation vectors, quaternions and matrices say the same, from the smallest angles to half a turn and beyond.
#include "spatial/rotation_vector.hpp"

#include <array>
#include <limits>
#include <numbers>

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "directions.hpp"
#include "spatial/axis_angle.hpp"

namespace koppel::test {
namespace {

using Long = long double;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;
constexpr std::array<double, 13> angles{0.0, 1e-300, 1e-160,    1e-16,      1e-8, 0.99e-4, 1.01e-4,
                                        1.0, 2.0,    pi - 1e-8, pi - 1e-15, pi,   2.5};

/// Distance of two rotation vectors relative to their length; at half a turn both signs are the same rotation.
double relative_distance(const Vector3& a, const Vector3& b) {
  const double length = std::max(a.stableNorm(), b.stableNorm());
  if (!(length > 0)) return 0;
  const double apart = (a - b).stableNorm() / length;
  return length > pi - 1e-12 ? std::min(apart, (a + b).stableNorm() / length) : apart;
}

/// Calls with every angle about many directions, the axes among them.
template <typename Check>
void for_all_turns(const Check& check) {
  Random random(1);
  for (const double angle : angles) {
    for (int i = 0; i < 50; ++i) check(Vector3(angle * (i < 3 ? Vector3(Vector3::Unit(i)) : random.direction())));
  }
}

// Checks K-I-4.5.2, K-I-4.2.2.
TEST(RotationVector, ReturnsFromItsQuaternionToRounding) {
  for_all_turns([](const Vector3& phi) {
    const Vector3 back = rotation_vector_of_quaternion<double>(quaternion_of_rotation_vector<double>(phi));
    EXPECT_LE(relative_distance(back, phi), 4 * eps) << phi.transpose();
  });
}

// Checks K-I-4.2.2, K-I-3.2.0.
// The matrix holds nine numbers of size one: four operations on the way there and as many back.
TEST(RotationVector, ReturnsFromItsMatrixToRounding) {
  for_all_turns([](const Vector3& phi) {
    const Matrix3 r = rotation_of_rotation_vector<double>(phi);
    EXPECT_LE(relative_distance(rotation_vector_of_rotation<double>(r), phi), 8 * eps) << phi.transpose();
  });
}

TEST(RotationVector, HasTheQuaternionOfHigherPrecision) {
  for_all_turns([](const Vector3& phi) {
    const Vector4T<Long> exact = quaternion_of_rotation_vector<Long>(phi.cast<Long>());
    const Vector4 q = quaternion_of_rotation_vector<double>(phi);
    for (int i = 0; i < 4; ++i) {
      // The angle is known to two units of rounding; where its cosine vanishes, that is what is left.
      EXPECT_LE(std::abs(q[i] - static_cast<double>(exact[i])), 4 * eps * (i == 0 ? 1.0 : std::abs(q[i])))
          << phi.transpose();
    }
  });
}

TEST(RotationVector, IsThatOfHigherPrecision) {
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Matrix3 r = random.rotation();
    const Vector3 exact = rotation_vector_of_rotation<Long>(r.cast<Long>()).cast<double>();
    EXPECT_LE(relative_distance(rotation_vector_of_rotation<double>(r), exact), 16 * eps);
  }
}

TEST(RotationVector, IsTheSameForBothQuaternionsOfARotationAndForAnyLength) {
  for_all_turns([](const Vector3& phi) {
    const Vector4 q = quaternion_of_rotation_vector<double>(phi);
    const Vector3 back = rotation_vector_of_quaternion<double>(q);
    EXPECT_EQ(relative_distance(back, rotation_vector_of_quaternion<double>(-q)), 0);
    EXPECT_LE(relative_distance(back, rotation_vector_of_quaternion<double>(3 * q)), 4 * eps);
  });
}

/// exp(M) by its series on a matrix halved until it is small, then squared as often: in long double, and only from
/// matrices.
Matrix3T<Long> matrix_exponential(const Matrix3T<Long>& m) {
  const Matrix3T<Long> small = m / 1024;
  Matrix3T<Long> sum = Matrix3T<Long>::Identity(), term = sum;
  for (int n = 1; n < 20; ++n) sum += (term = term * small / static_cast<Long>(n));
  for (int n = 0; n < 10; ++n) sum = sum * sum;
  return sum;
}

// Checks K-I-4.2.1b.
// Squaring ten times leaves 1024 units of long double: half a unit of double.
TEST(RotationVector, HasTheMatrixExponential) {
  const auto check = [](const Vector3& phi) {
    const Matrix3 r = rotation_of_rotation_vector<double>(phi);
    const Matrix3T<Long> exact = matrix_exponential(skew(phi.cast<Long>()));
    // The angle itself has two units of rounding of its size.
    EXPECT_LE((r.cast<Long>() - exact).cwiseAbs().maxCoeff(), (4 + 2 * phi.norm()) * eps) << phi.transpose();
  };
  for_all_turns(check);
  Random random(3);
  for (int n = 0; n < 1000; ++n) check(10 * random.vector());
}

// Checks K-I-4.2.1b.
TEST(RotationVector, OfAUnitAxisHasTheThreeTermsOfCayleyAndHamilton) {
  Random random(4);
  const Vector3 u = random.direction();
  const Matrix3 t = skew(u);
  EXPECT_LE((t * t - (u * u.transpose() - Matrix3::Identity())).cwiseAbs().maxCoeff(), 4 * eps);
  EXPECT_LE((t * t * t + t).cwiseAbs().maxCoeff(), 4 * eps) << "eigenvalues 0, i, -i";
}

/// The rule of the book: of |sin b| and the |u_k| the largest, from the cosine; the others by dividing by it
/// (K-I-4.2.2).
Vector4 axis_angle_from_cosines(const Matrix3& r) {
  const double c = (r.trace() - 1) / 2;
  const auto root = [](double radicand) { return std::sqrt(std::max(radicand, 0.0)); };
  const double s = root(1 - c * c);
  const Vector3 sizes(root((r(0, 0) - c) / (1 - c)), root((r(1, 1) - c) / (1 - c)), root((r(2, 2) - c) / (1 - c)));
  Eigen::Index k = 0;
  if (s >= sizes.maxCoeff(&k)) return (Vector4() << axial(r) / s, std::atan2(s, c)).finished();
  Vector3 u;
  u[k] = sizes[k];
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (i != k) u[i] = (r(i, k) + r(k, i)) / (2 * (1 - c) * u[k]);
  }
  return (Vector4() << u, std::atan2(axial(r)[k] / u[k], c)).finished();
}

// Checks K-I-4.2.2.
// By way of the cosine an error of the angle grows as its inverse square: that is why the quaternion is the way.
TEST(AxisAngle, IsThatOfTheBooksRuleWhereThatRuleIsGood) {
  Random random(5);
  for (const double angle : {0.01, 0.1, 0.5, 1.0, pi / 2, 2.0, 3.0, pi - 1e-9, pi}) {
    for (int n = 0; n < 100; ++n) {
      const Vector3 u = random.direction();
      const Matrix3 r = rotation_about<double>(u, angle);
      const Vector4 book = axis_angle_from_cosines(r), ours = extracted<AxisAngle, double>(r).coordinates;
      const double apart = std::min((book - ours).norm(), (book + ours).norm());
      // At half a turn (u, pi) and (-u, pi) are the same as well.
      const double turned = (Vector4() << book.head<3>() + ours.head<3>(), book[3] - ours[3]).finished().norm();
      EXPECT_LE(std::min(apart, turned), 16 * eps * (1 + 1 / (angle * angle))) << angle;
    }
  }
}

// Checks K-I-4.2.2.
TEST(AxisAngle, KeepsAxisAndAngleAtEverySpecialAngle) {
  for (const double angle : {1e-300, 1e-160, 1e-16, 1e-9, 1e-6, 1e-3, 0.5, pi / 2, pi - 1e-9, pi, -pi / 2}) {
    for (const Vector3& axis : {Vector3(1, 0, 0), Vector3(0, 1, 0), Vector3(0, 0, 1), Vector3(1, 1, 0),
                                Vector3(1, 1, 1), Vector3(-0.3, 0.8, 0.2)}) {
      const Vector3 u = axis.normalized();
      const Matrix3 r = rotation_about<double>(u, angle);
      const auto back = extracted<AxisAngle, double>(r);
      const double side = back.coordinates.head<3>().dot(u) < 0 ? -1 : 1;
      EXPECT_LE((back.coordinates.head<3>() - side * u).norm(), 8 * eps) << angle;
      if (angle < pi) {
        EXPECT_LE(std::abs(side * back.coordinates[3] - angle), 4 * eps * std::abs(angle));
      }
      EXPECT_LE((rotation<AxisAngle, double>(back.coordinates) - r).cwiseAbs().maxCoeff(), 4 * eps);
      EXPECT_EQ(back.singular, angle < 1e-15 && angle > 0) << "an angle of rounding size has an axis of chance";
    }
  }
}

// Checks K-I-4.2.2, K-I-4.2.4.
TEST(AxisAngle, OfTheIdentityKeepsThePreviousAxis) {
  const Vector3 previous = Vector3(1, 2, 2) / 3;
  const auto back = AxisAngle::of_quaternion<double>(Vector4::Unit(0), previous);
  EXPECT_TRUE(back.singular);
  EXPECT_EQ(back.coordinates, (Vector4() << previous, 0).finished());
  EXPECT_FALSE(AxisAngle::k_matrix<double>(back.coordinates, Axes::base)) << "no axis, no rate of the axis";
  EXPECT_FALSE(AxisAngle::k_matrix<double>((Vector4() << previous, 2 * pi).finished(), Axes::base));
  EXPECT_TRUE(AxisAngle::k_matrix<double>((Vector4() << previous, pi).finished(), Axes::base));
}

// Checks K-I-4.2.4.
TEST(AxisAngle, HasTheBooksMatrices) {
  Random random(6);
  for (const double angle : {1e-4, 0.5, pi / 2, 3.0, pi, 5.0}) {
    const Vector3 u = random.direction(), omega = random.vector();
    const Vector4 at = (Vector4() << u, angle).finished();
    const double s = std::sin(angle), c = std::cos(angle), cotangent = s / (1 - c);
    for (const Axes axes : {Axes::base, Axes::body}) {
      const double sign = axes == Axes::base ? 1 : -1;
      const Vector4 rate = random.direction().homogeneous();
      const Vector3 book = rate[3] * u + s * rate.head<3>() + sign * (1 - c) * u.cross(Vector3(rate.head<3>()));
      EXPECT_LE((AxisAngle::h_matrix<double>(at, axes) * rate - book).norm(), 8 * eps);
      const Vector4 found = *AxisAngle::k_matrix<double>(at, axes) * omega;
      const Vector3 axis_rate = (cotangent * (omega - u.dot(omega) * u) - sign * u.cross(omega)) / 2;
      // The book's quotient cancels at small angles: its own error is eps / angle^2.
      EXPECT_LE((found.head<3>() - axis_rate).norm(),
                16 * eps * (1 + std::abs(cotangent) + 1 / (angle * angle * angle)));
      EXPECT_NEAR(found[3], u.dot(omega), 4 * eps);
    }
  }
}

// Checks K-I-4.2.4.
TEST(RotationVector, HasNoRateAtAFullTurnButHasAtZero) {
  const Vector3 u = Vector3(1, 2, 2) / 3;
  EXPECT_TRUE(RotationVector::k_matrix<double>(Vector3::Zero(), Axes::base));
  EXPECT_FALSE(RotationVector::k_matrix<double>(2 * pi * u, Axes::base));
  EXPECT_FALSE(RotationVector::k_matrix<double>(4 * pi * u, Axes::body));
  EXPECT_TRUE(RotationVector::k_matrix<double>((2 * pi - 1e-6) * u, Axes::base));
  EXPECT_FALSE(RotationVector::twin<double>(Vector3::Zero()));
}

/// d(log(exp(phi) exp(delta)))/d(delta) at 0, by dual numbers.
Matrix3 logarithm_derivative(const Vector3& phi) {
  using Jet = ceres::Jet<double, 3>;
  Vector3T<Jet> start, delta;
  for (int i = 0; i < 3; ++i) {
    start[i] = Jet(phi[i]);
    delta[i] = Jet(0.0, i);
  }
  const Vector3T<Jet> moved = rotation_vector_of_quaternion<Jet>(
      quaternion_product<Jet>(quaternion_of_rotation_vector<Jet>(start), quaternion_of_rotation_vector<Jet>(delta)));
  return Matrix3::NullaryExpr([&](Eigen::Index i, Eigen::Index j) { return moved[i].v[j]; });
}

// Checks K-I-4.2.4.
// The derivative of the norm loses digits as 1/angle where the angle is small; the series does not.
TEST(RightJacobianInverse, IsTheDerivativeOfTheLogarithm) {
  Random random(7);
  for (const double angle : {0.0, 1e-300, 1e-8, 0.99e-2, 1.01e-2, 0.5, 1.0, 1.99, 2.01, 3.0, pi - 1e-3, pi - 1e-8}) {
    for (int i = 0; i < 20; ++i) {
      const Vector3 phi = angle * random.direction();
      EXPECT_LE((right_jacobian_inverse<double>(phi) - logarithm_derivative(phi)).cwiseAbs().maxCoeff(), 64 * eps)
          << "at " << angle;
    }
  }
}

// Checks K-I-4.2.4.
TEST(RightJacobian, IsUndoneByItsInverseAndTransposedFromLeftToRight) {
  for_all_turns([](const Vector3& phi) {
    const Matrix3 right = right_jacobian<double>(phi), left = left_jacobian<double>(phi);
    EXPECT_LE((right * right_jacobian_inverse<double>(phi) - Matrix3::Identity()).cwiseAbs().maxCoeff(), 16 * eps);
    EXPECT_LE((left - right.transpose()).cwiseAbs().maxCoeff(), 2 * eps);
    EXPECT_LE((left - rotation_of_rotation_vector<double>(phi) * right).cwiseAbs().maxCoeff(), 16 * eps);
  });
}

TEST(RightJacobianInverse, HasNoSeamWhereTheSeriesEnds) {
  const Vector3 u = Vector3(1, 2, 2) / 3;
  const Matrix3 below = right_jacobian_inverse<double>(2 * (1 - 1e-13) * u);
  const Matrix3 above = right_jacobian_inverse<double>(2 * (1 + 1e-13) * u);
  EXPECT_LE((above - below).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace
}  // namespace koppel::test
