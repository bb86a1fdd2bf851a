// Tensors: what dyads, contractions and projectors do with vectors, and that no frame is better than another.
#include "spatial/tensor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "directions.hpp"
#include "spatial/dual.hpp"

namespace koppel::test {
namespace {

using Long = long double;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr int runs = 1000;

Matrix3 random_tensor(Random& random) {
  Matrix3 d;
  d << random.vector(), random.vector(), random.vector();
  return d;
}

double greatest(const Matrix3& m) { return m.cwiseAbs().maxCoeff(); }

// Checks K-I-2.2.1.
// Both sides are the same products: equal to the last digit where nothing is added.
TEST(Dyad, IsLinearInBothVectorsAndNotCommutative) {
  Random random(1);
  for (int i = 0; i < runs; ++i) {
    const Vector3 a = random.vector(), b = random.vector(), c = random.vector();
    const Matrix3 d = dyad<double>(a, b);
    EXPECT_EQ(Matrix3(d.transpose()), dyad<double>(b, a));
    EXPECT_NE(d, dyad<double>(b, a));
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 3; ++l) EXPECT_EQ(d(k, l), a[k] * b[l]);
    }
    EXPECT_LE(std::abs(d.trace() - a.dot(b)), 2 * eps * a.norm() * b.norm());
    EXPECT_EQ(dyad<double>(2 * a, b), 2 * d);
    EXPECT_EQ(dyad<double>(a, 2 * b), 2 * d);
    EXPECT_LE(greatest(dyad<double>(a, b + c) - d - dyad<double>(a, c)), 2 * eps * 2);
    EXPECT_LE(greatest(dyad<double>(b + c, a) - dyad<double>(b, a) - dyad<double>(c, a)), 2 * eps * 2);
  }
}

// Checks K-I-2.2.1.
// Rank one: every two-rowed minor vanishes.
TEST(Dyad, HasRankOne) {
  Random random(2);
  for (int i = 0; i < runs; ++i) {
    const Vector3 a = random.vector(), b = random.vector();
    const Matrix3 d = dyad<double>(a, b);
    EXPECT_GT(d.norm(), 0);
    for (int k = 0; k < 3; ++k) {
      const Vector3 minors = d.col(k).cross(d.col((k + 1) % 3));
      EXPECT_LE(minors.norm(), 4 * eps * d.col(k).norm() * d.col((k + 1) % 3).norm());
    }
  }
  EXPECT_EQ(dyad<double>(Vector3::Zero(), Vector3(1, 2, 3)), Matrix3::Zero());
}

// Checks K-I-2.2.2.
// Three products and two sums on each side, twice.
TEST(Contraction, IsAssociative) {
  Random random(3);
  for (int i = 0; i < runs; ++i) {
    const Vector3 r = random.vector(), s = random.vector();
    const Matrix3 d = random_tensor(random);
    const double size = r.norm() * d.norm() * s.norm();
    const double one = contraction<double>(r, contraction<double>(d, s));
    const double other = contraction<double>(contraction<double>(r, d), s);
    EXPECT_NEAR(one, other, 6 * eps * size);
    // Written out by coordinates: r_k D_kl s_l.
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      for (int l = 0; l < 3; ++l) sum += r[k] * d(k, l) * s[l];
    }
    EXPECT_NEAR(one, sum, 12 * eps * size);
    EXPECT_EQ(contraction<double>(r, s), contraction<double>(s, r));
    // r . D is not D . r unless D is symmetric.
    const Vector3 transposed = contraction<double>(Matrix3(d.transpose()), r);
    EXPECT_LE((contraction<double>(r, d) - transposed).norm(), 2 * eps * r.norm() * d.norm());
    EXPECT_GT((contraction<double>(r, d) - contraction<double>(d, r)).norm(), 1e-6);
  }
}

// Checks K-I-2.2.3.
TEST(Tensor, IsALinearMap) {
  Random random(4);
  for (int i = 0; i < runs; ++i) {
    const Matrix3 d = random_tensor(random);
    const Vector3 r = random.vector(), s = random.vector();
    const double a = random.between(-2, 2), b = random.between(-2, 2);
    const Vector3 together = contraction<double>(d, a * r + b * s);
    const Vector3 apart = a * contraction<double>(d, r) + b * contraction<double>(d, s);
    const double size = d.norm() * (std::abs(a) * r.norm() + std::abs(b) * s.norm());
    EXPECT_LE((together - apart).norm(), 8 * eps * size);
  }
}

// Checks K-I-2.2.3.
TEST(CrossProductTensor, MultipliesAsTheCrossProductDoes) {
  Random random(5);
  for (int i = 0; i < runs; ++i) {
    const Vector3 a = random.vector(), b = random.vector();
    const Matrix3 r = random.rotation();
    const double size = a.norm() * b.norm();
    EXPECT_EQ(Matrix3(skew(a).transpose()), Matrix3(-skew(a)));
    EXPECT_LE((contraction<double>(skew(a), b) - a.cross(b)).norm(), 2 * eps * size);
    const Matrix3 twice = dyad<double>(b, a) - contraction<double>(a, b) * Matrix3::Identity();
    EXPECT_LE(greatest(skew(a) * skew(b) - twice), 4 * eps * size);
    const Matrix3 turned = skew(vector_in<double>(r, a));
    EXPECT_LE(greatest(turned - tensor_in<double>(r, skew(a))), 16 * eps * a.norm());
    EXPECT_EQ(axial(skew(a)), a);
    EXPECT_EQ(axial(dyad<double>(a, a)), Vector3::Zero()) << "the symmetric part does not count";
  }
}

// Checks K-I-2.2.3.
TEST(Dyad, PullsAVectorOutOfAScalarProduct) {
  Random random(6);
  for (int i = 0; i < runs; ++i) {
    const Vector3 a = random.vector(), b = random.vector(), r = random.vector();
    const Vector3 pulled = contraction<double>(dyad<double>(a, b), r);
    EXPECT_LE((pulled - a * b.dot(r)).norm(), 4 * eps * a.norm() * b.norm() * r.norm());
  }
}

// Checks K-I-2.2.3.
TEST(Projectors, SplitAVectorIntoPartsAlongAndAcross) {
  Random random(7);
  for (int i = 0; i < runs; ++i) {
    const Vector3 u = i < 3 ? Vector3(Vector3::Unit(i)) : random.direction();
    const Vector3 v = random.vector();
    const Matrix3 along = projector_along<double>(u), across = projector_across<double>(u);
    EXPECT_LE(greatest(along + across - Matrix3::Identity()), 4 * eps);
    EXPECT_LE(greatest(along * along - along), 8 * eps);
    EXPECT_LE(greatest(across * across - across), 8 * eps);
    EXPECT_LE(greatest(along * across), 8 * eps);
    EXPECT_LE((along * v - u * u.dot(v)).norm(), 4 * eps);
    EXPECT_LE(std::abs(u.dot(across * v)), 8 * eps);
    EXPECT_LE((across * u).norm(), 8 * eps);
  }
}

// Checks K-I-2.2.4.
TEST(TensorIn, KeepsTheInvariantsAndLeadsBack) {
  Random random(8);
  for (int i = 0; i < runs; ++i) {
    const Matrix3 r = random.rotation(), d = random_tensor(random);
    const Matrix3 there = tensor_in<double>(r, d);
    const double size = d.norm();
    EXPECT_LE(greatest(tensor_in<double>(r.transpose(), there) - d), 24 * eps * size);
    EXPECT_NEAR(there.trace(), d.trace(), 24 * eps * size);
    EXPECT_NEAR(there.determinant(), d.determinant(), 64 * eps * size * size * size);

    // Those of a symmetric tensor are as well determined as its coordinates; of another one they need not be.
    const Matrix3 symmetric = d + d.transpose(), turned = tensor_in<double>(r, symmetric);
    const Vector3 before = Eigen::SelfAdjointEigenSolver<Matrix3>(symmetric).eigenvalues();
    const Vector3 after = Eigen::SelfAdjointEigenSolver<Matrix3>(turned).eigenvalues();
    EXPECT_LE((before - after).cwiseAbs().maxCoeff(), 32 * eps * symmetric.norm());
  }
}

// Checks K-I-2.2.4.
// R_AC = R_AB R_BC, for tensors as for vectors.
TEST(TensorIn, ComposesAsTheRotationsDo) {
  Random random(9);
  for (int i = 0; i < runs; ++i) {
    const Matrix3 r_ab = random.rotation(), r_bc = random.rotation(), d = random_tensor(random);
    const Matrix3 at_once = tensor_in<double>(r_ab * r_bc, d);
    const Matrix3 in_turn = tensor_in<double>(r_ab, tensor_in<double>(r_bc, d));
    EXPECT_LE(greatest(at_once - in_turn), 32 * eps * d.norm());
  }
}

// Checks K-I-2.2.5.
// The four operations, each done in A and in B: scalars are equal, vectors and tensors are the same one.
TEST(NotationMap, GivesTheSameInEveryFrame) {
  Random random(10);
  for (int i = 0; i < runs; ++i) {
    const Matrix3 r_ab = random.rotation();
    const Vector3 a_b = random.vector(), b_b = random.vector();
    const Matrix3 q_b = random_tensor(random);
    const Vector3 a_a = vector_in<double>(r_ab, a_b), b_a = vector_in<double>(r_ab, b_b);
    const Matrix3 q_a = tensor_in<double>(r_ab, q_b);
    const double size = a_b.norm() * b_b.norm();

    EXPECT_NEAR(contraction<double>(a_a, b_a), contraction<double>(a_b, b_b), 16 * eps * size);
    const Vector3 s_a = contraction<double>(q_a, b_a), s_b = contraction<double>(q_b, b_b);
    EXPECT_LE((s_a - vector_in<double>(r_ab, s_b)).norm(), 32 * eps * q_b.norm() * b_b.norm());
    const Vector3 v_a = contraction<double>(skew(a_a), b_a), v_b = contraction<double>(skew(a_b), b_b);
    EXPECT_LE((v_a - vector_in<double>(r_ab, v_b)).norm(), 16 * eps * size);
    const Matrix3 d_a = dyad<double>(a_a, b_a), d_b = dyad<double>(a_b, b_b);
    EXPECT_LE(greatest(d_a - tensor_in<double>(r_ab, d_b)), 16 * eps * size);
  }
}

// Checks K-I-3.2.1.
// Two vectors in one frame, or one vector in two: the same numbers. The rotation tensor itself has the same coordinates
// in the frame from which it turns and in the one to which it turns, and leaves its axis where it is.
TEST(RotationTensor, HasTwoReadings) {
  Random random(11);
  for (int i = 0; i < runs; ++i) {
    const Vector3 u = random.direction(), rho_b = random.vector();
    const Matrix3 r = rotation_about<double>(u, random.between(-3.1, 3.1));
    const Vector3 turned = rotated<double>(r, rho_b), seen = vector_in<double>(r, rho_b);
    EXPECT_EQ(turned, seen);
    EXPECT_NEAR(turned.norm(), rho_b.norm(), 8 * eps);
    EXPECT_LE((vector_in<double>(r.transpose(), seen) - rho_b).norm(), 16 * eps);
    EXPECT_LE(greatest(tensor_in<double>(r.transpose(), r) - r), 24 * eps);
    EXPECT_LE((rotated<double>(r, u) - u).norm(), 8 * eps);
  }
  // A quarter turn about z turns x into y; in the turned frame the unturned x is -y.
  const Matrix3 quarter = rotation_about<double>(Vector3::UnitZ(), 0.0, 1.0);
  EXPECT_EQ(rotated<double>(quarter, Vector3::UnitX()), Vector3::UnitY());
  EXPECT_EQ(vector_in<double>(quarter.transpose(), Vector3::UnitX()), Vector3(-Vector3::UnitY()));
}

// Checks K-I-2.2.1, K-I-2.2.2, K-I-2.2.4.
TEST(Tensor, TakesOtherScalars) {
  Random random(12);
  const Vector3 a = random.vector(), b = random.vector(), rate = random.vector();
  const Matrix3 r = random.rotation();
  const Vector3T<Long> precise_a = a.cast<Long>(), precise_b = b.cast<Long>();
  const Matrix3T<Long> d = dyad(precise_a, precise_b);
  EXPECT_LE(std::abs(tensor_in<Long>(r.cast<Long>(), d).trace() - contraction(precise_a, precise_b)), 16 * eps)
      << "r is a rotation to eps only";

  // The rate of a (b . a) is a' (b . a) + a (b . a').
  Vector3T<Dual<double>> moving, fixed;
  for (int k = 0; k < 3; ++k) {
    moving[k] = {a[k], rate[k]};
    fixed[k] = {b[k], 0};
  }
  const Vector3T<Dual<double>> product = contraction<Dual<double>>(dyad<Dual<double>>(moving, fixed), moving);
  const Vector3 expected = rate * b.dot(a) + a * b.dot(rate);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(product[k].dual, expected[k], 16 * eps);
}

}  // namespace
}  // namespace koppel::test
