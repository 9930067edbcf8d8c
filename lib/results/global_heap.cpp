#include "results/global_heap.hpp"

#include <cstring>

namespace muldi::results {
namespace {

constexpr std::size_t header_bytes = 16;  // of a heap, and of every object in it
constexpr std::size_t size_at = 8;
constexpr std::uint64_t longest_heap = std::uint64_t{1} << 32;
constexpr unsigned char begin_of_heap[] = {'G', 'C', 'O', 'L', 1, 0, 0, 0};

template <class Number>
Number number_at(const unsigned char* bytes) {
  Number number;
  std::memcpy(&number, bytes, sizeof number);
  return number;
}

}  // namespace

bool HeapCheck::accepts(std::uint64_t at, const unsigned char* bytes, std::size_t size) {
  const bool begins = size >= header_bytes && std::memcmp(bytes, begin_of_heap, sizeof begin_of_heap) == 0;
  if (begins) {
    const auto length = number_at<std::uint64_t>(bytes + size_at);
    if (length < header_bytes || length > longest_heap) return false;
    next_ = at + header_bytes;
    end_ = at + length;
  }
  // A long heap comes in two reads.
  while (end_ > 0 && next_ >= at && next_ + header_bytes <= at + size && next_ + header_bytes <= end_) {
    const unsigned char* object = bytes + (next_ - at);
    const auto index = number_at<std::uint16_t>(object);
    const auto length = number_at<std::uint64_t>(object + size_at);
    if (length > longest_heap) return false;
    // Object 0 is the free rest, whose length counts its header; the others are padded to 8 bytes.
    const std::uint64_t step = index == 0 ? length : header_bytes + (length + 7) / 8 * 8;
    if (step < header_bytes || step > end_ - next_) return false;
    next_ += step;
  }
  if (next_ + header_bytes > end_) end_ = 0;
  return true;
}

}  // namespace muldi::results
