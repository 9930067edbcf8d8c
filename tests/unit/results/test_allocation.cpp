#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "recording.hpp"

namespace {
std::atomic<long> n_allocations{0};
}

// Counted for this program only. The HDF5 library allocates with malloc: its calls are not ours.
// Not inlined: GCC would take malloc and free for mismatched partners of new and delete.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++n_allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace muldi::results {
namespace {

TEST(Allocation, AppendingDoesNotAllocate) {
  const Scratch scratch;
  Hdf5Recorder recorder({.path = scratch / "a.h5"});
  Recording recording(recorder);
  recorder.start();
  const Checkpoint checkpoint = Recording::checkpoint(1);
  const std::array<double, 3> position{1.0, 2.0, 3.0};
  const std::array<double, 9> orientation{};
  const auto append_rows = [&](int n) {
    for (int i = 0; i < n; ++i) {
      recorder.append(recording.run.axis, i);
      recorder.append(recording.position, position);
      recorder.append(recording.orientation, orientation);
      recorder.append(recording.iterations, 1);
      recorder.write_checkpoint(checkpoint);
    }
  };
  append_rows(1);
  recorder.flush();  // the first rows open the data sets
  const long before = n_allocations;
  append_rows(3000);  // several full blocks: writing them does not allocate either
  EXPECT_EQ(n_allocations - before, 0);
  EXPECT_GT(before, 0) << "allocations are counted";
  recorder.close({.status = "completed"});
}

}  // namespace
}  // namespace muldi::results
