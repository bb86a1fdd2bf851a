// Dual numbers: a ring with divisors of zero, functions that carry their derivatives, and what happens where there is
// none.
#include "spatial/dual.hpp"

#include <array>
#include <limits>
#include <numbers>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "directions.hpp"

namespace koppel::test {
namespace {

using Long = long double;
using D = Dual<double>;
using DD = Dual<D>;
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();

bool same(const D& a, double real, double dual) { return a.real == real && a.dual == dual; }
bool is_nan(const D& a) { return std::isnan(a.real) || std::isnan(a.dual); }

// Checks K-I-6.1.1. With small integers nothing is rounded, and the axioms hold exactly.
TEST(Dual, NumbersAreARing) {
  const std::array<D, 5> numbers{D(0, 0), D(1, 0), D(0, 1), D(3, -2), D(-5, 7)};
  for (const D& a : numbers) {
    EXPECT_EQ(a + D(0), a);
    EXPECT_EQ(a * D(1), a);
    EXPECT_EQ(a + (-a), D(0));
    EXPECT_EQ(a - a, D(0));
    for (const D& b : numbers) {
      EXPECT_EQ(a + b, b + a);
      EXPECT_EQ(a * b, b * a);
      for (const D& c : numbers) {
        EXPECT_EQ((a + b) + c, a + (b + c));
        EXPECT_EQ((a * b) * c, a * (b * c));
        EXPECT_EQ(a * (b + c), a * b + a * c);
      }
    }
  }
}

// Checks K-I-6.1.1.
TEST(Dual, EpsilonSquaredIsZero) {
  const D e(0, 1);
  EXPECT_EQ(e * e, D(0));
  EXPECT_EQ(D(0, 4) * D(0, -9), D(0)) << "pure dual numbers divide zero";
  EXPECT_EQ(D(2, 3) * D(5, 7), D(10, 29));
}

// Checks K-I-6.1.1. The real quotient is half a unit off, so the dual part two and a half of its greatest term.
TEST(Dual, DivisionUndoesMultiplication) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const D a(random.between(-1, 1), random.between(-1, 1)), b(random.between(0.5, 2), random.between(-1, 1));
    const D q = a / b;
    EXPECT_NEAR(q.real, a.real / b.real, eps * std::abs(q.real));
    const double exact = (a.dual * b.real - a.real * b.dual) / (b.real * b.real);
    EXPECT_NEAR(q.dual, exact, 4 * eps * (std::abs(a.dual) / b.real + std::abs(q.real * b.dual) / b.real));
    const D back = q * b;
    EXPECT_NEAR(back.real, a.real, 2 * eps);
    EXPECT_NEAR(back.dual, a.dual, 4 * eps * (std::abs(a.dual) + 2 * std::abs(q.real * b.dual)));
  }
  D c(6, 4);
  c /= D(2, 0);
  c += D(1, 1);
  c -= D(0, 1);
  c *= D(3, 0);
  EXPECT_EQ(c, D(12, 6));
}

// Checks K-I-6.1.1.
TEST(Dual, PureDualNumberHasNoInverse) {
  EXPECT_FALSE(inverse(D(0, 3)).has_value());
  EXPECT_FALSE(inverse(D(0, 0)).has_value());
  ASSERT_TRUE(inverse(D(4, -8)).has_value());
  EXPECT_EQ(*inverse(D(4, -8)), D(0.25, 0.5));
  EXPECT_EQ((D(1) / D(0, 3)).real, infinity);
  for (const double tiny : {1e-300, 1e-160, 1e150}) {
    EXPECT_NEAR((*inverse(D(tiny, 0)) * D(tiny, 0)).real, 1, 2 * eps);
  }
}

TEST(Dual, NumbersAreOrderedByTheirRealParts) {
  EXPECT_LT(D(1, 9), D(2, -9));
  EXPECT_GT(D(2, 0), 1.0);
  EXPECT_FALSE(D(1, 2) < D(1, 3));
  EXPECT_FALSE(D(std::nan(""), 0) < D(0) || D(std::nan(""), 0) > D(0));
}

/// Compares the dual part of f(x + eps) with the central difference in long double: off by h^2/6 times the third
/// derivative, of which a bound on [0.2, 0.8] is given, and by the rounding of two values over 2 h.
template <typename F>
void expect_derivative(const F& f, double third_derivative) {
  constexpr Long h = 0x1p-20L;
  constexpr Long rounding = 4 * std::numeric_limits<Long>::epsilon() / h;
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const double x = random.between(0.2, 0.8), rate = random.between(-2, 2);
    const Long difference = (f(Long(x) + h) - f(Long(x) - h)) / (2 * h);
    const double bound = static_cast<double>(h * h / 6 * third_derivative + rounding * (1 + std::abs(f(Long(x)))));
    const D y = f(D(x, rate));
    const double slope = static_cast<double>(difference);
    EXPECT_NEAR(y.real, static_cast<double>(f(Long(x))), 2 * eps * (std::abs(y.real) + 1));
    EXPECT_NEAR(y.dual, rate * slope, std::abs(rate) * (bound + 4 * eps * (1 + std::abs(slope)))) << "at " << x;
    const Dual<Long> wide = f(Dual<Long>(x, 1));
    EXPECT_NEAR(static_cast<double>(wide.dual - difference), 0, bound) << "at " << x;
  }
}

// Checks K-I-6.1.2. The bounds are those of the third derivatives, rounded up.
TEST(Dual, FunctionsCarryTheirDerivatives) {
  using std::sin, std::cos, std::tan, std::asin, std::acos, std::atan, std::exp, std::log, std::sqrt, std::abs,
      std::pow;
  expect_derivative([](auto x) { return sin(x); }, 1);
  expect_derivative([](auto x) { return cos(x); }, 1);
  expect_derivative([](auto x) { return tan(x); }, 20);
  expect_derivative([](auto x) { return asin(x); }, 32);
  expect_derivative([](auto x) { return acos(x); }, 32);
  expect_derivative([](auto x) { return atan(x); }, 2);
  expect_derivative([](auto x) { return exp(x); }, 3);
  expect_derivative([](auto x) { return log(x); }, 250);
  expect_derivative([](auto x) { return sqrt(x); }, 24);
  expect_derivative([](auto x) { return abs(x); }, 0);
  expect_derivative([](auto x) { return abs(-x); }, 0);
  expect_derivative([](auto x) { return decltype(x)(pow(x, 2.5)); }, 5);
  expect_derivative([](auto x) { return decltype(x)(pow(x, 3)); }, 6);
  expect_derivative([](auto x) { return decltype(x)(pow(-x, 3)); }, 6);
}

// Checks K-I-6.1.2. Several variables: the dual part is the sum of the rates times the partial derivatives.
TEST(Dual, FunctionsOfTwoVariablesCarryBothDerivatives) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const D x(random.between(0.5, 2), random.between(-1, 1)), y(random.between(-2, 2), random.between(-1, 1));
    const double r = std::hypot(x.real, y.real);
    EXPECT_NEAR(hypot(x, y).real, r, 2 * eps * r);
    EXPECT_NEAR(hypot(x, y).dual, (x.real * x.dual + y.real * y.dual) / r, 8 * eps);
    EXPECT_NEAR(atan2(y, x).real, std::atan2(y.real, x.real), 2 * eps);
    EXPECT_NEAR(atan2(y, x).dual, (x.real * y.dual - y.real * x.dual) / (r * r), 8 * eps / r);
    const D p = pow(x, y);  // derivatives y x^(y - 1) and x^y log x
    const double power = std::pow(x.real, y.real);
    EXPECT_NEAR(p.real, power, 2 * eps * power);
    EXPECT_NEAR(p.dual, power * (y.real / x.real * x.dual + std::log(x.real) * y.dual), 16 * eps * power * 4);
  }
  EXPECT_EQ(pow(D(-2, 1), D(3)), D(-8, 12)) << "a constant exponent, wherever the base is";
  EXPECT_EQ(pow(DD(D(-2), D(1)), DD(3)).dual.real, 12);
}

// Checks K-I-6.1.2. The example of the source: sin(a^ x^) = sin(a x) + eps (a' x cos(a x) + x' a cos(a x)).
TEST(Dual, SineOfAProduct) {
  const D a(1.2, 0.3), x(0.7, -0.4);
  const D y = sin(a * x);
  EXPECT_NEAR(y.real, std::sin(1.2 * 0.7), 2 * eps);
  EXPECT_NEAR(y.dual, (0.3 * 0.7 - 0.4 * 1.2) * std::cos(1.2 * 0.7), 4 * eps);
}

// Checks K-I-6.1.2. The derivative of a dual function is f' + eps x' f'': a dual number once more gives it.
TEST(Dual, DerivativeOfADualFunctionIsTheFunctionOfTheDerivative) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const D x(random.between(0.2, 2), random.between(-1, 1));
    const D slope = sin(DD(x, D(1))).dual;
    EXPECT_NEAR(slope.real, std::cos(x.real), 2 * eps);
    EXPECT_NEAR(slope.dual, -x.dual * std::sin(x.real), 2 * eps);
    const D root_slope = sqrt(DD(x, D(1))).dual;
    EXPECT_NEAR(root_slope.dual, -x.dual / (4 * std::pow(x.real, 1.5)), 8 * eps * std::abs(root_slope.dual));
    const D angle_slope = atan2(DD(D(1)), DD(x, D(1))).dual;  // -1 / (1 + x^2), and its derivative
    const double square = 1 + x.real * x.real;
    EXPECT_NEAR(angle_slope.real, -1 / square, 4 * eps);
    EXPECT_NEAR(angle_slope.dual, x.dual * 2 * x.real / (square * square), 16 * eps);
  }
}

// Checks K-I-6.1.2. The conditions of a function y + eps y' of x + eps x': dy/dx = dy'/dx', dy/dx' = 0. The parts are
// themselves dual here, to differentiate by each.
TEST(Dual, FunctionsSatisfyTheConditionsOfDifferentiability) {
  const auto f = [](const DD& x) { return exp(sin(x) * x) / (x + DD(2)); };
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const double x = random.between(-1, 1), rate = random.between(-1, 1);
    const DD by_real = f(DD(D(x, 1), D(rate, 0))), by_dual = f(DD(D(x, 0), D(rate, 1)));
    EXPECT_NEAR(by_real.real.dual, by_dual.dual.dual, 32 * eps * (1 + std::abs(by_real.real.dual)));
    EXPECT_EQ(by_dual.real.dual, 0);
  }
}

// Checks K-I-6.1.2. At the ends there is no derivative: the predicates tell, a constant keeps the derivative zero, and
// a variable gets an infinite one.
TEST(Dual, FunctionsAtTheEndsOfTheirRanges) {
  EXPECT_FALSE(is_smooth_root(D(0, 1)));
  EXPECT_TRUE(is_smooth_root(D(1e-300, 1)));
  EXPECT_FALSE(is_smooth_root(D(-1, 1)));
  EXPECT_FALSE(is_smooth_arc(D(1, 1)) || is_smooth_arc(D(-1, 1)) || is_smooth_arc(D(2, 0)));
  EXPECT_TRUE(is_smooth_arc(D(1 - eps, 1)));

  EXPECT_TRUE(same(sqrt(D(0, 0)), 0, 0));
  EXPECT_EQ(sqrt(D(0, 2)).dual, infinity);
  EXPECT_EQ(sqrt(D(0, -2)).dual, -infinity);
  EXPECT_TRUE(same(asin(D(1)), std::numbers::pi / 2, 0));
  EXPECT_TRUE(same(acos(D(-1)), std::numbers::pi, 0));
  EXPECT_EQ(asin(D(1, 1)).dual, infinity);
  EXPECT_EQ(acos(D(1, 1)).dual, -infinity);
  EXPECT_TRUE(same(log(D(0)), -infinity, 0));
  EXPECT_TRUE(same(pow(D(0), 0.5), 0, 0));
  EXPECT_TRUE(same(pow(D(0, 1), 1), 0, 1));
  EXPECT_TRUE(same(pow(D(0, 1), 0), 1, 0));
  EXPECT_TRUE(same(hypot(D(0, 1), D(0, 1)), 0, 0));
  EXPECT_TRUE(same(atan2(D(0, 1), D(0, 1)), 0, 0));
  for (const D& y : {sqrt(D(0, 1)), asin(D(-1, 1)), log(D(0, 1)), pow(D(0, 1), 0.5)}) EXPECT_FALSE(is_nan(y));
  EXPECT_TRUE(isfinite(D(1, 1)));
  EXPECT_FALSE(isfinite(D(1, infinity)) || isfinite(D(infinity, 1)));
}

// Checks K-I-6.1.2. Squares of these lengths are out of the range of the numbers; the angle and the length are not.
TEST(Dual, AngleAndLengthDoNotDependOnTheScale) {
  for (const double scale : {0x1p-500, 0x1p-1000, 0x1p500, 0x1p1000}) {
    const D x(3 * scale, scale), y(4 * scale, -scale);
    EXPECT_NEAR(hypot(x, y).real / scale, 5, 8 * eps);
    EXPECT_NEAR(hypot(x, y).dual / scale, -0.2, 4 * eps);
    EXPECT_NEAR(atan2(y, x).dual, -7.0 / 25, 4 * eps);
  }
}

/// Where the hand of a plane arm with two links is.
template <typename T>
Eigen::Matrix<T, 2, 1> hand(const T& a, const T& b) {
  return {cos(a) + T(0.5) * cos(a + b), sin(a) + T(0.5) * sin(a + b)};
}

// Checks K-I-6.1.2. Forward differentiation: one evaluation for each column of a Jacobian matrix.
TEST(Dual, NumbersGiveTheJacobianOfAnArm) {
  const double a = 0.7, b = -0.4;
  const Eigen::Matrix<D, 2, 1> by_a = hand(D(a, 1), D(b, 0)), by_b = hand(D(a, 0), D(b, 1));
  EXPECT_NEAR(by_a[0].dual, -std::sin(a) - 0.5 * std::sin(a + b), 4 * eps);
  EXPECT_NEAR(by_a[1].dual, std::cos(a) + 0.5 * std::cos(a + b), 4 * eps);
  EXPECT_NEAR(by_b[0].dual, -0.5 * std::sin(a + b), 4 * eps);
  EXPECT_NEAR(by_b[1].dual, 0.5 * std::cos(a + b), 4 * eps);
}

// Checks K-I-6.2.5. Parts of vectors and matrices of any shape, and the real form, which multiplies as the dual
// matrices do.
TEST(Dual, MatricesHaveParts) {
  Random random(7);
  const Eigen::Matrix<double, 2, 3> a = Eigen::Matrix<double, 2, 3>::Constant(2), b = a * 3;
  EXPECT_EQ(real_part(dual(a, b)), a);
  EXPECT_EQ(dual_part(dual(a, b)), b);
  EXPECT_EQ(dual_part(dual(a, b) * D(0, 1)), a);
  const Matrix3T<D> m = dual(random.rotation(), skew(random.vector())),
                    n = dual(skew(random.vector()), random.rotation());
  EXPECT_LE((real_form<double>(m * n) - real_form(m) * real_form(n)).cwiseAbs().maxCoeff(), 16 * eps);
  const Vector3T<D> v = dual(random.vector(), random.vector());
  const Vector6 pair = (Vector6() << real_part(v), dual_part(v)).finished();
  const Vector3T<D> product = m * v;
  EXPECT_LE((real_form(m) * pair - (Vector6() << real_part(product), dual_part(product)).finished()).norm(), 16 * eps);
}

// Checks K-I-6.1.1. Matrices: the dual part of the inverse of A + eps B is -A^-1 B A^-1.
TEST(Dual, NumbersAreScalarsOfMatrices) {
  Random random(6);
  const Matrix3 turn = random.rotation();
  const Matrix3 b = skew(random.vector());
  Matrix3T<D> m;
  for (int i = 0; i < 9; ++i) m(i) = D(turn(i), b(i));
  const Matrix3T<D> n = m.inverse();
  const Matrix3 change = -turn.transpose() * b * turn.transpose();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(n(i, j).real, turn(j, i), 8 * eps);
      EXPECT_NEAR(n(i, j).dual, change(i, j), 32 * eps);
    }
  }
}

}  // namespace
}  // namespace koppel::test
