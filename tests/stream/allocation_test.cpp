// Handing a snapshot over allocates nothing: shown by counting what this thread asks of malloc.
#include <gtest/gtest.h>

#include "../allocations.hpp"
#include "example.hpp"

namespace koppel::test {
namespace {

TEST(Allocation, IsSeenByTheCounter) {
  EXPECT_GT(allocations_of([] { example_model(); }), 0);
}

TEST(Allocation, DoesNotHappenInPublish) {
  for (const bool lossless : {false, true}) {
    const auto record = std::make_shared<Record>();
    auto publisher =
        Publisher::open(example_model(), {}, std::make_unique<RecordingSink>(record, lossless), silent_logger());
    ASSERT_TRUE(publisher);
    const int count = allocations_of([&] {
      for (int n = 0; n < 10'000; ++n) (void)(*publisher)->publish(Numbers(n).snapshot());
    });
    EXPECT_EQ(count, 0) << (lossless ? "lossless" : "network");
    ASSERT_TRUE((*publisher)->close());
  }
}

}  // namespace
}  // namespace koppel::test
