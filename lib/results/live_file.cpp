#include "results/live_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

#include "base/error.hpp"
#include "base/special_file.hpp"

namespace muldi::results {
namespace {

constexpr std::size_t superblock_size = 48;
constexpr std::size_t checksum_at = 44;
constexpr std::size_t version_at = 8;
constexpr std::size_t offset_size_at = 9;
constexpr std::size_t flags_at = 11;
constexpr std::size_t end_of_file_at = 28;
constexpr unsigned char write_marks = 0x05;  // write access, SWMR access
using Bytes = std::array<unsigned char, superblock_size>;

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

std::optional<Bytes> read_bytes(int descriptor) {
  constexpr std::array<unsigned char, 8> signature{0x89, 'H', 'D', 'F', '\r', '\n', 0x1a, '\n'};
  Bytes bytes{};
  if (::pread(descriptor, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) return {};
  if (std::memcmp(bytes.data(), signature.data(), signature.size()) != 0) return {};
  if (bytes[version_at] < 2 || bytes[version_at] > 3 || bytes[offset_size_at] != 8) return {};
  if (number_at<std::uint32_t>(bytes, checksum_at) != checksum(bytes)) return {};
  return bytes;
}

/// Locks the file against all others; false if another process keeps it for long. A reader that tries to open a file
/// which is just coming into being holds a lock for the moment of its attempt, and is waited for.
bool lock_out_others(int descriptor) {
  using namespace std::chrono_literals;
  const auto end = std::chrono::steady_clock::now() + 500ms;
  while (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    // File systems without locks are written without one.
    if (errno != EWOULDBLOCK) return true;
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

std::uint64_t size_of(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
}

}  // namespace

std::optional<Superblock> read_superblock(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return {};
  const auto bytes = read_bytes(descriptor);
  const std::uint64_t size = size_of(descriptor);
  ::close(descriptor);
  if (!bytes) return {};
  const unsigned marks = (*bytes)[flags_at] & write_marks;
  return Superblock{marks != 0, marks == write_marks, number_at<std::uint64_t>(*bytes, end_of_file_at), size};
}

void check_whole(const std::string& path) {
  const auto superblock = read_superblock(path);
  if (!superblock || LiveFile::is_live(path)) return;
  if (superblock->bytes_on_disk < superblock->end_of_file) {
    throw base::InputError("cannot read '" + path + "': truncated, it has " +
                           std::to_string(superblock->bytes_on_disk) + " of " +
                           std::to_string(superblock->end_of_file) + " bytes");
  }
  if (superblock->marked && !superblock->swmr) {
    throw base::InputError("cannot read '" + path +
                           "': its writer was killed while opening it; --resume mends it if it holds results");
  }
}

void remove_stale_mark(const std::string& path) {
  if (base::is_special_file(path)) return;
  const auto superblock = read_superblock(path);
  if (superblock && superblock->marked) LiveFile(path).open_to_readers(0);
}

LiveFile::LiveFile(const std::string& path) : path_(path) {
  descriptor_ = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (descriptor_ < 0) throw base::EnvironmentError("cannot write '" + path + "': " + std::strerror(errno));
  // Exclusive first, to find another writer; then shared, so that readers which lock (h5py does) get in.
  if (!lock_out_others(descriptor_)) {
    ::close(std::exchange(descriptor_, -1));
    throw base::InputError("'" + path + "' is in use by another process");
  }
  ::flock(descriptor_, LOCK_SH);
}

LiveFile::LiveFile(LiveFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), path_(std::move(other.path_)) {}

LiveFile& LiveFile::operator=(LiveFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(path_, other.path_);
  return *this;
}

LiveFile::~LiveFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void LiveFile::open_to_readers(std::uint64_t room) {
  auto bytes = read_bytes(descriptor_);
  if (!bytes) throw base::EnvironmentError("'" + path_ + "' was changed by another program while being written");
  if (((*bytes)[flags_at] & write_marks) == 0) return;  // the library has not rewritten it since the last time
  const std::uint64_t claimed = number_at<std::uint64_t>(*bytes, end_of_file_at) + room;
  const bool has_room = size_of(descriptor_) >= claimed || ::ftruncate(descriptor_, static_cast<off_t>(claimed)) == 0;
  (*bytes)[flags_at] = static_cast<unsigned char>((*bytes)[flags_at] & ~write_marks);
  // Where the room is not to be had (file size limit) the file keeps the end it has.
  if (has_room) put(*bytes, end_of_file_at, claimed);
  put(*bytes, checksum_at, checksum(*bytes));
  if (::pwrite(descriptor_, bytes->data(), bytes->size(), 0) != static_cast<ssize_t>(bytes->size())) {
    throw base::EnvironmentError("cannot write '" + path_ + "': " + std::strerror(errno));
  }
}

bool LiveFile::is_live(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool live = ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return live;
}

}  // namespace muldi::results
