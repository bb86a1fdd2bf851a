// What must hold for every kind of rotation coordinates, checked for all seventeen of them by one suite.
#include "spatial/rotation_coordinates.hpp"

#include <limits>
#include <numbers>

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include "directions.hpp"
#include "every_coordinates.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;
constexpr Axes both_axes[] = {Axes::base, Axes::body};

template <typename C>
using Column = Eigen::Matrix<double, C::size, 1>;

/// Largest entry: of a difference, the error; of H and K, what multiplies it.
template <typename Derived>
double size_of(const Eigen::MatrixBase<Derived>& m) {
  return m.cwiseAbs().maxCoeff();
}

/// Turns about the axes and between them, by the angles at which something may happen.
std::vector<Vector4> special_quaternions() {
  std::vector<Vector4> all;
  for (const double angle : {0.0, 1e-300, 1e-160, 1e-16, 1e-8, pi / 2 - 1e-8, pi / 2, 2.0, pi - 1e-8, pi, -pi / 2}) {
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          if (x == 0 && y == 0 && z == 0) continue;
          const Vector3 u = Vector3(x, y, z).normalized();
          all.push_back((Vector4() << std::cos(angle / 2), std::sin(angle / 2) * u).finished());
        }
      }
    }
  }
  return all;
}

template <typename C>
class Coordinates : public testing::Test {
 protected:
  /// Calls with coordinates of many rotations at which K exists, and with the entries' size of H and K there.
  template <typename Check>
  void for_regular(const Check& check) const {
    Random random(1);
    for (int n = 0; n < 1000; ++n) {
      const auto x = C::template of_quaternion<double>(random.quaternion());
      const auto k = C::template k_matrix<double>(x.coordinates, Axes::base);
      if (x.singular || !k) continue;
      check(x.coordinates, 1 + size_of(C::template h_matrix<double>(x.coordinates, Axes::base)) * size_of(*k), random);
    }
  }
};
TYPED_TEST_SUITE(Coordinates, EveryCoordinates, NamesOfCoordinates);

// Checks K-I-4.0a, K-I-4.7, K-I-4.3.1, K-I-4.4.1, K-I-4.5.3, K-I-4.6.1, K-I-3.2.0.
// However singular the rotation is for the coordinates, they make it again, and are finite.
TYPED_TEST(Coordinates, MakeTheRotationThatTheyAreOf) {
  using C = TypeParam;
  Random random(2);
  auto quaternions = special_quaternions();
  for (int n = 0; n < 1000; ++n) quaternions.push_back(random.quaternion());
  for (const Vector4& q : quaternions) {
    const auto x = C::template of_quaternion<double>(q);
    ASSERT_TRUE(x.coordinates.allFinite()) << q.transpose();
    // A rotation through the worst of them: a tangent and its arc, each by some units of rounding of an angle of pi.
    EXPECT_LE(size_of(rotation<C, double>(x.coordinates) - rotation_of_quaternion<double>(q)), 16 * eps)
        << q.transpose() << " as " << x.coordinates.transpose();
  }
}

TYPED_TEST(Coordinates, HaveOneRotationByMatrixAndByQuaternion) {
  using C = TypeParam;
  this->for_regular([](const Column<C>& x, double, Random&) {
    EXPECT_LE(size_of(rotation<C, double>(x) - rotation_of_quaternion<double>(C::template quaternion<double>(x))),
              16 * eps);
  });
}

TYPED_TEST(Coordinates, AreThoseOfTheMatrixToo) {
  using C = TypeParam;
  this->for_regular([](const Column<C>& x, double condition, Random&) {
    const Matrix3 r = rotation<C, double>(x);
    const auto back = extracted<C, double>(r);
    const double off = size_of(back.coordinates - x);
    // q and -q, an axis turned round at half a turn: the same rotation.
    if (off > 0.5) {
      EXPECT_LE(size_of(rotation<C, double>(back.coordinates) - r), 16 * eps);
    } else {
      EXPECT_LE(off, 16 * eps * condition * (1 + size_of(x)));
    }
  });
}

// Checks K-I-4.0a, K-I-4.2.4, K-I-4.3.2, K-I-4.4.2, K-I-4.5.5, K-I-4.6.2, K-I-4.1.2, K-I-3.2.2.
// The rate of the matrix is exact, by dual numbers; its axial vector is what H must give.
TYPED_TEST(Coordinates, TurnTheBodyAsTheirHMatrixSays) {
  using C = TypeParam;
  this->for_regular([](const Column<C>& x, double condition, Random& random) {
    for (const Axes axes : both_axes) {
      const Vector3 omega = random.vector();
      const Column<C> rates = *coordinate_rates<C, double>(x, omega, axes);
      const Matrix3T<Dual<double>> moving = rotation<C, Dual<double>>(dual(x, rates));
      const Matrix3 r = real_part(moving), r_rate = dual_part(moving);
      const Vector3 turned = axes == Axes::base ? axial(r_rate * r.transpose()) : axial(r.transpose() * r_rate);
      EXPECT_LE(size_of(turned - omega), 16 * eps * condition);
      EXPECT_LE(size_of(angular_velocity<C, double>(x, rates, axes) - omega), 16 * eps * condition);
      // The rest of R' R^T, its symmetric part, is nothing.
      const Matrix3 product = r_rate * r.transpose();
      EXPECT_LE(size_of(product + product.transpose()), 32 * eps * condition);
    }
  });
}

// Checks K-I-4.0a.
TYPED_TEST(Coordinates, HaveOneHMatrixInBothAxes) {
  using C = TypeParam;
  this->for_regular([](const Column<C>& x, double condition, Random&) {
    const auto base = C::template h_matrix<double>(x, Axes::base);
    const auto body = C::template h_matrix<double>(x, Axes::body);
    EXPECT_LE(size_of(rotation<C, double>(x).transpose() * base - body), 16 * eps * condition);
  });
}

// Checks K-I-4.0a.
TYPED_TEST(Coordinates, HaveAKMatrixThatUndoesH) {
  using C = TypeParam;
  this->for_regular([](const Column<C>& x, double condition, Random& random) {
    for (const Axes axes : both_axes) {
      const auto h = C::template h_matrix<double>(x, axes);
      const auto k = *C::template k_matrix<double>(x, axes);
      EXPECT_LE(size_of(h * k - Matrix3::Identity()), 16 * eps * condition);
      const Column<C> possible = k * random.vector();
      EXPECT_LE(size_of(k * (h * possible) - possible), 16 * eps * condition * size_of(k));
    }
  });
}

// Checks K-I-4.0a, K-I-4.1.1.
TYPED_TEST(Coordinates, KeepTheirConstraints) {
  using C = TypeParam;
  if constexpr (C::size > 3) {
    this->for_regular([](const Column<C>& x, double condition, Random& random) {
      const auto now = C::template constraints<double>(x);
      EXPECT_EQ(now.size(), C::size - 3);
      EXPECT_LE(size_of(now), 8 * eps);
      const Column<C> rates = *coordinate_rates<C, double>(x, random.vector(), Axes::base);
      EXPECT_LE(size_of(dual_part(C::template constraints<Dual<double>>(dual(x, rates)))), 16 * eps * condition);
      EXPECT_GT(size_of(C::template constraints<double>(1.1 * x)), 0.1) << "they must see what is no rotation";
    });
  } else {
    EXPECT_EQ(C::size, 3);
  }
}

// Checks K-I-4.0a, K-I-3.2.3, K-I-5.1d.
// Second derivatives of the matrix along x + x' t + x'' t^2/2, exact, by dual numbers of dual numbers.
TYPED_TEST(Coordinates, AccelerateAsTheirMatrixDoes) {
  using C = TypeParam;
  using Twice = Dual<Dual<double>>;
  this->for_regular([](const Column<C>& x, double condition, Random& random) {
    for (const Axes axes : both_axes) {
      const Vector3 omega = random.vector(), alpha = random.vector();
      const Column<C> rates = *coordinate_rates<C, double>(x, omega, axes);
      const Column<C> accelerations = *coordinate_accelerations<C, double>(x, omega, alpha, axes);
      Eigen::Matrix<Twice, C::size, 1> moving;
      for (int n = 0; n < C::size; ++n) {
        moving[n] = Twice(Dual<double>(x[n], rates[n]), Dual<double>(rates[n], accelerations[n]));
      }
      const Matrix3T<Twice> motion = rotation<C, Twice>(moving);
      const Matrix3 r = real_part(real_part(motion)), rate = dual_part(real_part(motion)),
                    second = dual_part(dual_part(motion));
      // In base axes R'' R^T + R' R'^T = skew(alpha); its axial vector turned into body axes is the same vector.
      const Vector3 in_base = axial(second * r.transpose() + rate * rate.transpose());
      const Vector3 found = axes == Axes::base ? in_base : Vector3(r.transpose() * in_base);
      // Rates and accelerations are as large as K and its square.
      const double scale = condition * condition;
      EXPECT_LE(size_of(found - alpha), 64 * eps * scale);
      EXPECT_LE(size_of(angular_acceleration<C, double>(x, rates, accelerations, axes) - alpha), 64 * eps * scale);
    }
  });
}

// Checks K-I-4.0a, K-I-4.3.1, K-I-4.4.1, K-I-4.5.2.
TYPED_TEST(Coordinates, HaveATwinOfTheSameRotation) {
  using C = TypeParam;
  if constexpr (requires(const Column<C>& x) { C::template twin<double>(x); }) {
    this->for_regular([](const Column<C>& x, double, Random&) {
      const std::optional<Column<C>> twin = C::template twin<double>(x);
      ASSERT_TRUE(twin);
      EXPECT_GT(size_of(*twin - x), 1e-3);
      EXPECT_LE(size_of(rotation<C, double>(*twin) - rotation<C, double>(x)), 16 * eps);
      EXPECT_LE(size_of(*std::optional<Column<C>>(C::template twin<double>(*twin)) - x), 8 * eps * (1 + size_of(x)));
    });
  }
}

// The same code in another arithmetic is the same function.
TYPED_TEST(Coordinates, AreTheSameInHigherPrecisionAndWithDerivatives) {
  using C = TypeParam;
  using Jet = ceres::Jet<double, 2>;
  this->for_regular([](const Column<C>& x, double condition, Random&) {
    const Vector4 q = C::template quaternion<double>(x);
    const auto exact = C::template quaternion<long double>(x.template cast<long double>());
    EXPECT_LE(size_of(exact.template cast<double>() - q), 8 * eps);
    const auto finer = C::template of_quaternion<long double>(exact);
    if (size_of(finer.coordinates.template cast<double>() - x) < 0.5) {
      EXPECT_LE(size_of(finer.coordinates.template cast<double>() - x), 16 * eps * condition * (1 + size_of(x)));
    }
    const Vector4T<Jet> jets = C::template quaternion<Jet>(x.template cast<Jet>());
    for (int n = 0; n < 4; ++n) EXPECT_LE(std::abs(jets[n].a - q[n]), 4 * eps);
  });
}

// Checks K-I-4.2.2.
TEST(Angle, IsUnwrappedToTheTurnOfThePreviousOne) {
  EXPECT_NEAR(unwrapped(-3.0, 3.2), 2 * pi - 3.0, 4 * eps);
  EXPECT_NEAR(unwrapped(0.1, 20 * pi), 20 * pi + 0.1, 64 * eps);
  EXPECT_EQ(unwrapped(1.0, 2.0), 1.0);
  EXPECT_EQ(wrapped(pi), pi);
  EXPECT_EQ(wrapped(-pi), pi);
  EXPECT_NEAR(wrapped(4.0), 4.0 - 2 * pi, 4 * eps);
}

}  // namespace
}  // namespace koppel::test
