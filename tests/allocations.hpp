// Counts what a thread asks of malloc. It puts itself in the place of malloc, as the sanitizers do: for one file of a
// program, and none that sanitizers watch.
#pragma once

#include <cstdlib>

namespace koppel::test {

inline thread_local bool counting = false;
inline thread_local int allocations = 0;

inline void note_allocation() {
  if (counting) ++allocations;
}

/// How often an action asks for memory, in this thread.
template <typename Action>
int allocations_of(Action action) {
  allocations = 0;
  counting = true;
  action();
  counting = false;
  return allocations;
}

}  // namespace koppel::test

// glibc's own functions under the names that it offers to programs which replace malloc.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

__attribute__((visibility("default"))) void* malloc(std::size_t size) {
  koppel::test::note_allocation();
  return __libc_malloc(size);
}
__attribute__((visibility("default"))) void* calloc(std::size_t count, std::size_t size) {
  koppel::test::note_allocation();
  return __libc_calloc(count, size);
}
__attribute__((visibility("default"))) void* realloc(void* memory, std::size_t size) {
  koppel::test::note_allocation();
  return __libc_realloc(memory, size);
}
__attribute__((visibility("default"))) void* aligned_alloc(std::size_t alignment, std::size_t size) {
  koppel::test::note_allocation();
  return __libc_memalign(alignment, size);
}
}
