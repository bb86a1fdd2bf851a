// Derivatives of functions whose own are known, and that the errors told bound the true ones.
#include "dynamics/derivative.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

Derivative at(const VectorFunction& f, const Eigen::VectorXd& x) {
  Derivative result;
  Eigen::Index failed = 0;
  EXPECT_TRUE(differentiate(f, x, Eigen::VectorXd::Ones(x.size()), result, failed));
  EXPECT_EQ(failed, -1);
  return result;
}

TEST(Derivative, SmoothFunctionsToRoundingWithinTheErrorTold) {
  const Eigen::Vector2d x(0.7, -1.3);
  const Derivative d = at(
      [](const Eigen::VectorXd& z, Eigen::VectorXd& y) {
        y.resize(3);
        y << std::sin(z[0]) * std::exp(z[1]), 1.0 / (2.0 + z[0] * z[1]), 3.0 * z[0] - 5.0 * z[1];
        return true;
      },
      x);
  Eigen::Matrix<double, 3, 2> exact;
  const double below = 2.0 + x[0] * x[1];
  exact << std::cos(x[0]) * std::exp(x[1]), std::sin(x[0]) * std::exp(x[1]), -x[1] / (below * below),
      -x[0] / (below * below), 3.0, -5.0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 2; ++j) {
      EXPECT_LE(std::abs(d.value(i, j) - exact(i, j)), d.error(i, j)) << i << ' ' << j;
      EXPECT_LT(d.error(i, j), 1e-10);
    }
  }
}

TEST(Derivative, TakesSmallStepsWhereAFunctionIsSteep) {
  constexpr double width = 1e-3;
  const Derivative d = at(
      [](const Eigen::VectorXd& z, Eigen::VectorXd& y) {
        y.setConstant(1, std::tanh(z[0] / width));
        return true;
      },
      Eigen::VectorXd::Zero(1));
  EXPECT_LE(std::abs(d.value(0, 0) - 1.0 / width), d.error(0, 0));
  EXPECT_LT(d.error(0, 0), 1e-6 / width);
}

TEST(Derivative, TellsACorner) {
  const Derivative d = at(
      [](const Eigen::VectorXd& z, Eigen::VectorXd& y) {
        y.setConstant(1, std::max(z[0], 0.0));
        return true;
      },
      Eigen::VectorXd::Zero(1));
  EXPECT_NEAR(d.value(0, 0), 0.5, eps);
  EXPECT_NEAR(d.error(0, 0), 0.5, 4 * eps);
}

TEST(Derivative, LeavesOutStepsWithoutAValue) {
  const VectorFunction root = [](const Eigen::VectorXd& z, Eigen::VectorXd& y) {
    y.setConstant(1, std::sqrt(std::max(z[0], 0.0)));
    return z[0] > 0.0;
  };
  const Derivative d = at(root, Eigen::VectorXd::Constant(1, 0.01));
  EXPECT_LE(std::abs(d.value(0, 0) - 5.0), d.error(0, 0));
  EXPECT_LT(d.error(0, 0), 1e-9);

  Derivative none;
  Eigen::Index failed = -1;
  const VectorFunction nowhere = [](const Eigen::VectorXd& z, Eigen::VectorXd& y) {
    y = z;
    return z.isZero(0.0);
  };
  EXPECT_FALSE(differentiate(nowhere, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1), none, failed));
  EXPECT_EQ(failed, 0);
}

}  // namespace
}  // namespace koppel::test
