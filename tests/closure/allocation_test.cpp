// Stepping allocates nothing: shown by counting what this thread asks of malloc.
#include <cstdlib>

#include <gtest/gtest.h>

#include "closed.hpp"

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
void* __libc_memalign(std::size_t alignment, std::size_t size);

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
__attribute__((visibility("default"))) void* aligned_alloc(std::size_t alignment, std::size_t size) {
  note();
  return __libc_memalign(alignment, size);
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
