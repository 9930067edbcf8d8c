#include "results/superblock.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cstring>

namespace muldi::results {
namespace {

constexpr std::size_t checksum_at = 44;
constexpr std::size_t version_at = 8;
constexpr std::size_t offset_size_at = 9;
constexpr std::size_t flags_at = 11;
constexpr std::size_t end_of_file_at = 28;
constexpr unsigned char write_marks = 0x05;  // write access, SWMR access
using Bytes = SuperblockBytes;

template <class Number>
Number number_at(const Bytes& bytes, std::size_t at) {
  Number number;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

template <class Number>
void put(Bytes& bytes, std::size_t at, Number number) {
  std::memcpy(bytes.data() + at, &number, sizeof number);
}

/// Jenkins' lookup3 (public domain) of the bytes before the checksum: 44 bytes, three blocks of 12 and a tail of 8.
std::uint32_t checksum(const Bytes& bytes) {
  std::uint32_t a = 0xdeadbeef + static_cast<std::uint32_t>(checksum_at);
  std::uint32_t b = a;
  std::uint32_t c = a;
  for (std::size_t at = 0; at < 36; at += 12) {
    a += number_at<std::uint32_t>(bytes, at);
    b += number_at<std::uint32_t>(bytes, at + 4);
    c += number_at<std::uint32_t>(bytes, at + 8);
    a = (a - c) ^ std::rotl(c, 4), c += b;
    b = (b - a) ^ std::rotl(a, 6), a += c;
    c = (c - b) ^ std::rotl(b, 8), b += a;
    a = (a - c) ^ std::rotl(c, 16), c += b;
    b = (b - a) ^ std::rotl(a, 19), a += c;
    c = (c - b) ^ std::rotl(b, 4), b += a;
  }
  a += number_at<std::uint32_t>(bytes, 36);
  b += number_at<std::uint32_t>(bytes, 40);
  c = (c ^ b) - std::rotl(b, 14);
  a = (a ^ c) - std::rotl(c, 11);
  b = (b ^ a) - std::rotl(a, 25);
  c = (c ^ b) - std::rotl(b, 16);
  a = (a ^ c) - std::rotl(c, 4);
  b = (b ^ a) - std::rotl(a, 14);
  return (c ^ b) - std::rotl(b, 24);
}

std::uint64_t size_of(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
}

}  // namespace

std::optional<SuperblockBytes> read_superblock_bytes(int descriptor) {
  constexpr std::array<unsigned char, 8> signature{0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
  Bytes bytes{};
  if (::pread(descriptor, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) return {};
  if (std::memcmp(bytes.data(), signature.data(), signature.size()) != 0) return {};
  if (bytes[version_at] < 2 || bytes[version_at] > 3 || bytes[offset_size_at] != 8) return {};
  if (number_at<std::uint32_t>(bytes, checksum_at) != checksum(bytes)) return {};
  return bytes;
}

std::optional<Superblock> read_superblock(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return {};
  const auto bytes = read_superblock_bytes(descriptor);
  const std::uint64_t size = size_of(descriptor);
  ::close(descriptor);
  if (!bytes) return {};
  const unsigned marks = (*bytes)[flags_at] & write_marks;
  return Superblock{marks != 0, marks == write_marks, number_at<std::uint64_t>(*bytes, end_of_file_at), size};
}

bool is_marked(const SuperblockBytes& bytes) { return (bytes[flags_at] & write_marks) != 0; }

std::uint64_t end_of_file(const SuperblockBytes& bytes) { return number_at<std::uint64_t>(bytes, end_of_file_at); }

SuperblockBytes unmarked(SuperblockBytes bytes, std::uint64_t end_of_file) {
  bytes[flags_at] = static_cast<unsigned char>(bytes[flags_at] & ~write_marks);
  put(bytes, end_of_file_at, end_of_file);
  put(bytes, checksum_at, checksum(bytes));
  return bytes;
}

}  // namespace muldi::results
