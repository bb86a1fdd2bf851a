// Curves of closed positions: limits, change points and branches, located and passed.
#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "closure/decompositions.hpp"
#include "closure/walk.hpp"
#include "four_bar.hpp"

namespace koppel::test {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double turn = 2 * std::numbers::pi;

/// A mechanism closed at time 0, and the curve of its drives.
struct Walking {
  explicit Walking(const std::string& text) : closed(text) {
    EXPECT_GE(closed.close(), 0);
    curve.emplace(closed.work, InputWay::of_drives(*closed.built, 0, 1));
  }
  Walk by(double length, Branch branch = Branch::stay) {
    return walk_by(*curve, closed.state.q, 0, {}, length, branch);
  }
  Walk to(double time, Branch branch = Branch::stay) { return walk_to(*curve, closed.state.q, 0, {}, time, branch); }
  double at(const CurvePoint& point, const std::string& coordinate) const {
    return point.q[closed.built.coordinate(coordinate)];
  }
  /// The greatest residual at a point, by equations of its own.
  double residual(const CurvePoint& point) const {
    Equations equations(*closed.built);
    EXPECT_TRUE(equations.evaluate(point.q, point.parameter));
    return equations.error();
  }
  /// Smallest singular value of the Jacobian, in the unknowns or in all columns, that is not zero in good positions.
  double smallest(const CurvePoint& point, bool inputs_too) const {
    Equations equations(*closed.built);
    EXPECT_TRUE(equations.evaluate(point.q, point.parameter));
    equations.evaluate_jacobian();
    const auto columns = inputs_too ? closed.built->columns : closed.built->unknowns;
    const Eigen::MatrixXd jacobian = equations.jacobian.leftCols(columns);
    return Eigen::JacobiSVD<Eigen::MatrixXd>(jacobian).singularValues()[curve->rank() - 1];
  }

  Closed closed;
  std::optional<Curve> curve;
};

double wrapped(double angle) { return std::remainder(angle, turn); }

/// A limit at a crank and a rocker angle [deg], to the digits given.
void expect_limit(const Walking& walking, const SingularPosition& found, double crank, double rocker) {
  EXPECT_EQ(found.kind, SingularKind::limit);
  EXPECT_NEAR(wrapped(walking.at(found.point, "crank.angle")) / degree, wrapped(crank * degree) / degree, 1e-9);
  EXPECT_NEAR(wrapped(walking.at(found.point, "rocker.angle")) / degree, wrapped(rocker * degree) / degree, 1e-9);
  EXPECT_LE(walking.residual(found.point), 1e-13);
  EXPECT_LE(walking.smallest(found.point, false), 1e-13);
  EXPECT_GE(walking.smallest(found.point, true), 1e-2);
}

TEST(Limit, OfTheSpatialFourBarIsLocatedToAllDigitsAndPassed) {
  Walking first(long_crank("100 deg", "71.8 deg", "10 deg"));
  const Walk around = first.by(20);
  ASSERT_EQ(around.end, WalkEnd::arrived);
  ASSERT_GE(around.passed.size(), 3u);
  expect_limit(first, around.passed[0], 169.486774773, 175.196223708);
  expect_limit(first, around.passed[1], 40.333054067, -35.036194260);
  expect_limit(first, around.passed[2], 169.486774773, 175.196223708);

  Walking second(long_crank("330 deg", "60 deg", "-10 deg"));
  const Walk other = second.by(12);
  ASSERT_EQ(other.end, WalkEnd::arrived);
  ASSERT_GE(other.passed.size(), 2u);
  const bool low_first = second.at(other.passed[0].point, "crank.angle") < 320 * degree;
  expect_limit(second, other.passed[low_first ? 0 : 1], 312.822689330, 152.507657666);
  expect_limit(second, other.passed[low_first ? 1 : 0], 344.837072413, -78.201455597);
}

TEST(Limit, EndsAWalkToWhatLiesBeyond) {
  Walking walking(long_crank("100 deg", "71.8 deg", "10 deg"));
  const Walk beyond = walking.to(8.0);
  ASSERT_EQ(beyond.end, WalkEnd::limit);
  expect_limit(walking, beyond.passed.back(), 169.486774773, 175.196223708);
  EXPECT_EQ(stopped_input(*walking.curve, beyond.place.point), 0u);
  const Walk within = walking.to(6.9486774);
  ASSERT_EQ(within.end, WalkEnd::arrived);
  EXPECT_TRUE(within.passed.empty());
}

TEST(Limit, OfTheSliderIsWhereCrankAndRodAreInLine) {
  for (const std::string slope : {"-0.1", "0.1"}) {
    Walking walking(driven_by_slider(slope));
    const Walk walk = walking.by(4 * turn);
    ASSERT_EQ(walk.end, WalkEnd::arrived);
    ASSERT_GE(walk.passed.size(), 4u);
    bool stretched = slope == "0.1";
    for (const SingularPosition& limit : walk.passed) {
      EXPECT_EQ(limit.kind, SingularKind::limit);
      EXPECT_NEAR(walking.at(limit.point, "slider.displacement"), stretched ? 0.4 : 0.2, 1e-13);
      EXPECT_NEAR(std::sin(walking.at(limit.point, "crank.angle")), 0, 1e-13);
      stretched = !stretched;
    }
    // The crank goes on turning the same way.
    EXPECT_GT(std::abs(walking.at(walk.place.point, "crank.angle") - 80 * degree), 1.5 * turn);
  }
}

TEST(Limit, IsNotInventedWhereTheCrankTurnsFully) {
  for (const std::string scene : {"4bar", "rstr", "slidercrank", "7b10j", "chain", "bennett", "sph4", "rccc"}) {
    Walking walking(shipped(scene));
    const Walk walk = walking.to(2.0);
    ASSERT_EQ(walk.end, WalkEnd::arrived) << scene;
    EXPECT_TRUE(walk.passed.empty()) << scene;
    EXPECT_NEAR(walk.place.point.parameter, 2.0, 1e-13) << scene;
  }
}

TEST(Limit, OfTheFoldingAntennaIsItsStretchedPosition) {
  Walking walking(shipped("sar"));
  const Walk walk = walking.to(2.0);
  ASSERT_EQ(walk.end, WalkEnd::limit);
  EXPECT_NEAR(walking.at(walk.place.point, "beta33.angle"), std::numbers::pi, 1e-9);
  EXPECT_LE(walking.smallest(walk.place.point, false), 1e-13);
}

void expect_change_point(const Walking& walking, const SingularPosition& found) {
  EXPECT_EQ(found.kind, SingularKind::change_point);
  EXPECT_EQ(found.branches, 2u);
  EXPECT_LE(walking.residual(found.point), 1e-13);
  EXPECT_LE(walking.smallest(found.point, true), 1e-11);
}

TEST(ChangePoint, OfTheParallelogramIsPassedBothWays) {
  Walking walking(parallelogram);
  for (const double time : {0.9, 1.0, 1.0 + 1e-9, 1.0 + 1e-5, 1.01, 1.5, 2.0, 2.9, 3.0, 3.1, 3.5, 6.5}) {
    const Walk stay = walking.to(time), take = walking.to(time, Branch::take);
    ASSERT_EQ(stay.end, WalkEnd::arrived) << time;
    ASSERT_EQ(take.end, WalkEnd::arrived) << time;
    const double crank = (90 + 90 * time) * degree;
    EXPECT_NEAR(stay.place.point.parameter, time, 1e-13) << time;
    EXPECT_NEAR(walking.at(stay.place.point, "crank.angle"), crank, 1e-12) << time;
    EXPECT_NEAR(walking.at(stay.place.point, "rocker.angle"), crank, 1e-12) << time;
    EXPECT_LE(walking.residual(stay.place.point), 1e-13) << time;
    EXPECT_LE(walking.residual(take.place.point), 1e-13) << time;
    const std::size_t passed = time < 1 ? 0 : time < 3 ? 1 : time < 5 ? 2 : 3;
    ASSERT_EQ(stay.passed.size(), passed) << time;
    EXPECT_EQ(take.passed.size(), passed) << time;
    for (const SingularPosition& found : stay.passed) expect_change_point(walking, found);
    for (const SingularPosition& found : take.passed) expect_change_point(walking, found);
    // Of crossed links, tan(crank / 2) tan(rocker / 2) does not change.
    if (time > 1.001 && time < 2.999) {
      const double rocker = walking.at(take.place.point, "rocker.angle");
      EXPECT_NEAR(std::tan(crank / 2) / std::tan(rocker / 2), -(0.40 - 0.25) / (0.40 + 0.25), 1e-9) << time;
    }
  }
}

TEST(ChangePoint, IsLocatedToABillionth) {
  Walking walking(parallelogram);
  const Walk walk = walking.to(3.5);
  ASSERT_EQ(walk.passed.size(), 2u);
  EXPECT_NEAR(walking.at(walk.passed[0].point, "crank.angle"), std::numbers::pi, 1e-11);
  EXPECT_NEAR(walking.at(walk.passed[1].point, "crank.angle"), 2 * std::numbers::pi, 1e-11);
}

TEST(ChangePoint, OfAFourBarWhoseLongestAndShortestLinksAreAsLongAsTheOthers) {
  Walking walking(four_bar("0.12", "0.27", "0.25", "90 deg", "110 deg"));  // 0.12 + 0.40 = 0.27 + 0.25
  const double rocker = walking.closed.at("rocker.angle");
  for (const Branch branch : {Branch::stay, Branch::take}) {
    const Walk walk = walking.to(8.0, branch);
    ASSERT_EQ(walk.end, WalkEnd::arrived);
    ASSERT_EQ(walk.passed.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      expect_change_point(walking, walk.passed[i]);
      EXPECT_NEAR(walking.at(walk.passed[i].point, "crank.angle"), (180 + 360.0 * static_cast<double>(i)) * degree,
                  1e-11);
    }
    // Two turns of the crank: what goes through the flat position once turns up on the other side.
    EXPECT_NEAR(wrapped(walking.at(walk.place.point, "rocker.angle") - rocker), 0, 1e-11);
    const double half_way = wrapped(walking.at(walking.to(4.0, branch).place.point, "rocker.angle"));
    EXPECT_EQ(half_way * rocker < 0, branch == Branch::stay);
  }
}

// Two parallelograms on one crank become flat together: the rank drops by two.
TEST(ChangePoint, OfTwoParallelogramsAtOnceIsPassed) {
  Walking walking(two_parallelograms);
  for (const double time : {0.999, 1.0, 1.01, 2.0, 4.0}) {
    const Walk walk = walking.to(time);
    ASSERT_EQ(walk.end, WalkEnd::arrived) << time;
    const double crank = (90 + 90 * time) * degree;
    EXPECT_NEAR(walking.at(walk.place.point, "rocker.angle"), crank, 1e-11) << time;
    EXPECT_NEAR(walking.at(walk.place.point, "wheel2.angle"), crank, 1e-11) << time;
    EXPECT_EQ(walk.passed.size(), time < 1 ? 0u : time < 3 ? 1u : 2u) << time;
  }
}

// Lengths that differ by a little make two curves of what was one with a crossing: the walk follows its own.
TEST(NearlyAParallelogram, IsFollowedWithoutAHop) {
  for (const std::string rocker : {"0.2501", "0.24999"}) {
    Walking walking(four_bar("0.25", "0.40", rocker, "90 deg", "90 deg"));
    const Walk walk = walking.by(6.0);
    ASSERT_EQ(walk.end, WalkEnd::arrived) << rocker;
    for (const SingularPosition& found : walk.passed) {
      EXPECT_EQ(found.kind, SingularKind::limit) << rocker;
      // Coupler and rocker in line.
      EXPECT_LE(walking.smallest(found.point, false), 1e-12) << rocker;
    }
    EXPECT_LE(walking.residual(walk.place.point), 1e-13) << rocker;
  }
}

TEST(Walk, IsClosedEverywhereAndItsLengthIsThatOfTheCurve) {
  for (const std::string& text : {shipped("rstr"), shipped("5link"), shipped("stewart"), shipped("sph4"), parallelogram,
                                  long_crank("100 deg", "71.8 deg", "10 deg")}) {
    Walking walking(text);
    const double length = 2.0;
    double sum = 0;
    CurvePoint before = walking.by(0.0).place.point;
    constexpr int parts = 16;
    for (int i = 1; i <= parts; ++i) {
      const Walk walk = walking.by(length * i / parts);
      ASSERT_EQ(walk.end, WalkEnd::arrived);
      EXPECT_LE(walking.residual(walk.place.point), 1e-13);
      sum += walking.curve->offset(before, walk.place.point.q, walk.place.point.parameter).norm();
      before = walk.place.point;
    }
    EXPECT_NEAR(sum, length, 2e-2 * length);  // chords are shorter
  }
}

}  // namespace
}  // namespace koppel::test
