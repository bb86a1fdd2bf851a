// Ways as a tracker passes them: they end where a walk of complex numbers does and move as its derivatives say, whoever
// shares their runs.
#include "closure/tracked_way.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "closed.hpp"

namespace koppel::test {
namespace {

using Complex = std::complex<double>;

constexpr double eps = std::numeric_limits<double>::epsilon();

/// Variables of all kinds with quadratic motions, and ways of them.
struct Moving {
  struct Motion {
    VariableKind kind = VariableKind::turn;
    Vector4 start;  ///< of turns and slides the first component
    Vector3 rate, acceleration;
  };
  explicit Moving(unsigned seed) : random(seed) {}

  std::uint32_t add(VariableKind kind) {
    motions.push_back({kind, random.quaternion(), random.vector(), random.vector()});
    return static_cast<std::uint32_t>(motions.size() - 1);
  }
  Pose pose() { return {rotation_of_quaternion<double>(random.quaternion()), random.vector()}; }
  Leg leg(VariableKind kind, bool inverse) { return {add(kind), kind, inverse, pose()}; }
  std::vector<Leg> legs(std::size_t count) {
    constexpr std::array kinds{VariableKind::turn, VariableKind::slide, VariableKind::ball};
    std::vector<Leg> result;
    for (std::size_t i = 0; i < count; ++i) result.push_back(leg(kinds[i % 3], (i / 3) % 2 == 1));
    return result;
  }
  TrackedPlaces at_zero() const {
    TrackedPlaces result;
    for (const Motion& m : motions) {
      MovingPlace place;
      if (m.kind == VariableKind::ball) {
        std::copy(m.start.begin(), m.start.end(), place.at.begin());
      } else {
        place.at = place_at(m.kind, m.start[0]);
      }
      place.rate = m.rate;
      place.acceleration = m.acceleration;
      result.variables.push_back(place);
    }
    return result;
  }
  std::vector<Place<Complex>> at(Complex time) const {
    std::vector<Place<Complex>> result;
    for (const Motion& m : motions) result.push_back(place(m, time));
    return result;
  }
  static Place<Complex> place(const Motion& m, Complex time) {
    const auto gone = [&](int k) { return m.rate[k] * time + 0.5 * m.acceleration[k] * time * time; };
    const Complex x = m.start[0] + gone(0);
    if (m.kind == VariableKind::slide) return {x, 0.0, 0.0, 0.0};
    if (m.kind == VariableKind::turn) return {std::cos(x), std::sin(x), 0.0, 0.0};
    // The quaternion of a small rotation vector, to the eighth power of its size.
    const Vector3T<Complex> turn{gone(0), gone(1), gone(2)};
    const Complex square = dot<Complex>(turn, turn) / 4.0;
    const Complex cosine = 1.0 - square / 2.0 + square * square / 24.0;
    const Complex sine = (1.0 - square / 6.0 + square * square / 120.0) / 2.0;
    const Vector4T<Complex> by{cosine, sine * turn[0], sine * turn[1], sine * turn[2]};
    const Vector4T<Complex> q = quaternion_product<Complex>(m.start.cast<Complex>(), by);
    return {q[0], q[1], q[2], q[3]};
  }

  Random random;
  std::vector<Motion> motions;
};

/// The twist of a way's end about the origin of its start, by a complex step in time.
Twist twist_of_walk(const Moving& moving, const Way& way, double time) {
  constexpr double step = 1e-30;
  const auto places = moving.at({time, step});
  const PoseT<Complex> end = walk<Complex>(way, places);
  const Matrix3 spin = (end.rotation.imag() / step) * end.rotation.real().transpose();
  Twist result;
  result.angular = {spin(2, 1), spin(0, 2), spin(1, 0)};
  const Vector3 position = end.position.real();
  result.linear = end.position.imag() / step - result.angular.cross(position);
  return result;
}

/// The same way from its end to its start.
std::vector<Leg> backwards(const std::vector<Leg>& legs) {
  std::vector<Leg> result;
  for (std::size_t i = legs.size(); i-- > 0;) {
    const Pose before = i + 1 < legs.size() ? legs[i + 1].to.inverse() : Pose{};
    result.push_back({legs[i].variable, legs[i].kind, !legs[i].inverse, before});
  }
  return result;
}

double size_of(const Twist& t) { return t.vector().lpNorm<Eigen::Infinity>(); }

// Of a walk of n motions over lengths of at most sqrt(3) + 1 each: every product of poses adds some 24 eps, each over
// all that is still to come, and rates are sums of n such parts, their derivatives of n^2.
double rounding(std::size_t n) {
  const auto motions = static_cast<double>(n);
  return 24.0 * eps * 3.0 * motions * motions * motions;
}

TEST(TrackedWay, EndsAndMovesAsTheWalkDoes) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    Moving moving(seed);
    const Way way{moving.legs(1 + seed % 9), moving.pose()};
    const std::size_t n = way.legs.size();
    TrackedWay placed = tracked(way);
    const TrackedPlaces places = moving.at_zero();
    places.place(placed);
    const auto at = moving.at(0.0);
    const PoseT<Complex> end = walk<Complex>(way, at);
    EXPECT_LE((placed.end.rotation - end.rotation.real()).lpNorm<Eigen::Infinity>(), rounding(n));
    EXPECT_LE((placed.end.position - end.position.real()).lpNorm<Eigen::Infinity>(), rounding(n));

    const WayMotion motion = places.motion(placed);
    EXPECT_LE(size_of(motion.twist - twist_of_walk(moving, way, 0.0)), rounding(n));
    // A central difference is off by the step squared over six, times a third derivative of the twist: of products of
    // n motions with rates and accelerations of at most sqrt(3), below (2 n)^4 times the way's length of 3 n.
    constexpr double step = 1e-5;
    const double rates = std::pow(2.0 * static_cast<double>(n), 4) * 3.0 * static_cast<double>(n);
    const Twist difference = twist_of_walk(moving, way, step) - twist_of_walk(moving, way, -step);
    EXPECT_LE(size_of(motion.rate - (0.5 / step) * difference), step * step / 6.0 * rates + rounding(n) / step);
  }
}

TEST(TrackedWay, OnePlacedAgainIsPlaced) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    Moving moving(seed);
    TrackedWay way = tracked({moving.legs(7), moving.pose()});
    TrackedPlaces places = moving.at_zero();
    places.place(way);
    for (const std::uint32_t moved : {0U, 1U, 3U, 4U, 6U}) {  // turns and slides
      places.variables[moved].at = place_at(moving.motions[moved].kind, 0.3 * moved);
      places.place_again(way, moved);
      TrackedWay anew = way;
      places.place(anew);
      // The same products in the same order.
      EXPECT_EQ(way.end.rotation, anew.end.rotation) << moved;
      EXPECT_EQ(way.end.position, anew.end.position) << moved;
    }
  }
}

/// Ways that pass the same motions, every second one backwards, between motions of their own.
struct Shared {
  explicit Shared(unsigned seed) : moving(seed), common(moving.legs(5)) {
    for (std::size_t i = 0; i < 4; ++i) {
      std::vector<Leg> legs = moving.legs(i % 3);
      std::vector<Leg> inside = i % 2 == 0 ? common : backwards(common);
      inside.front().to = moving.pose();
      legs.insert(legs.end(), inside.begin(), inside.end());
      for (const Leg& leg : moving.legs(i)) legs.push_back(leg);
      alone.push_back(tracked({legs, moving.pose()}));
    }
    together = alone;
    for (const Leg& leg : common) variables.push_back(leg.variable);
  }
  /// Finds the runs and places all.
  void share(std::span<const std::uint32_t> unknowns) {
    std::vector<WayOfStep> ways;
    for (TrackedWay& way : together) ways.push_back({&way, unknowns, 3});
    places = moving.at_zero();
    places.runs = share_runs(ways);
    for (Run& run : places.runs) {
      places.place(run);
      places.move(run);
    }
    for (std::vector<TrackedWay>* those : {&alone, &together}) {
      for (TrackedWay& way : *those) places.place(way);
    }
  }
  Moving moving;
  std::vector<Leg> common;
  std::vector<std::uint32_t> variables;
  std::vector<TrackedWay> alone, together;
  TrackedPlaces places;
};

bool has_run(const TrackedWay& way) {
  return std::any_of(way.pieces.begin(), way.pieces.end(),
                     [](const Piece& piece) { return piece.kind == Piece::Kind::run; });
}

TEST(TrackedRuns, WaysThatShareThemEndAndMoveAsBefore) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    Shared shared(seed);
    shared.share(shared.variables);
    ASSERT_EQ(shared.places.runs.size(), 1U) << "whichever way round the common motions are passed";
    for (std::size_t i = 0; i < shared.alone.size(); ++i) {
      const TrackedWay &alone = shared.alone[i], &together = shared.together[i];
      EXPECT_TRUE(has_run(together)) << i;
      const double allowed = rounding(alone.pieces.size());
      EXPECT_LE((alone.end.rotation - together.end.rotation).lpNorm<Eigen::Infinity>(), allowed);
      EXPECT_LE((alone.end.position - together.end.position).lpNorm<Eigen::Infinity>(), allowed);
      const WayMotion a = shared.places.motion(alone), b = shared.places.motion(together);
      EXPECT_LE(size_of(a.twist - b.twist), allowed * std::max(1.0, size_of(a.twist)));
      EXPECT_LE(size_of(a.rate - b.rate), allowed * std::max(1.0, size_of(a.rate)));
    }
  }
}

TEST(TrackedRuns, ScrewsOfUnknownsAddUpToTheirMotion) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    Shared shared(seed);
    shared.share(shared.variables);
    const koppel::Run& run = shared.places.runs.at(0);
    ASSERT_TRUE(run.unknown);
    Twist sum;
    for (const RunScrew& screw : run.screws) {
      sum = sum + shared.places.variables[screw.variable].rate[screw.rate] * screw.twist;
    }
    EXPECT_LE(size_of(sum - run.motion.twist), rounding(run.way.pieces.size()));
  }
}

TEST(TrackedRuns, NoneMixesWhatIsSolvedForWithWhatIsGiven) {
  Shared shared(1);
  const std::vector<std::uint32_t> unknowns{shared.variables[0], shared.variables[1]};
  shared.share(unknowns);
  ASSERT_FALSE(shared.places.runs.empty());
  for (const koppel::Run& run : shared.places.runs) {
    for (const Piece& piece : run.way.pieces) {
      EXPECT_EQ(run.unknown, std::find(unknowns.begin(), unknowns.end(), piece.index) != unknowns.end());
    }
  }
}

TEST(TrackedRuns, NoneIsMadeWhereItCostsMoreThanItSaves) {
  Moving moving(1);
  const std::vector<Leg> common = moving.legs(3);
  TrackedWay a = tracked({common, moving.pose()}), b = tracked({common, moving.pose()});
  const std::vector<WayOfStep> once{{&a, {}, 1}, {&b, {}, 1}};
  EXPECT_TRUE(share_runs(once).empty());
}

}  // namespace
}  // namespace koppel::test
