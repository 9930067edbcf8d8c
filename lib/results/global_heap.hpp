#pragma once
/// Global heaps: where an HDF5 file keeps the texts of its attributes, the one part of it without a checksum.
///
/// The library believes the sizes that a heap states and reads beyond its end where they are wrong. Here they are
/// checked as the heap is read, before the library looks at it.
/// Layout: HDF5 File Format Specification 3.0, section III.E.
#include <cstddef>
#include <cstdint>

namespace muldi::results {

/// Follows the reads of a file.
class HeapCheck {
 public:
  /// `bytes`: what was read at the address `at`. False where they are, or go on with, a heap whose objects do not lie
  /// inside it.
  bool accepts(std::uint64_t at, const unsigned char* bytes, std::size_t size);

 private:
  std::uint64_t next_ = 0;  // address of the next object's header
  std::uint64_t end_ = 0;   // of the heap; 0: none is being read
};

}  // namespace muldi::results
