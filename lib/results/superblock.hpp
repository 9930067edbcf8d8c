#pragma once
/// The first 48 bytes of an HDF5 file: what they say about its end and about who writes it.
/// Layout: HDF5 File Format Specification 3.0, section II.A (versions 2 and 3).
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace muldi::results {

constexpr std::size_t superblock_size = 48;
using SuperblockBytes = std::array<unsigned char, superblock_size>;

/// What matters here of a superblock.
struct Superblock {
  bool marked = false;              ///< marked as open for writing
  bool swmr = false;                ///< of these, the files that SWMR readers may open
  std::uint64_t end_of_file = 0;    ///< bytes that the file claims to have
  std::uint64_t bytes_on_disk = 0;  ///< bytes that it has
};

/// The superblock of a file, or nothing if the file is no HDF5 file, has an older format or a damaged superblock.
std::optional<Superblock> read_superblock(const std::string& path);

/// The same as bytes, of an open file.
std::optional<SuperblockBytes> read_superblock_bytes(int descriptor);

/// True for bytes that say that the file is open for writing.
bool is_marked(const SuperblockBytes& bytes);

/// The end that the bytes claim.
std::uint64_t end_of_file(const SuperblockBytes& bytes);

/// The bytes without a mark, with another end of the file, and with the checksum of both.
SuperblockBytes unmarked(SuperblockBytes bytes, std::uint64_t end_of_file);

}  // namespace muldi::results
