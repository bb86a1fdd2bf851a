// The even functions: right at every size of the angle, smooth where the series end.
#include "spatial/sinc.hpp"

#include <limits>
#include <numbers>

#include <ceres/jet.h>
#include <gtest/gtest.h>

namespace koppel::test {
namespace {

using Long = long double;
constexpr double eps = std::numeric_limits<double>::epsilon();

/// Angles around everything that could be a seam, and far beyond.
std::vector<double> angles() {
  std::vector<double> all{0.0, 1e-300, 1e-160,           1e-16, 1e-8, 1e-4, 0.1, 0.5, 0.999999, 1.0, 1.000001, 1.9999,
                          2.0, 2.0001, std::numbers::pi, 4.0,   6.0};
  for (int n = 1; n < 1000; ++n) all.push_back(6.0 * n / 1000);
  return all;
}

/// The series summed in long double until nothing changes: an independent reference up to x = 6, where the greatest
/// term is 36 and costs five bits of the eleven to spare.
Long series_sum(Long s, int first_factorial, bool weighted) {
  Long factorial = 1;
  for (int n = 2; n <= first_factorial; ++n) factorial *= static_cast<Long>(n);
  Long term = 1 / factorial, sum = 0;
  for (int k = 0; k < 60; ++k) {
    sum += weighted ? term * static_cast<Long>(2 * k + 2) : term;
    const int n = first_factorial + 2 * k;
    term *= -s / (static_cast<Long>(n + 1) * static_cast<Long>(n + 2));
  }
  return sum;
}

void expect_near(double value, Long exact, double tolerance, double x) {
  EXPECT_LE(std::abs(static_cast<double>(static_cast<Long>(value) - exact)), tolerance) << "at " << x;
}

TEST(Sinc, AndItsKinAreTheirSeries) {
  for (const double x : angles()) {
    const double s = x * x;
    const Long exact = static_cast<Long>(x) * static_cast<Long>(x);
    // The square is rounded: x has half a unit of error, which moves the cosine by x eps / 2.
    const double moved = eps * (2 + x);
    const SincTerms<double> terms = sinc_terms<double>(s);
    expect_near(terms.cosine, series_sum(exact, 0, false), moved, x);
    expect_near(terms.sinc, series_sum(exact, 1, false), moved, x);
    expect_near(terms.cosinc, series_sum(exact, 2, false), moved, x);
    expect_near(terms.sinc_defect, series_sum(exact, 3, false), moved, x);
    // (sin h - h cos h) / h^3 over 4 sin h / h; near a full turn it is as large as the sine is small.
    const Long quarter = exact / 4;
    const Long sinc = series_sum(quarter, 1, false);
    expect_near(cotangent_defect_of_square<double>(s), series_sum(quarter, 3, true) / (4 * sinc),
                moved / static_cast<double>(sinc * sinc), x);
  }
}

// d/ds of (1 - cos x)/x^2 is (sin x / x - 2 (1 - cos x)/x^2) / (2 s) and so on: by dual numbers, against long double.
TEST(Sinc, HasItsDerivativeAtZeroAndAcrossTheSeams) {
  using Jet = ceres::Jet<double, 1>;
  for (const double x : angles()) {
    const Jet s(x * x, 0);
    const Long exact = static_cast<Long>(x) * static_cast<Long>(x);
    const Long sinc = series_sum(exact, 1, false), cosinc = series_sum(exact, 2, false);
    // Where the closed form serves, s >= 1, it divides by s what cancels at most to a part of ten.
    expect_near(sinc_terms(s).cosine.v[0], -sinc / 2, 8 * eps, x);
    if (exact > 0.01L) {
      expect_near(sinc_terms(s).sinc.v[0], (series_sum(exact, 0, false) - sinc) / (2 * exact), 16 * eps, x);
      expect_near(sinc_terms(s).cosinc.v[0], (sinc - 2 * cosinc) / (2 * exact), 16 * eps, x);
    } else {
      expect_near(sinc_terms(s).sinc.v[0], -1.0L / 6 + exact / 60 - exact * exact / 1680, 8 * eps + 1e-10 * x, x);
      expect_near(sinc_terms(s).cosinc.v[0], -1.0L / 24 + exact / 360 - exact * exact / 13440, 8 * eps + 1e-10 * x, x);
    }
  }
  EXPECT_EQ(sinc_terms(Jet(0.0, 0)).sinc.v[0], -1.0 / 6);
}

}  // namespace
}  // namespace koppel::test
