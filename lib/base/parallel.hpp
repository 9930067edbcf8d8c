#pragma once
/// Loops over chunks of work on several threads: the only place of the program that starts threads for numerics.
///
/// The caller cuts the work into chunks by the problem, never by the number of threads, and every chunk writes what no
/// other chunk of the same loop touches: the result then has the same bits for any number of threads.
#include <cstddef>
#include <memory>
#include <type_traits>

namespace muldi::base {

/// Sets how many threads (>= 1, the caller's counts) the loops may use; 1 at the start. Not from inside a loop.
void set_threads(int n);
/// Threads that the loops may use.
int n_threads();
/// Number of the calling thread, 0 to n_threads()-1: which of as many buffers a chunk may use. 0 outside of loops.
int thread_number();

/// Calls `chunk(context, i)` once for each i in 0..n_chunks-1, in any order; returns when all are done.
/// An exception of a chunk is thrown again here after the others have ended. A loop inside a loop, or beside another
/// thread's loop, runs on the calling thread.
void run_chunks(int n_chunks, void (*chunk)(void*, int), void* context);

/// Calls `f(i)` once for each chunk i in 0..n_chunks-1; see run_chunks. Requests no memory.
template <class F>
void parallel_for(int n_chunks, F&& f) {
  using Plain = std::remove_reference_t<F>;
  run_chunks(
      n_chunks, [](void* context, int i) { (*static_cast<Plain*>(context))(i); },
      const_cast<void*>(static_cast<const void*>(std::addressof(f))));
}

/// The i-th of `n_chunks` nearly equal ranges of 0..n-1.
struct ChunkRange {
  std::ptrdiff_t first = 0;
  std::ptrdiff_t last = 0;  ///< one past the end
};
constexpr ChunkRange chunk_range(std::ptrdiff_t n, int n_chunks, int i) {
  return {n * i / n_chunks, n * (i + 1) / n_chunks};
}

}  // namespace muldi::base
