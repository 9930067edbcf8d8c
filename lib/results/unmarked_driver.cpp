#include "results/unmarked_driver.hpp"

#include <fcntl.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <new>
#include <vector>

#include "results/global_heap.hpp"
#include "results/superblock.hpp"

namespace muldi::results::hdf5 {
namespace {

constexpr std::size_t page_bytes = 4096;  // no larger than the kernel's: a page is written as a whole or not at all
constexpr std::size_t max_pages_a_call = 1024;
constexpr std::uint64_t room = std::uint64_t{1} << 20;
constexpr std::uint64_t spare = 4 * room;
using Page = std::array<unsigned char, page_bytes>;
using Pages = std::map<std::uint64_t, Page>;
using Order = Writing::Order;

/// An open file, as the library passes it around.
struct OpenFile : H5FD_t {
  int descriptor = -1;
  dev_t device = 0;
  ino_t inode = 0;
  Order order = Order::at_once;
  bool writes = false;     ///< open for writing, and not abandoned
  bool truncates = false;  ///< staged: the new file takes nothing from an old one
  std::uint64_t end_of_addresses = 0;
  std::uint64_t end = 0;      ///< of what is in the file, written or staged
  std::uint64_t claimed = 0;  ///< end that the superblock on the disk states
  bool touched = false;       ///< written at once
  bool failed = false;
  bool described = false;        ///< something that the superblock does not know of yet may be referred to
  SuperblockBytes superblock{};  ///< as the library wrote it last
  Pages pages;                   ///< staged
  HeapCheck heaps;
};

OpenFile& own(H5FD_t* file) { return *static_cast<OpenFile*>(file); }
const OpenFile& own(const H5FD_t* file) { return *static_cast<const OpenFile*>(file); }

/// Puts a reason on the library's error stack, whence hdf5_file.cpp takes it.
herr_t fail(const char* reason) {
  H5Epush2(H5E_DEFAULT, __FILE__, "unmarked_driver", __LINE__, H5E_ERR_CLS, H5E_IO, H5E_WRITEERROR, "%s", reason);
  return -1;
}

bool write_all(int descriptor, const unsigned char* bytes, std::size_t size, std::uint64_t at) {
  while (size > 0) {
    const ssize_t written = ::pwrite(descriptor, bytes, size, static_cast<off_t>(at));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes += written, at += static_cast<std::uint64_t>(written), size -= static_cast<std::size_t>(written);
  }
  return true;
}

/// What lies beyond the end is zero.
bool read_all(int descriptor, unsigned char* bytes, std::size_t size, std::uint64_t at) {
  while (size > 0) {
    const ssize_t got = ::pread(descriptor, bytes, size, static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return false;
    if (got == 0) break;
    bytes += got, at += static_cast<std::uint64_t>(got), size -= static_cast<std::size_t>(got);
  }
  std::memset(bytes, 0, size);
  return true;
}

std::uint64_t size_on_disk(const OpenFile& file) {
  struct stat status {};
  return ::fstat(file.descriptor, &status) == 0 ? static_cast<std::uint64_t>(status.st_size) : 0;
}

bool set_size(const OpenFile& file, std::uint64_t size) {
  return ::ftruncate(file.descriptor, static_cast<off_t>(size)) == 0;
}

/// Bytes beyond the end that the superblock states hurt nobody.
void set_size_if_possible(const OpenFile& file, std::uint64_t size) { static_cast<void>(set_size(file, size)); }

/// Makes the file on the disk, and its superblock, reach beyond `end`, the file further than the superblock: a reader
/// that asks for the size, then reads the superblock, must not find there an end beyond that size, which to the library
/// is a truncated file. All of it is sparse; where it is not to be had (file size limit) the file does without.
bool claim(OpenFile& file, std::uint64_t end) {
  const std::uint64_t present = size_on_disk(file);
  std::uint64_t next = end + room;
  if (present < next + spare && !set_size(file, next + spare) && present < next && !set_size(file, next)) {
    next = end;
    if (present < next && !set_size(file, next)) return false;
  }
  const SuperblockBytes bytes = unmarked(file.superblock, next);
  if (!write_all(file.descriptor, bytes.data(), bytes.size(), 0)) return false;
  file.claimed = next;
  return true;
}

/// Writes the superblock that the library has just given.
bool write_superblock(OpenFile& file) {
  const std::uint64_t end = end_of_file(file.superblock);
  if (end > file.claimed) return claim(file, end);
  const SuperblockBytes bytes = unmarked(file.superblock, file.claimed);
  return write_all(file.descriptor, bytes.data(), bytes.size(), 0);
}

/// Gives back the room; of a file that was not brought to its end, up to all that may be referred to.
bool release(const OpenFile& file) {
  const bool whole = file.writes && !file.failed;
  const std::uint64_t known = end_of_file(file.superblock);
  const std::uint64_t end = whole ? file.end_of_addresses : file.described ? std::max(known, file.end) : known;
  const SuperblockBytes bytes = unmarked(file.superblock, end);
  const bool good = write_all(file.descriptor, bytes.data(), bytes.size(), 0);
  if (good) set_size_if_possible(file, end);
  return good;
}

bool write_at_once(OpenFile& file, std::uint64_t at, const unsigned char* bytes, std::size_t size) {
  file.touched = true;
  const std::size_t of_superblock = at < superblock_size ? std::min(size, superblock_size - at) : 0;
  if (size > of_superblock) {
    if (at + size > file.claimed && !claim(file, at + size)) return false;
    if (!write_all(file.descriptor, bytes + of_superblock, size - of_superblock, at + of_superblock)) return false;
  }
  if (of_superblock == 0) return true;
  std::memcpy(file.superblock.data() + at, bytes, of_superblock);
  return write_superblock(file);
}

/// Calls `action(page number, begin in the page, bytes, begin in the whole)` for every page of a range.
template <class Action>
bool for_pages(std::uint64_t at, std::size_t size, Action action) {
  for (std::size_t done = 0; done < size;) {
    const std::uint64_t number = (at + done) / page_bytes;
    const auto begin = static_cast<std::size_t>((at + done) % page_bytes);
    const std::size_t part = std::min(size - done, page_bytes - begin);
    if (!action(number, begin, part, done)) return false;
    done += part;
  }
  return true;
}

bool stage(OpenFile& file, std::uint64_t at, const unsigned char* bytes, std::size_t size) {
  return for_pages(at, size, [&](std::uint64_t number, std::size_t begin, std::size_t part, std::size_t done) {
    const auto [place, is_new] = file.pages.try_emplace(number);
    Page& page = place->second;
    if (is_new && !file.truncates && part < page_bytes &&
        !read_all(file.descriptor, page.data(), page_bytes, number * page_bytes)) {
      return false;
    }
    std::memcpy(page.data() + begin, bytes + done, part);
    return true;
  });
}

bool read_staged(const OpenFile& file, std::uint64_t at, unsigned char* bytes, std::size_t size) {
  if (file.truncates) {
    std::memset(bytes, 0, size);
  } else if (!read_all(file.descriptor, bytes, size, at)) {
    return false;
  }
  return for_pages(at, size, [&](std::uint64_t number, std::size_t begin, std::size_t part, std::size_t done) {
    const auto page = file.pages.find(number);
    if (page != file.pages.end()) std::memcpy(bytes + done, page->second.data() + begin, part);
    return true;
  });
}

/// Writes neighbouring pages, of the last one only what lies within the file.
bool write_run(const OpenFile& file, Pages::const_iterator first, std::size_t count) {
  std::uint64_t at = first->first * page_bytes;
  std::size_t size = static_cast<std::size_t>(std::min<std::uint64_t>(file.end_of_addresses - at, count * page_bytes));
  std::vector<iovec> parts;
  parts.reserve(count);
  for (std::size_t left = size; left > 0; left -= parts.back().iov_len, ++first) {
    parts.push_back({const_cast<unsigned char*>(first->second.data()), std::min(left, page_bytes)});
  }
  for (iovec* part = parts.data(); size > 0;) {
    const auto n = static_cast<int>(parts.data() + parts.size() - part);
    const ssize_t written = ::pwritev(file.descriptor, part, n, static_cast<off_t>(at));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    at += static_cast<std::uint64_t>(written), size -= static_cast<std::size_t>(written);
    auto rest = static_cast<std::size_t>(written);
    for (; rest > 0 && rest >= part->iov_len; ++part) rest -= part->iov_len;
    if (rest > 0) *part = {static_cast<unsigned char*>(part->iov_base) + rest, part->iov_len - rest};
  }
  return true;
}

/// Brings the staged pages to the disk, neighbours together, the first page alone and last.
bool write_staged(const OpenFile& file) {
  if (file.truncates && !set_size(file, 0)) return false;
  // Where one process fills the disk and another is killed the file has at least all that its first page speaks of.
  if (size_on_disk(file) < file.end_of_addresses && !set_size(file, file.end_of_addresses)) return false;
  // Groups may refer to what is new before the first page, and its end of the file, are written.
  if (file.claimed > 0 && !file.truncates && file.claimed < file.end_of_addresses) {
    const SuperblockBytes bytes = unmarked(file.superblock, file.end_of_addresses);
    if (!write_all(file.descriptor, bytes.data(), bytes.size(), 0)) return false;
  }
  std::vector<std::pair<Pages::const_iterator, std::size_t>> runs;
  for (auto page = file.pages.begin(); page != file.pages.end(); ++page) {
    if (page->first * page_bytes >= file.end_of_addresses) break;
    const bool goes_on = !runs.empty() && runs.back().second < max_pages_a_call && runs.back().first->first != 0 &&
                         runs.back().first->first + runs.back().second == page->first;
    if (goes_on) {
      ++runs.back().second;
    } else {
      runs.emplace_back(page, 1);
    }
  }
  if (file.order == Order::highest_first) {
    std::ranges::reverse(runs);
  } else if (!runs.empty() && runs.front().first->first == 0) {
    std::rotate(runs.begin(), runs.begin() + 1, runs.end());
  }
  const bool good = std::ranges::all_of(runs, [&](const auto& run) { return write_run(file, run.first, run.second); });
  if (good) set_size_if_possible(file, file.end_of_addresses);
  return good;
}

H5FD_t* open(const char* name, unsigned flags, hid_t access, haddr_t) {
  int mode = (flags & H5F_ACC_RDWR) != 0U ? O_RDWR : O_RDONLY;
  if ((flags & H5F_ACC_CREAT) != 0U) mode |= O_CREAT;
  if ((flags & H5F_ACC_EXCL) != 0U) mode |= O_EXCL;
  const int descriptor = ::open(name, mode | O_CLOEXEC, 0666);
  struct stat status {};
  if (descriptor < 0 || ::fstat(descriptor, &status) != 0) {
    fail(std::strerror(errno));
    if (descriptor >= 0) ::close(descriptor);
    return nullptr;
  }
  std::unique_ptr<OpenFile> file;
  try {
    file = std::make_unique<OpenFile>();
  } catch (const std::bad_alloc&) {
    fail("out of memory");
    ::close(descriptor);
    return nullptr;
  }
  file->descriptor = descriptor;
  file->device = status.st_dev;
  file->inode = status.st_ino;
  if (const void* writing = H5Pget_driver_info(access)) file->order = static_cast<const Writing*>(writing)->order;
  file->writes = (flags & H5F_ACC_RDWR) != 0U;
  file->truncates = (flags & H5F_ACC_TRUNC) != 0U;
  file->end = file->truncates ? 0 : static_cast<std::uint64_t>(status.st_size);
  if (const auto bytes = read_superblock_bytes(descriptor)) {
    file->superblock = *bytes;
    file->claimed = std::min(end_of_file(*bytes), static_cast<std::uint64_t>(status.st_size));
  }
  return file.release();
}

herr_t close(H5FD_t* handle) {
  OpenFile& file = own(handle);
  bool good = true;
  try {
    if (file.touched) good = release(file);
    if (file.writes && !file.pages.empty()) good = write_staged(file);
  } catch (const std::bad_alloc&) {
    errno = ENOMEM, good = false;
  }
  const int error = errno;
  ::close(file.descriptor);
  delete &file;
  return good ? 0 : fail(std::strerror(error));
}

int compare(const H5FD_t* first, const H5FD_t* second) {
  const OpenFile &a = own(first), &b = own(second);
  if (a.device != b.device) return a.device < b.device ? -1 : 1;
  if (a.inode != b.inode) return a.inode < b.inode ? -1 : 1;
  return 0;
}

/// Those of the library's own driver for files (sec2).
herr_t query(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_SUPPORTS_SWMR_IO | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
  return 0;
}

haddr_t get_end_of_addresses(const H5FD_t* file, H5FD_mem_t) { return own(file).end_of_addresses; }
haddr_t get_end(const H5FD_t* file, H5FD_mem_t) { return own(file).end; }

herr_t set_end_of_addresses(H5FD_t* file, H5FD_mem_t, haddr_t end) {
  own(file).end_of_addresses = end;
  return 0;
}

herr_t get_handle(H5FD_t* file, hid_t, void** handle) {
  *handle = &own(file);
  return 0;
}

// NOLINTNEXTLINE(readability-function-size): the parameters are those of H5FD_class_t.
herr_t read(H5FD_t* handle, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, void* buffer) {
  OpenFile& file = own(handle);
  auto* bytes = static_cast<unsigned char*>(buffer);
  const bool staged = file.order != Order::at_once;
  const bool good = staged ? read_staged(file, at, bytes, size) : read_all(file.descriptor, bytes, size, at);
  if (!good) return fail(std::strerror(errno));
  return file.heaps.accepts(at, bytes, size) ? 0 : fail("damaged: a text is longer than the place where it is kept");
}

// NOLINTNEXTLINE(readability-function-size): as read.
herr_t write(H5FD_t* handle, H5FD_mem_t type, hid_t, haddr_t at, std::size_t size, const void* buffer) {
  OpenFile& file = own(handle);
  if (!file.writes) return 0;
  const auto* bytes = static_cast<const unsigned char*>(buffer);
  try {
    const bool staged = file.order != Order::at_once;
    if (type != H5FD_MEM_DRAW) file.described = at >= superblock_size;
    if (!(staged ? stage(file, at, bytes, size) : write_at_once(file, at, bytes, size))) {
      file.failed = true;
      return fail(std::strerror(errno));
    }
  } catch (const std::bad_alloc&) {
    return fail("out of memory");
  }
  file.end = std::max(file.end, at + size);
  return 0;
}

/// A file never becomes shorter than its superblock says: that is done after the last superblock, by `close`.
herr_t truncate(H5FD_t*, hid_t, hbool_t) { return 0; }

H5FD_class_t make_driver(const char* name) {
  H5FD_class_t driver{};
  driver.name = name;
  driver.maxaddr = static_cast<haddr_t>(std::numeric_limits<off_t>::max());
  driver.fc_degree = H5F_CLOSE_WEAK;
  driver.fapl_size = sizeof(Writing);
  driver.open = open;
  driver.close = close;
  driver.cmp = compare;
  driver.query = query;
  driver.get_eoa = get_end_of_addresses;
  driver.set_eoa = set_end_of_addresses;
  driver.get_eof = get_end;
  driver.get_handle = get_handle;
  driver.read = read;
  driver.write = write;
  driver.truncate = truncate;
  constexpr H5FD_mem_t map[] = H5FD_FLMAP_DICHOTOMY;
  std::ranges::copy(map, driver.fl_map);
  return driver;
}

}  // namespace

bool set_driver(std::int64_t access_properties, Writing writing) {
  static const H5FD_class_t driver = make_driver("muldi_unmarked");
  static const hid_t id = H5FDregister(&driver);
  return id >= 0 && H5Pset_driver(access_properties, id, &writing) >= 0;
}

bool set_reading_driver(std::int64_t access_properties) {
  static const H5FD_class_t driver = make_driver("muldi_reader");
  static const hid_t id = H5FDregister(&driver);
  const Writing nothing;
  return id >= 0 && H5Pset_driver(access_properties, id, &nothing) >= 0;
}

void abandon(void* handle) { static_cast<OpenFile*>(handle)->writes = false; }

}  // namespace muldi::results::hdf5
