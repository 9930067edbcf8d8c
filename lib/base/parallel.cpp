#include "base/parallel.hpp"

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "base/error.hpp"

namespace muldi::base {
namespace {

/// True on the pool's threads and on a caller while its loop runs.
thread_local bool inside_a_loop = false;
/// 0 on every thread that the pool has not started.
thread_local int own_number = 0;

/// The fields of a loop are written while it is closed and `joined_` is 0; a thread counts itself in before it looks
/// whether the loop is open, so a late one never sees half-written fields.
class Pool {
 public:
  static Pool& instance() {
    static Pool pool;
    return pool;
  }

  ~Pool() { stop(); }

  int size() const { return n_threads_; }

  void resize(int n) {
    const std::lock_guard<std::mutex> only_one(caller_);
    if (n == n_threads_) return;
    stop();
    n_threads_ = n;
    stopping_ = false;
    for (int i = 1; i < n; ++i) threads_.emplace_back([this, i] { work(i); });
  }

  /// False if another thread's loop is running.
  bool run(int n_chunks, void (*chunk)(void*, int), void* context) {
    const std::unique_lock<std::mutex> only_one(caller_, std::try_to_lock);
    if (!only_one) return false;
    chunk_ = chunk;
    context_ = context;
    n_chunks_ = n_chunks;
    next_ = 0;
    failure_ = nullptr;
    open_ = true;
    {
      const std::lock_guard<std::mutex> lock(sleep_);
      ++loop_number_;
    }
    wake_.notify_all();
    inside_a_loop = true;
    run_open_chunks();
    inside_a_loop = false;
    open_ = false;
    while (joined_ != 0) std::this_thread::yield();
    if (failure_) std::rethrow_exception(failure_);
    return true;
  }

 private:
  void run_open_chunks() {
    for (int i = next_++; i < n_chunks_; i = next_++) {
      try {
        chunk_(context_, i);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(sleep_);
        if (!failure_) failure_ = std::current_exception();
      }
    }
  }

  void work(int number) {
    inside_a_loop = true;
    own_number = number;
    long seen = loop_number_;
    while (true) {
      // Loops follow each other within microseconds; sleeping at once would cost more than the loop.
      for (int spin = 0; spin < 200 && loop_number_ == seen && !stopping_; ++spin) std::this_thread::yield();
      if (loop_number_ == seen) {
        std::unique_lock<std::mutex> lock(sleep_);
        wake_.wait(lock, [&] { return loop_number_ != seen || stopping_; });
      }
      if (stopping_) return;
      seen = loop_number_;
      ++joined_;
      if (open_) run_open_chunks();
      --joined_;
    }
  }

  void stop() {
    {
      const std::lock_guard<std::mutex> lock(sleep_);
      stopping_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
  }

  std::mutex caller_;
  std::mutex sleep_;
  std::condition_variable wake_;
  std::vector<std::thread> threads_;
  int n_threads_ = 1;
  void (*chunk_)(void*, int) = nullptr;
  void* context_ = nullptr;
  int n_chunks_ = 0;
  std::exception_ptr failure_;
  std::atomic<int> next_{0};
  std::atomic<int> joined_{0};
  std::atomic<bool> open_{false};
  std::atomic<bool> stopping_{false};
  std::atomic<long> loop_number_{0};
};

}  // namespace

void set_threads(int n) {
  MULDI_EXPECT(n >= 1 && !inside_a_loop, "at least one thread, and not from inside a loop");
  Pool::instance().resize(n);
}

int n_threads() { return Pool::instance().size(); }

int thread_number() { return own_number; }

void run_chunks(int n_chunks, void (*chunk)(void*, int), void* context) {
  const bool alone = n_chunks <= 1 || inside_a_loop || Pool::instance().size() == 1;
  if (!alone && Pool::instance().run(n_chunks, chunk, context)) return;
  std::exception_ptr failure;
  for (int i = 0; i < n_chunks; ++i) {
    try {
      chunk(context, i);
    } catch (...) {
      if (!failure) failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace muldi::base
