// Local coordinates about a position: a round trip, and rates against differences of the motion itself.
#include "dynamics/chart.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "../mechanism/built.hpp"
#include "mechanism/state.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

struct LocalCoordinates : testing::Test {
  const Built built{
      "[[body]]\nname = 'a'\n[[body]]\nname = 'b'\n"
      "[[joint]]\nname = 'free'\ntype = 'free'\ninlet = 'ground'\noutlet = 'a'\n"
      "[[joint]]\nname = 'pin'\ntype = 'revolute'\ninlet = 'a'\noutlet = 'b'\n"};
  const Mechanism& mechanism = *built;
  Chart chart{mechanism};
  Eigen::VectorXd base = State(mechanism).q, delta = Eigen::VectorXd::Zero(mechanism.nv);

  void SetUp() override {
    Eigen::VectorXd away(mechanism.nv);
    away << 0.4, -1.1, 0.7, 0.3, 0.2, -0.5, 2.0;
    integrate(mechanism, State(mechanism).q, away, base);
    chart.set_base(base);
    delta << -0.5, 0.6, 0.2, 0.1, -0.3, 0.9, 5.0;
  }
};

TEST_F(LocalCoordinates, RoundTrip) {
  Eigen::VectorXd q(mechanism.nq), back(mechanism.nv);
  chart.position(delta, q);
  chart.coordinates(q, back);
  EXPECT_LE((back - delta).cwiseAbs().maxCoeff(), 16 * eps * delta.cwiseAbs().maxCoeff());
  chart.position(Eigen::VectorXd::Zero(mechanism.nv), q);
  EXPECT_LE((q - base).cwiseAbs().maxCoeff(), 4 * eps * base.cwiseAbs().maxCoeff());
}

TEST_F(LocalCoordinates, RatesAreThoseOfTheMotion) {
  Eigen::VectorXd v(mechanism.nv), rates(mechanism.nv), q(mechanism.nq), moved(mechanism.nq);
  v << 0.7, -0.2, 1.3, 0.4, -0.6, 0.5, -1.5;
  chart.rates(delta, v, rates);
  chart.position(delta, q);
  // Central differences of sixth order: h^6 of derivatives of about 1, and rounding over h.
  const double h = 1e-2;
  const double weights[] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(mechanism.nv), side(mechanism.nv);
  for (int k = 1; k <= 3; ++k) {
    for (const double sign : {1.0, -1.0}) {
      integrate(mechanism, q, sign * k * h * v, moved);
      chart.coordinates(moved, side);
      sum += sign * weights[k - 1] / h * side;
    }
  }
  EXPECT_LE((sum - rates).cwiseAbs().maxCoeff(), 100 * (std::pow(h, 6) + eps / h));
}

TEST_F(LocalCoordinates, KnowHowFarTheyTurn) {
  EXPECT_FALSE(chart.is_flat());
  EXPECT_NEAR(chart.greatest_turn(delta), delta.segment<3>(0).norm(), eps);
}

}  // namespace
}  // namespace koppel::test
