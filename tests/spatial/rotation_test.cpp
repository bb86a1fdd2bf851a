// Rotation vectors, quaternions and matrices say the same, from the smallest angles to half a turn.
#include <array>
#include <limits>
#include <numbers>

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "directions.hpp"

namespace koppel::test {
namespace {

using Long = long double;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;
constexpr std::array<double, 11> angles{0.0,     1e-300, 1e-160,    1e-16,      1e-8, 0.99e-4,
                                        1.01e-4, 1.0,    pi - 1e-8, pi - 1e-15, pi};

/// Distance of two rotation vectors relative to their length; at half a turn both signs are the same rotation.
double relative_distance(const Vector3& a, const Vector3& b) {
  const double length = std::max(a.norm(), b.norm());
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

TEST(RotationVector, ReturnsFromItsQuaternionToRounding) {
  for_all_turns([](const Vector3& phi) {
    const Vector3 back = rotation_vector_of_quaternion<double>(quaternion_of_rotation_vector<double>(phi));
    EXPECT_LE(relative_distance(back, phi), 4 * eps) << phi.transpose();
  });
}

// The matrix holds nine numbers of size one: four operations on the way there and as many back.
TEST(RotationVector, ReturnsFromItsMatrixToRounding) {
  for_all_turns([](const Vector3& phi) {
    const Matrix3 r = rotation_of_quaternion<double>(quaternion_of_rotation_vector<double>(phi));
    EXPECT_LE(relative_distance(rotation_vector<double>(r), phi), 8 * eps) << phi.transpose();
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
    const Vector3 exact = rotation_vector<Long>(r.cast<Long>()).cast<double>();
    EXPECT_LE(relative_distance(rotation_vector<double>(r), exact), 16 * eps);
  }
}

TEST(RotationVector, IsTheSameForBothQuaternionsOfARotation) {
  for_all_turns([](const Vector3& phi) {
    const Vector4 q = quaternion_of_rotation_vector<double>(phi);
    EXPECT_EQ(relative_distance(rotation_vector_of_quaternion<double>(q), rotation_vector_of_quaternion<double>(-q)),
              0);
  });
}

TEST(Quaternion, OfAMatrixHasAPositiveFirstPart) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Matrix3 r = random.rotation();
    const Vector4 q = quaternion_of_rotation<double>(r);
    EXPECT_GE(q[0], 0);
    EXPECT_LE(std::abs(q.norm() - 1), 2 * eps);
    EXPECT_LE((rotation_of_quaternion<double>(q) - r).cwiseAbs().maxCoeff(), 8 * eps);
  }
}

TEST(Quaternion, ProductIsTheProductOfTheMatrices) {
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Matrix3 a = random.rotation(), b = random.rotation();
    const Vector4 q = quaternion_product<double>(quaternion_of_rotation<double>(a), quaternion_of_rotation<double>(b));
    EXPECT_LE((rotation_of_quaternion<double>(q) - a * b).cwiseAbs().maxCoeff(), 16 * eps);
  }
}

TEST(Quaternion, NeedNotBeOfUnitLength) {
  const Vector4 q = quaternion_of_rotation_vector<double>({0.3, -0.2, 0.9});
  const Matrix3 r = rotation_of_quaternion<double>(q);
  EXPECT_LE((rotation_of_quaternion<double>(1.001 * q) - r).cwiseAbs().maxCoeff(), 4 * eps);
}

TEST(RotationAbout, IsOrthogonalAndTurnsTheRightWay) {
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const Matrix3 r = random.rotation();
    EXPECT_LE((r * r.transpose() - Matrix3::Identity()).cwiseAbs().maxCoeff(), 8 * eps);
  }
  const Matrix3 quarter = rotation_about<double>(Vector3::UnitZ(), pi / 2);
  EXPECT_LE((quarter * Vector3::UnitX() - Vector3::UnitY()).norm(), eps);
}

/// d(log(exp(phi) exp(delta)))/d(delta) at 0, by dual numbers.
Matrix3 logarithm_derivative(const Vector3& phi) {
  using Dual = ceres::Jet<double, 3>;
  Vector3T<Dual> start, delta;
  for (int i = 0; i < 3; ++i) {
    start[i] = Dual(phi[i]);
    delta[i] = Dual(0.0, i);
  }
  const Vector3T<Dual> moved = rotation_vector_of_quaternion<Dual>(
      quaternion_product<Dual>(quaternion_of_rotation_vector<Dual>(start), quaternion_of_rotation_vector<Dual>(delta)));
  return Matrix3::NullaryExpr([&](Eigen::Index i, Eigen::Index j) { return moved[i].v[j]; });
}

// The derivative of the norm loses digits as 1/angle where the angle is small; the series does not.
TEST(RightJacobianInverse, IsTheDerivativeOfTheLogarithm) {
  Random random(6);
  for (const double angle : {0.0, 1e-300, 1e-8, 0.99e-2, 1.01e-2, 0.5, 1.0, 2.0, 3.0, pi - 1e-3, pi - 1e-8}) {
    for (int i = 0; i < 20; ++i) {
      const Vector3 phi = angle * random.direction();
      EXPECT_LE((right_jacobian_inverse<double>(phi) - logarithm_derivative(phi)).cwiseAbs().maxCoeff(), 64 * eps)
          << "at " << angle;
    }
  }
}

TEST(RightJacobianInverse, HasNoSeamWhereTheSeriesEnds) {
  const Vector3 u = Vector3(1, 2, 2) / 3;
  const Matrix3 below = right_jacobian_inverse<double>(0.01 * (1 - 1e-13) * u);
  const Matrix3 above = right_jacobian_inverse<double>(0.01 * (1 + 1e-13) * u);
  EXPECT_LE((above - below).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Tangents, CompleteTheNormalToARightHandedFrame) {
  Random random(7);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 n = i < 3 ? Vector3(Vector3::Unit(i)) : random.direction();
    Matrix3 frame;
    frame << tangents<double>(n), n;
    EXPECT_LE((frame.transpose() * frame - Matrix3::Identity()).cwiseAbs().maxCoeff(), 4 * eps);
    EXPECT_NEAR(frame.determinant(), 1, 8 * eps);
  }
}

}  // namespace
}  // namespace koppel::test
