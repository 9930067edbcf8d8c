#include "support/allocation_count.hpp"

#include <atomic>
#include <cstddef>

#if defined(__SANITIZE_ADDRESS__)
#define MULDI_COUNTS 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define MULDI_COUNTS 0
#endif
#endif
#ifndef MULDI_COUNTS
#define MULDI_COUNTS 1
#endif

namespace {
std::atomic<long> count{0};
}

#if MULDI_COUNTS
// The names under which glibc keeps its own functions when a program replaces them.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t size) {
  ++count;
  return __libc_malloc(size);
}
void* calloc(std::size_t n, std::size_t size) {
  ++count;
  return __libc_calloc(n, size);
}
void* realloc(void* memory, std::size_t size) {
  ++count;
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++count;
  return __libc_memalign(alignment, size);
}
}
#endif

namespace muldi::test {

long n_allocations() { return count; }
bool counts_allocations() { return MULDI_COUNTS != 0; }

}  // namespace muldi::test
