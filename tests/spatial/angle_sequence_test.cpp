// Euler and Cardan angles: the closed forms of the book, all twelve sequences, and gimbal lock.
#include "spatial/angle_sequence.hpp"

#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "directions.hpp"
#include "every_coordinates.hpp"
#include "spatial/rotation.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;

template <int i, int j, int k>
Matrix3 three_turns(AngleSequence<i, j, k>, const Vector3& a) {
  return rotation_about<double>(Vector3::Unit(i), a[0]) * rotation_about<double>(Vector3::Unit(j), a[1]) *
         rotation_about<double>(Vector3::Unit(k), a[2]);
}

template <typename C>
class Sequence : public testing::Test {};
using EverySequence =
    testing::Types<AngleSequence<0, 1, 2>, AngleSequence<0, 2, 1>, AngleSequence<1, 0, 2>, AngleSequence<1, 2, 0>,
                   AngleSequence<2, 0, 1>, AngleSequence<2, 1, 0>, AngleSequence<0, 1, 0>, AngleSequence<0, 2, 0>,
                   AngleSequence<1, 0, 1>, AngleSequence<1, 2, 1>, AngleSequence<2, 0, 2>, AngleSequence<2, 1, 2>>;
TYPED_TEST_SUITE(Sequence, EverySequence, NamesOfCoordinates);

/// A middle angle within its range: the sequence's own, if it is regular.
template <typename C>
double middle(Random& random) {
  return C::is_euler ? random.between(0.05, pi - 0.05) : random.between(-pi / 2 + 0.05, pi / 2 - 0.05);
}
template <typename C>
double locked(bool upper, double off) {
  if (C::is_euler) return upper ? pi - off : off;
  return upper ? pi / 2 - off : off - pi / 2;
}

// Checks K-I-4.3.0.
TYPED_TEST(Sequence, IsThreeElementaryTurns) {
  using C = TypeParam;
  Random random(1);
  for (int n = 0; n < 1000; ++n) {
    const Vector3 a = 3 * random.vector();
    EXPECT_LE((C::template rotation<double>(a) - three_turns(C(), a)).cwiseAbs().maxCoeff(), 4 * eps);
    EXPECT_LE(
        (rotation_of_quaternion<double>(C::template quaternion<double>(a)) - three_turns(C(), a)).cwiseAbs().maxCoeff(),
        16 * eps);
  }
}

// Checks K-I-4.3.0.
TYPED_TEST(Sequence, ComesBackFromItsMatrix) {
  using C = TypeParam;
  Random random(2);
  for (int n = 0; n < 1000; ++n) {
    const Vector3 a(random.between(-3.1, 3.1), middle<C>(random), random.between(-3.1, 3.1));
    const auto back = extracted<C, double>(C::template rotation<double>(a));
    EXPECT_FALSE(back.singular);
    // The outer angles are worse determined by 1 / sin or cos of the middle one.
    EXPECT_LE((back.coordinates - a).cwiseAbs().maxCoeff(), 16 * eps * C::template condition<double>(a));
  }
}

// Checks K-I-4.3.0, K-I-4.3.1, K-I-4.4.1.
TYPED_TEST(Sequence, MakesTheMatrixAgainHoweverNearToGimbalLock) {
  using C = TypeParam;
  Random random(3);
  for (const double off : {1.0, 1e-2, 1e-5, 1e-7, 1e-9, 1e-12, 1e-14, 1e-15, 1e-16, 1e-200, 0.0}) {
    for (const bool upper : {false, true}) {
      for (int n = 0; n < 50; ++n) {
        const Vector3 a(random.between(-3.1, 3.1), locked<C>(upper, off), random.between(-3.1, 3.1));
        const Matrix3 there = random.rotation();
        const Matrix3 r = there * (there.transpose() * three_turns(C(), a));  // rounded like any other matrix
        const auto back = extracted<C, double>(r);
        EXPECT_LE((three_turns(C(), back.coordinates) - r).cwiseAbs().maxCoeff(), 24 * eps) << a.transpose();
        if (off < 1e-16) {
          const auto pure = extracted<C, double>(three_turns(C(), a));
          EXPECT_TRUE(pure.singular);
        }
        if (off > 1e-13) {
          EXPECT_FALSE(back.singular);
        }
      }
    }
  }
}

// Checks K-I-4.3.0, K-I-4.3.2, K-I-4.4.2.
TYPED_TEST(Sequence, RefusesRatesInGimbalLockOnly) {
  using C = TypeParam;
  for (const bool upper : {false, true}) {
    const auto k = [&](double off) {
      return C::template k_matrix<double>(Vector3(0.3, locked<C>(upper, off), 0.4), Axes::base);
    };
    EXPECT_FALSE(k(0));
    ASSERT_TRUE(k(1e-10));
    EXPECT_NEAR(k(1e-10)->cwiseAbs().maxCoeff() / 1e10, 1, 0.1);
    EXPECT_NEAR(C::template condition<double>(Vector3(0, locked<C>(upper, 1e-3), 0)), 1e3, 1);
  }
}

// Checks K-I-4.3.0.
// Turn after turn about the axis where it then is: each from the left, and the columns of H are these axes.
TYPED_TEST(Sequence, TurnsAboutAxesThatAreCarriedAlong) {
  using C = TypeParam;
  Random random(4);
  const Vector3 a = random.vector();
  const Matrix3 carried = C::template h_matrix<double>(a, Axes::base);
  Matrix3 r = Matrix3::Identity();
  for (int n = 0; n < 3; ++n) r = rotation_about<double>(Vector3(carried.col(n)), a[n]) * r;
  EXPECT_LE((r - C::template rotation<double>(a)).cwiseAbs().maxCoeff(), 8 * eps);
}

// Checks K-I-4.3.1.
TEST(EulerAngles, MakeTheBooksMatrix) {
  Random random(5);
  for (int n = 0; n < 100; ++n) {
    const Vector3 a = 3 * random.vector();
    const double cps = std::cos(a[0]), sps = std::sin(a[0]), cth = std::cos(a[1]), sth = std::sin(a[1]);
    const double cph = std::cos(a[2]), sph = std::sin(a[2]);
    Matrix3 r;
    r << cps * cph - sps * cth * sph, -cps * sph - sps * cth * cph, sps * sth,  //
        sps * cph + cps * cth * sph, -sps * sph + cps * cth * cph, -cps * sth,  //
        sth * sph, sth * cph, cth;
    EXPECT_LE((EulerAngles::rotation<double>(a) - r).cwiseAbs().maxCoeff(), 4 * eps);
  }
}

// Checks K-I-4.3.1, K-I-4.4.1, K-I-4.3.2, K-I-4.4.2.
// Both configurations of the equivalent chains of three revolute joints reach the same end position.
TEST(EulerAngles, OfAGridAreFoundWithTheirTwin) {
  for (double psi = -3; psi <= 3; psi += 0.5) {
    for (double theta = 0; theta <= pi; theta += pi / 16) {
      const Vector3 a(psi, theta, 0.7);
      const auto back = extracted<EulerAngles, double>(EulerAngles::rotation<double>(a));
      const Vector3 twin = EulerAngles::twin<double>(back.coordinates);
      EXPECT_LE((EulerAngles::rotation<double>(twin) - EulerAngles::rotation<double>(a)).cwiseAbs().maxCoeff(),
                16 * eps);
      EXPECT_EQ(back.singular, theta < 0.1 || theta > 3.1);
      const Vector3 twice = CardanAngles::twin<double>(CardanAngles::twin<double>(a - Vector3(0, pi / 2, 0)));
      EXPECT_LE((twice - a + Vector3(0, pi / 2, 0)).cwiseAbs().maxCoeff(), 4 * eps);
    }
  }
}

// Checks K-I-4.3.2.
TEST(EulerAngles, HaveTheBooksMatrices) {
  const double psi = 0.4, theta = 1.1, phi = -2.0;
  const double cps = std::cos(psi), sps = std::sin(psi), cth = std::cos(theta), sth = std::sin(theta);
  const double cph = std::cos(phi), sph = std::sin(phi);
  Matrix3 h_base, k_base, h_body, k_body;
  h_base << 0, cps, sps * sth, 0, sps, -cps * sth, 1, 0, cth;
  k_base << -sps * cth, cps * cth, sth, cps * sth, sps * sth, 0, sps, -cps, 0;
  h_body << sph * sth, cph, 0, cph * sth, -sph, 0, cth, 0, 1;
  k_body << sph, cph, 0, cph * sth, -sph * sth, 0, -sph * cth, -cph * cth, sth;
  const Vector3 a(psi, theta, phi);
  EXPECT_LE((EulerAngles::h_matrix<double>(a, Axes::base) - h_base).cwiseAbs().maxCoeff(), 2 * eps);
  EXPECT_LE((EulerAngles::h_matrix<double>(a, Axes::body) - h_body).cwiseAbs().maxCoeff(), 4 * eps);
  EXPECT_LE((*EulerAngles::k_matrix<double>(a, Axes::base) - k_base / sth).cwiseAbs().maxCoeff(), 8 * eps);
  EXPECT_LE((*EulerAngles::k_matrix<double>(a, Axes::body) - k_body / sth).cwiseAbs().maxCoeff(), 8 * eps);
}

// Checks K-I-4.4.1, K-I-4.4.2.
TEST(CardanAngles, MakeTheBooksMatrices) {
  const double al = 0.4, be = 0.9, ga = -2.0;
  const double cal = std::cos(al), sal = std::sin(al), cbe = std::cos(be), sbe = std::sin(be);
  const double cga = std::cos(ga), sga = std::sin(ga);
  Matrix3 r, h_base, k_base, h_body, k_body;
  r << cbe * cga, -cbe * sga, sbe, cal * sga + sal * sbe * cga, cal * cga - sal * sbe * sga, -sal * cbe,
      sal * sga - cal * sbe * cga, sal * cga + cal * sbe * sga, cal * cbe;
  h_base << 1, 0, sbe, 0, cal, -sal * cbe, 0, sal, cal * cbe;
  k_base << cbe, sal * sbe, -cal * sbe, 0, cal * cbe, sal * cbe, 0, -sal, cal;
  h_body << cbe * cga, sga, 0, -cbe * sga, cga, 0, sbe, 0, 1;
  k_body << cga, -sga, 0, cbe * sga, cbe * cga, 0, -sbe * cga, sbe * sga, cbe;
  const Vector3 a(al, be, ga);
  EXPECT_LE((CardanAngles::rotation<double>(a) - r).cwiseAbs().maxCoeff(), 4 * eps);
  EXPECT_LE((CardanAngles::h_matrix<double>(a, Axes::base) - h_base).cwiseAbs().maxCoeff(), 2 * eps);
  EXPECT_LE((CardanAngles::h_matrix<double>(a, Axes::body) - h_body).cwiseAbs().maxCoeff(), 4 * eps);
  EXPECT_LE((*CardanAngles::k_matrix<double>(a, Axes::base) - k_base / cbe).cwiseAbs().maxCoeff(), 8 * eps);
  EXPECT_LE((*CardanAngles::k_matrix<double>(a, Axes::body) - k_body / cbe).cwiseAbs().maxCoeff(), 8 * eps);
}

// Checks K-I-4.3.1, K-I-4.4.1.
TEST(GimbalLock, LeavesTheThirdAngleAtZero) {
  const auto check = [](auto sequence, const Vector3& a, double left) {
    using C = decltype(sequence);
    const auto back = extracted<C, double>(three_turns(sequence, a));
    EXPECT_TRUE(back.singular);
    EXPECT_NEAR(back.coordinates[0], left, 4 * eps);
    EXPECT_NEAR(back.coordinates[1], a[1], 4 * eps);
    EXPECT_EQ(back.coordinates[2], 0);
  };
  check(CardanAngles(), {0.3, pi / 2, 0.4}, 0.7);
  check(CardanAngles(), {0.3, -pi / 2, 0.4}, -0.1);
  check(YawPitchRoll(), {0.3, pi / 2, 0.4}, -0.1);
  check(YawPitchRoll(), {0.3, -pi / 2, 0.4}, 0.7);
  check(EulerAngles(), {0.3, 0, 0.4}, 0.7);
  check(EulerAngles(), {0.3, pi, 0.4}, -0.1);
}

// A small turn has three small angles, each to its own digits.
TEST(CardanAngles, OfATinyTurnKeepTheirDigits) {
  for (const double size : {1e-3, 1e-9, 1e-100}) {
    const Vector3 a = size * Vector3(0.3, -0.5, 0.7);
    const auto back = CardanAngles::of_quaternion<double>(CardanAngles::quaternion<double>(a));
    EXPECT_LE((back.coordinates - a).cwiseAbs().maxCoeff(), 8 * eps * size);
  }
}

}  // namespace
}  // namespace koppel::test
