// Blocks of coordinates: integrate and difference undo each other, tangents are derivatives, normal stays normal.
#include "mechanism/coordinates.hpp"

#include <array>
#include <cstring>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "../plugin/curve.hpp"
#include "../spatial/directions.hpp"

namespace koppel::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double pi = std::numbers::pi;
using Numbers = std::array<double, 4>;
using Delta = std::array<double, 3>;

constexpr std::array<BlockKind, 4> kinds{BlockKind::line, BlockKind::angle, BlockKind::quaternion,
                                         BlockKind::unit_vector};

Numbers random_block(BlockKind kind, Random& random) {
  Numbers q{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
  normalise_block(kind, q.data());
  return q;
}

/// A tangent vector of a given length.
Delta random_delta(BlockKind kind, double length, Random& random) {
  Vector3 direction = Vector3::Zero();
  const auto n = static_cast<Eigen::Index>(rate_count(kind));
  while (!(direction.norm() > 0.1)) direction.head(n) = random.vector().head(n);
  direction *= length / direction.norm();
  return {direction[0], direction[1], direction[2]};
}

double apart(const Delta& a, const Delta& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

TEST(Block, DifferenceUndoesIntegrate) {
  Random random(1);
  for (const BlockKind kind : kinds) {
    for (const double length : {0.0, 1e-300, 1e-8, 0.1, 1.0, 3.0, pi - 1e-6}) {
      for (int i = 0; i < 100; ++i) {
        const Numbers from = random_block(kind, random);
        const Delta delta = random_delta(kind, length, random);
        Numbers to{};
        Delta back{};
        integrate_block(kind, from.data(), delta.data(), to.data());
        difference_block(kind, from.data(), to.data(), back.data());
        // Next to half a turn of a vector its direction is known to eps / (pi - length).
        const double steep = kind == BlockKind::unit_vector ? 1 / (pi - length) : 1;
        EXPECT_LE(apart(delta, back), 8 * eps * (1 + steep * length)) << static_cast<int>(kind) << " by " << length;
      }
    }
  }
}

TEST(Block, IntegrateReachesWhatDifferenceSaw) {
  Random random(2);
  for (const BlockKind kind : kinds) {
    for (int i = 0; i < 1000; ++i) {
      const Numbers from = random_block(kind, random), to = random_block(kind, random);
      Delta delta{};
      Numbers there{};
      difference_block(kind, from.data(), to.data(), delta.data());
      integrate_block(kind, from.data(), delta.data(), there.data());
      const double sign =
          kind == BlockKind::quaternion && there[0] * to[0] + there[1] * to[1] + there[2] * to[2] + there[3] * to[3] < 0
              ? -1
              : 1;
      for (std::size_t k = 0; k < coordinate_count(kind); ++k) EXPECT_NEAR(sign * there[k], to[k], 16 * eps);
    }
  }
}

TEST(Block, DifferenceCrossesHalfATurn) {
  const Numbers up{0, 0, 1, 0}, down{0, 0, -1, 0};
  Delta delta{};
  Numbers there{};
  difference_block(BlockKind::unit_vector, up.data(), down.data(), delta.data());
  EXPECT_NEAR(std::hypot(delta[0], delta[1]), pi, 4 * eps);
  integrate_block(BlockKind::unit_vector, up.data(), delta.data(), there.data());
  EXPECT_NEAR(there[2], -1, eps);

  const Numbers identity{1, 0, 0, 0}, turned{0, 0.6, 0, 0.8};
  difference_block(BlockKind::quaternion, identity.data(), turned.data(), delta.data());
  EXPECT_NEAR(std::hypot(delta[0], delta[1], delta[2]), pi, 4 * eps);
}

TEST(Block, DifferenceOfQuaternionsTakesTheShorterWay) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Numbers from = random_block(BlockKind::quaternion, random);
    const Delta step = random_delta(BlockKind::quaternion, 0.2, random);
    Numbers to{};
    integrate_block(BlockKind::quaternion, from.data(), step.data(), to.data());
    for (double& x : to) x = -x;  // the same rotation
    Delta delta{};
    difference_block(BlockKind::quaternion, from.data(), to.data(), delta.data());
    EXPECT_LE(apart(step, delta), 8 * eps);
  }
}

TEST(Block, TangentIsTheDerivativeOfIntegrate) {
  Random random(4);
  for (const BlockKind kind : kinds) {
    const std::size_t n = coordinate_count(kind), rates = rate_count(kind);
    const Numbers q = random_block(kind, random);
    std::array<double, 12> tangent{};
    tangent_block(kind, q.data(), tangent.data());
    for (std::size_t k = 0; k < n; ++k) {
      for (std::size_t j = 0; j < rates; ++j) {
        const double expected = derivative([&](double t) {
          Delta delta{};
          Numbers moved{};
          delta[j] = t;
          integrate_block(kind, q.data(), delta.data(), moved.data());
          return moved[k];
        });
        EXPECT_NEAR(tangent[k * rates + j], expected, 1e-13);
      }
    }
  }
}

TEST(Block, MayBeIntegratedInPlace) {
  Random random(5);
  for (const BlockKind kind : kinds) {
    Numbers q = random_block(kind, random), moved{};
    const Delta delta = random_delta(kind, 0.7, random);
    integrate_block(kind, q.data(), delta.data(), moved.data());
    integrate_block(kind, q.data(), delta.data(), q.data());
    EXPECT_EQ(std::memcmp(q.data(), moved.data(), coordinate_count(kind) * sizeof(double)), 0);
  }
}

TEST(Block, NormalisedOnceIsNormalisedForGood) {
  Random random(6);
  for (const BlockKind kind : {BlockKind::quaternion, BlockKind::unit_vector}) {
    for (int i = 0; i < 20'000; ++i) {
      const Numbers once = random_block(kind, random);
      Numbers twice = once;
      normalise_block(kind, twice.data());
      ASSERT_EQ(std::memcmp(once.data(), twice.data(), sizeof(once)), 0);
    }
  }
}

TEST(Block, IntegratedIsNormalToTheLastBit) {
  Random random(7);
  for (const BlockKind kind : {BlockKind::quaternion, BlockKind::unit_vector}) {
    Numbers q = random_block(kind, random);
    for (int i = 0; i < 20'000; ++i) {
      const Delta delta = random_delta(kind, 0.3, random);
      integrate_block(kind, q.data(), delta.data(), q.data());
      Numbers normal = q;
      normalise_block(kind, normal.data());
      ASSERT_EQ(std::memcmp(q.data(), normal.data(), coordinate_count(kind) * sizeof(double)), 0);
    }
  }
}

TEST(Block, OfLengthZeroBecomesTheNeutralOne) {
  for (const BlockKind kind : {BlockKind::quaternion, BlockKind::unit_vector}) {
    Numbers zero{}, neutral{};
    normalise_block(kind, zero.data());
    neutral_block(kind, neutral.data());
    EXPECT_EQ(zero, neutral);
  }
}

}  // namespace
}  // namespace koppel::test
