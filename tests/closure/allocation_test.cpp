// Stepping allocates nothing: shown by counting what this thread asks of malloc.
#include <gtest/gtest.h>

#include "../allocations.hpp"
#include "closed.hpp"

namespace koppel::test {
namespace {

TEST(Allocation, IsSeenByTheCounter) {
  EXPECT_GT(allocations_of([] { Eigen::VectorXd::Ones(1000).eval(); }), 0);
}

class Stepping : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Of, Stepping, testing::Values("rstr", "multilink", "4bar", "5link", "stewart", "bennett"));

TEST_P(Stepping, AllocatesNothing) {
  Closed closed(shipped(GetParam()));
  constexpr double step = 1e-3;
  for (int i = 0; i < 3; ++i) ASSERT_GE(closed.move(i * step), 0);  // warm
  int failures = 0;
  const int count = allocations_of([&] {
    for (int i = 3; i < 103; ++i) failures += closed.move(i * step) < 0;
  });
  EXPECT_EQ(failures, 0);
  EXPECT_EQ(count, 0);
}

}  // namespace
}  // namespace koppel::test
