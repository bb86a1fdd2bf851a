// Moving up to limits and across change points, as a run does it.
#include "closure/passage.hpp"

#include <numbers>

#include <gtest/gtest.h>

#include "four_bar.hpp"

namespace koppel::test {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr koppel_status remarks = KOPPEL_REDUNDANT | KOPPEL_NEAR_SINGULAR;

/// How a parallelogram of 90 deg a second, at 90 deg at the time 0, should stand: rocker as crank, coupler as it was.
void expect_parallelogram(const Closed& closed, double time) {
  const double crank = (90 + 90 * time) * degree;
  EXPECT_NEAR(closed.at("crank.angle"), crank, 1e-14 * (1 + crank)) << time;
  EXPECT_NEAR(closed.at("rocker.angle"), crank, 1e-11) << time;
  EXPECT_NEAR(closed.at("crank_pin.angle"), -crank, 1e-11) << time;
  EXPECT_LE(closed.residual(), 1e-13) << time;
  EXPECT_NEAR(closed.state.v[closed.built.joint("rocker").v], 90 * degree, 1e-8) << time;
  EXPECT_NEAR(closed.state.v[closed.built.joint("crank_pin").v], -90 * degree, 1e-8) << time;
  EXPECT_NEAR(closed.state.v[closed.built.joint("rocker_pin").v], -90 * degree, 1e-8) << time;
  EXPECT_LE(closed.state.a.lpNorm<Eigen::Infinity>(), 1e-5) << time;
}

TEST(SilentBranchFlips, DoNotHappenToAParallelogramAtAnyStep) {
  for (const double step : {0.001, 1.0 / 90, 0.013, 0.05, 0.1, 0.25, 0.3}) {
    Closed closed(parallelogram);
    int told = 0;
    const int steps = static_cast<int>(8.5 / step);
    for (int i = 0; i <= steps; ++i) {
      const koppel_status status = closed.move(i * step);
      ASSERT_GE(status, 0) << step << ' ' << i;
      EXPECT_EQ(status & ~(remarks | KOPPEL_CHANGE_POINT), 0) << step << ' ' << i;
      told += static_cast<int>(closed.report.change_points);
      expect_parallelogram(closed, i * step);
      if (testing::Test::HasFailure()) return;
    }
    EXPECT_EQ(told, 4) << step;  // 180, 360, 540 and 720 deg
  }
}

TEST(ClosedWronglyAt180Degrees, IsNotWhatAParallelogramDoes) {
  Closed closed(parallelogram);
  for (const double time : {0.0, 0.5, 0.9, 1.0, 1.0 + 1e-12, 1.0 + 1e-9, 1.0 + 1e-6, 1.001, 1.01, 1.1, 1.0, 0.9, 1.1}) {
    ASSERT_GE(closed.move(time), 0) << time;
    expect_parallelogram(closed, time);
  }
}

TEST(ClosedWronglyAt180Degrees, IsNotWhatTwoParallelogramsDo) {
  for (const double step : {0.01, 0.1, 0.15}) {
    Closed closed(two_parallelograms);
    for (int i = 0; i * step <= 4.5; ++i) {
      ASSERT_GE(closed.move(i * step), 0) << step << ' ' << i;
      expect_parallelogram(closed, i * step);
      EXPECT_NEAR(closed.at("wheel2.angle"), closed.at("crank.angle"), 1e-10);
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST(ChangePoint, IsPassedOnTheOtherBranchIfAsked) {
  for (const double step : {0.01, 0.05, 0.1, 0.15}) {
    Closed closed(parallelogram);
    int told = 0;
    for (int i = 0; i * step <= 2.9; ++i) {
      const double time = i * step;
      const koppel_status status = koppel::move(closed.work, closed.state, time, closed.report, Branch::take);
      ASSERT_GE(status, 0) << step << ' ' << i;
      told += static_cast<int>(closed.report.change_points);
      EXPECT_LE(closed.residual(), 1e-13);
      const double crank = closed.at("crank.angle"), rocker = closed.at("rocker.angle");
      if (time < 1.0 - 1e-9) {
        EXPECT_NEAR(rocker, crank, 1e-11);
      }
      if (time > 1.0 + 1e-9) {
        EXPECT_NEAR(std::tan(crank / 2) / std::tan(rocker / 2), -0.15 / 0.65, 1e-9) << time;
      }
      if (testing::Test::HasFailure()) return;
    }
    EXPECT_EQ(told, 1);
  }
}

TEST(Limit, IsToldWithPlaceTimeAndWhatToDriveInstead) {
  for (const double step : {0.01, 0.1, 1.0, 3.0}) {
    Closed closed(long_crank("100 deg", "71.8 deg", "10 deg"));
    koppel_status status = KOPPEL_OK;
    State before = closed.state;
    for (int i = 0; status >= 0; ++i) {
      before = closed.state;
      status = closed.move(i * step);
    }
    EXPECT_EQ(status, KOPPEL_NOT_CLOSED) << step;
    EXPECT_TRUE(same_bits(closed.state, before));
    EXPECT_EQ(closed.report.verdict, Verdict::limit) << step;
    EXPECT_EQ(closed.report.limit_input, 0);
    EXPECT_NEAR(closed.report.limit_value / degree, 169.486774773, 1e-9);
    EXPECT_NEAR(closed.report.limit_time, 6.9486774773, 1e-10);
    EXPECT_EQ(closed.report.drive_instead, closed.built.coordinate("cardan.angle1"));
  }
}

TEST(Limit, IsToldOfInputsThatAreSetByHand) {
  Closed closed(long_crank("100 deg", "71.8 deg", "10 deg"));
  ASSERT_GE(closed.close(), 0);
  closed.state.input[0] = 200 * degree;
  EXPECT_EQ(closed.close(), KOPPEL_NOT_CLOSED);
  EXPECT_EQ(closed.report.verdict, Verdict::limit);
  EXPECT_NEAR(closed.report.limit_value / degree, 169.486774773, 1e-9);
  closed.state.input[0] = 0;
  EXPECT_EQ(closed.close(), KOPPEL_NOT_CLOSED);
  EXPECT_EQ(closed.report.verdict, Verdict::limit);
  EXPECT_NEAR(closed.report.limit_value / degree, 40.333054067, 1e-9);
}

TEST(Limit, OfADriveThatIsNoRampIsFoundInTime) {
  // 100 deg + 80 deg sin(2 pi 0.1 t)
  Closed closed(replaced(long_crank("100 deg", "71.8 deg", "10 deg"),
                         "type = \"ramp\"\nstart = \"100 deg\"\nslope = \"10 deg\"",
                         "type = \"sine\"\noffset = \"100 deg\"\namplitude = \"80 deg\"\nfrequency = 0.1"));
  koppel_status status = KOPPEL_OK;
  for (int i = 0; status >= 0 && i < 100; ++i) status = closed.move(i * 0.3);
  EXPECT_EQ(closed.report.verdict, Verdict::limit);
  EXPECT_NEAR(closed.report.limit_value / degree, 169.486774773, 1e-9);
  EXPECT_NEAR(closed.report.limit_time, std::asin(69.486774772676 / 80) / (2 * std::numbers::pi * 0.1), 1e-9);
}

TEST(Limit, OfTheFoldingAntenna) {
  Closed closed(shipped("sar"));
  koppel_status status = KOPPEL_OK;
  for (int i = 0; status >= 0 && i < 1000; ++i) status = closed.move(i / 360.0);
  EXPECT_EQ(status, KOPPEL_NOT_CLOSED);
  EXPECT_EQ(closed.report.verdict, Verdict::limit);
  EXPECT_GT(closed.report.limit_time, 1.0);
}

TEST(Limit, IsReachedFromBothSidesOfADeadCentre) {
  for (const std::string slope : {"-0.1", "0.1"}) {
    for (const double step : {0.01, 0.1, 0.3, 0.99}) {
      Closed closed(driven_by_slider(slope));
      koppel_status status = KOPPEL_OK;
      for (int i = 0; status >= 0 && i < 1000; ++i) status = closed.move(i * step + 1e-3 * (i > 0));
      EXPECT_EQ(closed.report.verdict, Verdict::limit) << slope << ' ' << step;
      EXPECT_NEAR(closed.report.limit_value, slope == "0.1" ? 0.4 : 0.2, 1e-12);
      EXPECT_NEAR(closed.report.limit_time, 1.0, 1e-11);
    }
  }
}

// The last step ends where the slider stands still while the crank may turn: no speed of the crank goes with it.
TEST(Limit, AsTheTargetItselfHasNoRates) {
  Closed closed(driven_by_slider("0.1"));
  ASSERT_GE(closed.move(0.0), 0);
  ASSERT_GE(closed.move(0.9), 0);
  const koppel_status status = closed.move(1.0);
  EXPECT_LT(status, 0);
}

/// Six steps along the curve; rates are derivatives by the path.
void expect_rates_by_the_path(Closed& closed, double h) {
  std::vector<State> states;
  for (int i = 0; i < 7; ++i) {
    ASSERT_GE(follow(closed.work, closed.state, h, 0, Branch::stay, closed.report), 0);
    states.push_back(closed.state);
  }
  const auto derivative = [&](const auto& f) -> Eigen::VectorXd {
    return (45 * (f(states[4]) - f(states[2])) - 9 * (f(states[5]) - f(states[1])) + (f(states[6]) - f(states[0]))) /
           (60 * h);
  };
  const Eigen::VectorXd v = derivative([&](const State& state) {
    Eigen::VectorXd delta(closed.built->nv);
    difference(*closed.built, states[3].q, state.q, delta);
    return delta;
  });
  const Eigen::VectorXd a = derivative([](const State& state) { return state.v; });
  const double speed = 1 + states[3].v.lpNorm<Eigen::Infinity>();
  EXPECT_LE((v - states[3].v).lpNorm<Eigen::Infinity>(), 1e-7 * speed);
  EXPECT_LE((a - states[3].a).lpNorm<Eigen::Infinity>(), 1e-6 * speed * speed);
}

TEST(Through, TheLimitsOfASpatialFourBarTheCrankSwingsToAndFro) {
  Closed closed(long_crank("100 deg", "71.8 deg", "10 deg"));
  ASSERT_GE(closed.move(0), 0);
  double low = 1e9, high = -1e9;
  std::uint32_t limits = 0;
  for (int i = 0; i < 2000; ++i) {
    ASSERT_GE(follow(closed.work, closed.state, 0.05, 0, Branch::stay, closed.report), 0) << i;
    EXPECT_LE(closed.residual(), 1e-13);
    limits += closed.report.limits;
    if (closed.report.limits > 0) {
      const bool upper = closed.report.limit_value > 100 * degree;
      EXPECT_NEAR(closed.report.limit_value / degree, upper ? 169.486774773 : 40.333054067, 1e-9);
    }
    low = std::min(low, closed.at("crank.angle"));
    high = std::max(high, closed.at("crank.angle"));
    EXPECT_NEAR(closed.state.v[closed.built.joint("crank").v], closed.report.pace * 10 * degree, 1e-12);
  }
  EXPECT_GE(limits, 4u);
  EXPECT_NEAR(low / degree, 40.333, 0.02);
  EXPECT_NEAR(high / degree, 169.487, 0.02);
  // The rocker has turned fully, again and again.
  EXPECT_GT(std::abs(closed.at("rocker.angle")), 4 * std::numbers::pi);
}

TEST(Through, RatesAreDerivativesByThePath) {
  for (const std::string& text :
       {long_crank("168 deg", "150 deg", "10 deg"), driven_by_slider("0.1"), parallelogram, shipped("sph4")}) {
    Closed closed(text);
    ASSERT_GE(closed.move(0), 0);
    // Steps of a hundredth of an angle.
    const double speed = closed.state.v.lpNorm<Eigen::Infinity>();
    for (int i = 0; i < 10; ++i) expect_rates_by_the_path(closed, 0.01 / (1 + speed));
  }
}

// A step may end anywhere beside a change point, and the next begin there.
TEST(Through, ChangePointsOnEitherBranch) {
  for (const Branch branch : {Branch::stay, Branch::take}) {
    Closed closed(parallelogram);
    ASSERT_GE(closed.move(0), 0);
    std::uint32_t passed = 0;
    for (int i = 0; i < 3600; ++i) {
      ASSERT_GE(follow(closed.work, closed.state, 1.0 / 90, 0, branch, closed.report), 0) << i;
      EXPECT_LE(closed.residual(), 1e-13);
      EXPECT_LE(closed.report.coordinate_error, 1e-10);
      passed += closed.report.change_points;
    }
    const double turned = closed.at("crank.angle") / std::numbers::pi;
    EXPECT_EQ(passed, static_cast<std::uint32_t>(turned));
    EXPECT_EQ(closed.report.limits, 0u);
  }
}

TEST(Through, AMoveInTimeGoesOnFromThere) {
  Closed closed(long_crank("100 deg", "71.8 deg", "10 deg"));
  ASSERT_GE(closed.move(0), 0);
  while (closed.report.limits == 0) {
    ASSERT_GE(follow(closed.work, closed.state, 0.1, 0, Branch::stay, closed.report), 0);
  }
  const double time = closed.state.time;
  ASSERT_GE(closed.move(time - 0.1), 0);
  EXPECT_NEAR(closed.state.v[closed.built.joint("crank").v], 10 * degree, 1e-12);
  EXPECT_GT(closed.at("rocker.angle"), 175.2 * degree);
}

TEST(Through, IsRefusedWhereTheInputsAreNotTheDrives) {
  Closed closed(long_crank("100 deg", "71.8 deg", "10 deg"));
  EXPECT_EQ(follow(closed.work, closed.state, 0.1, 0, Branch::stay, closed.report), KOPPEL_INVALID_ARGUMENT);
  ASSERT_GE(closed.move(0), 0);
  closed.state.input[0] += 0.01;
  ASSERT_GE(closed.close(), 0);
  EXPECT_EQ(follow(closed.work, closed.state, 0.1, 0, Branch::stay, closed.report), KOPPEL_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace koppel::test
