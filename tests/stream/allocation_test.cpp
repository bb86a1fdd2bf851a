// Handing a snapshot over allocates nothing: shown by counting what this thread asks of malloc.
#include <cstdlib>

#include <gtest/gtest.h>

#include "example.hpp"

namespace {

thread_local bool counting = false;
thread_local int allocations = 0;

void note() {
  if (counting) ++allocations;
}

}  // namespace

// glibc's own functions under the names that it offers to programs which replace malloc.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);

__attribute__((visibility("default"))) void* malloc(std::size_t size) {
  note();
  return __libc_malloc(size);
}
__attribute__((visibility("default"))) void* calloc(std::size_t count, std::size_t size) {
  note();
  return __libc_calloc(count, size);
}
__attribute__((visibility("default"))) void* realloc(void* memory, std::size_t size) {
  note();
  return __libc_realloc(memory, size);
}
}

namespace koppel::test {
namespace {

template <typename Action>
int allocations_of(Action action) {
  allocations = 0;
  counting = true;
  action();
  counting = false;
  return allocations;
}

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
