#pragma once
/// Counts the memory requests of a whole program: link allocation_count.cpp into it.

namespace muldi::test {

/// Calls of malloc, calloc, realloc and aligned_alloc since the start (operator new calls malloc).
long n_allocations();
/// False where a sanitizer owns the allocator; n_allocations is 0 then.
bool counts_allocations();

}  // namespace muldi::test
