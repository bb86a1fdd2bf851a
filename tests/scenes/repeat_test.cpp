// The same input gives the same bits.
#include <thread>

#include <gtest/gtest.h>

#include "model.hpp"

namespace koppel::test {
namespace {

struct Bits : testing::TestWithParam<std::string> {
  const Model model{shipped_scene(GetParam())};
};

void expect_same(const Motion& a, const Motion& b) {
  EXPECT_TRUE(same_bits(a.positions(), b.positions()));
  EXPECT_TRUE(same_bits(a.velocities(), b.velocities()));
  EXPECT_TRUE(same_bits(a.accelerations(), b.accelerations()));
}

TEST_P(Bits, StayWhenAClosedStateIsClosedAgain) {
  Motion motion(model);
  for (std::size_t i = 0; i <= model.settings().steps; ++i) {
    ASSERT_TRUE(motion.move(model.time(i)));
    const Motion before(motion);
    ASSERT_TRUE(motion.close());
    ASSERT_TRUE(motion.rates());
    expect_same(before, motion);
  }
}

TEST_P(Bits, AreTheSameInTwoRuns) {
  const Model other(shipped_scene(GetParam()));
  Motion first(model), second(other);
  for (std::size_t i = 0; i <= model.settings().steps; ++i) {
    ASSERT_TRUE(first.move(model.time(i)));
    ASSERT_TRUE(second.move(model.time(i)));
    expect_same(first, second);
  }
}

TEST_P(Bits, AreTheSameInTwoThreads) {
  Motion first(model), second(model);
  std::thread one([&] { first.run_to(model.settings().steps); });
  std::thread two([&] { second.run_to(model.settings().steps); });
  one.join();
  two.join();
  expect_same(first, second);
}

// All history that matters is in the state, not in the scratch memory.
TEST_P(Bits, AreThoseOfTheOriginalWhenACopyMovesOn) {
  Motion original(model);
  original.run_to(model.settings().steps / 2);
  Motion copy(original);
  expect_same(original, copy);
  for (std::size_t i = model.settings().steps / 2; i <= model.settings().steps; ++i) {
    ASSERT_TRUE(original.move(model.time(i)));
    ASSERT_TRUE(copy.move(model.time(i)));
    expect_same(original, copy);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Bits, testing::ValuesIn(shipped_scenes()),
                         [](const auto& test) { return test_name(test.param); });

}  // namespace
}  // namespace koppel::test
