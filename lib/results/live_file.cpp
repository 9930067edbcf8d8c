#include "results/live_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>
#include <utility>

#include "base/error.hpp"
#include "base/special_file.hpp"
#include "results/superblock.hpp"

namespace muldi::results {
namespace {

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

}  // namespace

void check_begun(const std::string& path) {
  std::array<char, 8> begin{};
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const ssize_t got = descriptor < 0 ? -1 : ::pread(descriptor, begin.data(), begin.size(), 0);
  if (descriptor >= 0) ::close(descriptor);
  // The page of the signature is written last.
  if (got < 0 || begin != std::array<char, 8>{}) return;
  throw base::InputError("cannot read '" + path + "': it is empty: " +
                         (LiveFile::is_live(path) ? "a run is just making it; try again in a moment"
                                                  : "no result, or its run was killed before its start was recorded"));
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
  if (!superblock || !superblock->marked) return;
  const LiveFile lock(path);
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  const auto bytes = read_superblock_bytes(descriptor);
  bool good = bytes.has_value();
  if (good) {
    const SuperblockBytes mended = unmarked(*bytes, end_of_file(*bytes));
    good = ::pwrite(descriptor, mended.data(), mended.size(), 0) == static_cast<ssize_t>(mended.size());
  }
  const int error = errno;
  ::close(descriptor);
  if (!good) throw base::EnvironmentError("cannot write '" + path + "': " + std::strerror(error));
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

bool LiveFile::is_live(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool live = ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return live;
}

}  // namespace muldi::results
