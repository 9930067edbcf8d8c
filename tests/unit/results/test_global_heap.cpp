#include <gtest/gtest.h>

#include <cstring>
#include <string>
#include <vector>

#include "results/global_heap.hpp"

namespace muldi::results {
namespace {

constexpr std::uint64_t address = 8192;

template <class Number>
void put(std::vector<unsigned char>& bytes, std::size_t at, Number number) {
  std::memcpy(bytes.data() + at, &number, sizeof number);
}

/// A heap of two objects of 5 and 24 bytes, at 16 and 40, and a free rest at 80.
std::vector<unsigned char> heap(std::size_t size = 4096) {
  std::vector<unsigned char> bytes(size);
  std::memcpy(bytes.data(), "GCOL\1", 5);
  put<std::uint64_t>(bytes, 8, size);
  put<std::uint16_t>(bytes, 16, 1);
  put<std::uint64_t>(bytes, 24, 5);
  put<std::uint16_t>(bytes, 40, 2);
  put<std::uint64_t>(bytes, 48, 24);
  put<std::uint64_t>(bytes, 88, size - 80);
  return bytes;
}

bool accepts(const std::vector<unsigned char>& bytes) {
  return HeapCheck().accepts(address, bytes.data(), bytes.size());
}

TEST(HeapCheck, AcceptsAWholeHeapAndWhatIsNone) {
  EXPECT_TRUE(accepts(heap()));
  EXPECT_TRUE(accepts({}));
  EXPECT_TRUE(accepts(std::vector<unsigned char>(100, 0xff)));
}

TEST(HeapCheck, RefusesSizesBeyondTheHeap) {
  for (const std::size_t size_at : {24, 48, 88}) {
    for (const std::uint64_t size :
         {std::uint64_t{4096}, std::uint64_t{1} << 40, ~std::uint64_t{0}, ~std::uint64_t{6}}) {
      std::vector<unsigned char> bytes = heap();
      put(bytes, size_at, size);
      EXPECT_FALSE(accepts(bytes)) << size_at << ' ' << size;
    }
  }
  std::vector<unsigned char> endless = heap();
  put<std::uint64_t>(endless, 88, 0);
  EXPECT_FALSE(accepts(endless)) << "the library would never come to the end";
  std::vector<unsigned char> tiny = heap();
  put<std::uint64_t>(tiny, 8, 8);
  EXPECT_FALSE(accepts(tiny));
}

TEST(HeapCheck, FollowsAHeapThatComesInTwoReads) {
  std::vector<unsigned char> bytes = heap(8192);
  // The second object reaches into the second read, where the free rest begins.
  put<std::uint64_t>(bytes, 48, 4096);
  const std::size_t rest = 40 + 16 + 4096;
  put<std::uint64_t>(bytes, rest + 8, 8192 - rest);
  HeapCheck whole;
  EXPECT_TRUE(whole.accepts(address, bytes.data(), 4096));
  EXPECT_TRUE(whole.accepts(address + 4096, bytes.data() + 4096, 4096));
  put<std::uint64_t>(bytes, rest + 8, 8192);
  HeapCheck damaged;
  EXPECT_TRUE(damaged.accepts(address, bytes.data(), 4096));
  EXPECT_FALSE(damaged.accepts(address + 4096, bytes.data() + 4096, 4096));
}

}  // namespace
}  // namespace muldi::results
