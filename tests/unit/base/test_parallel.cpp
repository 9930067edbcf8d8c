#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

#include "base/error.hpp"
#include "base/parallel.hpp"

namespace muldi::base {
namespace {

class Parallel : public testing::TestWithParam<int> {
 protected:
  void SetUp() override { set_threads(GetParam()); }
  void TearDown() override { set_threads(1); }
};

TEST_P(Parallel, VisitsEveryChunkOnce) {
  for (int n : {0, 1, 2, 7, 100}) {
    for (int repeat = 0; repeat < 200; ++repeat) {
      std::vector<int> visits(static_cast<std::size_t>(n), 0);
      parallel_for(n, [&](int i) { ++visits[static_cast<std::size_t>(i)]; });
      EXPECT_EQ(visits, std::vector<int>(visits.size(), 1));
    }
  }
}

TEST_P(Parallel, NumbersItsThreads) {
  std::vector<std::atomic<int>> inside(static_cast<std::size_t>(GetParam()));
  std::atomic<int> clashes{0};
  parallel_for(200, [&](int) {
    ASSERT_LT(thread_number(), GetParam());
    std::atomic<int>& own = inside[static_cast<std::size_t>(thread_number())];
    if (++own != 1) ++clashes;
    --own;
  });
  EXPECT_EQ(clashes, 0) << "two threads at a time have different numbers";
  EXPECT_EQ(thread_number(), 0);
}

TEST_P(Parallel, RunsALoopInsideALoop) {
  std::atomic<int> sum{0};
  parallel_for(4, [&](int i) { parallel_for(5, [&](int j) { sum += 10 * i + j; }); });
  EXPECT_EQ(sum, 5 * 60 + 4 * 10);
}

TEST_P(Parallel, EndsAllChunksAndThrowsTheException) {
  std::atomic<int> ended{0};
  const auto loop = [&] {
    parallel_for(10, [&](int i) {
      if (i == 3) throw std::runtime_error("three");
      ++ended;
    });
  };
  EXPECT_THROW(loop(), std::runtime_error);
  EXPECT_EQ(ended, 9);
  parallel_for(10, [&](int) { ++ended; });
  EXPECT_EQ(ended, 19) << "the next loop runs as usual";
}

TEST_P(Parallel, ServesSeveralCallersAtOnce) {
  std::atomic<long> sum{0};
  std::vector<std::thread> callers;
  for (int c = 0; c < 3; ++c) {
    callers.emplace_back([&] {
      for (int repeat = 0; repeat < 300; ++repeat) parallel_for(8, [&](int i) { sum += i; });
    });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(sum, 3L * 300 * 28);
}

INSTANTIATE_TEST_SUITE_P(Threads, Parallel, testing::Values(1, 2, 4));

TEST(ParallelThreads, RefuseNone) { EXPECT_THROW(set_threads(0), ContractError); }

TEST(ChunkRange, CoversAllWithoutOverlap) {
  for (int i = 0; i < 7; ++i) EXPECT_EQ(chunk_range(100, 7, i).last, i == 6 ? 100 : chunk_range(100, 7, i + 1).first);
  EXPECT_EQ(chunk_range(100, 7, 0).first, 0);
}

}  // namespace
}  // namespace muldi::base
