/// A disk that breaks at a chosen moment, to be loaded before the program (LD_PRELOAD): result files only.
///   BROKEN_DISK=kill:K   the process is killed before its K-th change of a file *.h5 (writes and new sizes, from 1)
///   BROKEN_DISK=torn:K   the same, after the first pages of that change
///   BROKEN_DISK=once:K   the K-th change fails: no space left
///   BROKEN_DISK=full:K   so do all that follow
///   BROKEN_DISK=count:PATH   nothing breaks; the number of changes is written to PATH
#include <dlfcn.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

namespace {

constexpr std::size_t page = 4096;

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

bool is_result(int descriptor) {
  char path[4096];
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t size = ::readlink(link.c_str(), path, sizeof path);
  return size > 3 && std::strncmp(path + size - 3, ".h5", 3) == 0;
}

struct Plan {
  std::string what, argument;
  long at = 0;
  std::atomic<long> changes{0};

  Plan() {
    const char* text = std::getenv("BROKEN_DISK");
    if (text == nullptr) return;
    const std::string plan = text;
    what = plan.substr(0, plan.find(':'));
    argument = plan.substr(plan.find(':') + 1);
    at = std::atol(argument.c_str());
  }
  ~Plan() {
    if (what == "count") std::ofstream(argument) << changes.load() << '\n';
  }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;
};

Plan& plan() {
  static Plan the_plan;
  return the_plan;
}

enum class Fate { works, tears, fails };

Fate next_change(int descriptor) {
  Plan& the = plan();
  if (the.what.empty() || !is_result(descriptor)) return Fate::works;
  const long number = ++the.changes;
  if (number == the.at && the.what == "kill") std::raise(SIGKILL);
  if (number == the.at && the.what == "torn") return Fate::tears;
  const bool fails = (number == the.at && the.what == "once") || (number >= the.at && the.what == "full");
  if (!fails) return Fate::works;
  errno = ENOSPC;
  return Fate::fails;
}

/// The part of a write that a kill between two pages lets through: up to the last border of pages in its first half.
/// Less than a page is taken as one piece: the instant between two pages of one small write (a header of a data set
/// that crosses their border) is beyond what a file format can mend.
std::size_t torn(std::size_t size, off_t at) {
  if (size < page) return 0;
  const std::size_t begin = static_cast<std::size_t>(at) % page;
  const std::size_t half = (begin + size / 2 + 1) / page * page;
  return half > begin ? std::min(half - begin, size) : 0;
}

}  // namespace

extern "C" {

ssize_t pwrite(int descriptor, const void* bytes, std::size_t size, off_t at) {
  static auto* const real = next<ssize_t(int, const void*, std::size_t, off_t)>("pwrite");
  const Fate fate = next_change(descriptor);
  if (fate == Fate::fails) return -1;
  if (fate == Fate::tears) {
    if (const std::size_t part = torn(size, at); part > 0) real(descriptor, bytes, part, at);
    std::raise(SIGKILL);
  }
  return real(descriptor, bytes, size, at);
}

ssize_t pwrite64(int descriptor, const void* bytes, std::size_t size, off_t at) {
  return ::pwrite(descriptor, bytes, size, at);
}

ssize_t pwritev(int descriptor, const iovec* parts, int count, off_t at) {
  static auto* const real = next<ssize_t(int, const iovec*, int, off_t)>("pwritev");
  const Fate fate = next_change(descriptor);
  if (fate == Fate::fails) return -1;
  if (fate == Fate::tears) {
    if (count > 1) real(descriptor, parts, count / 2, at);
    std::raise(SIGKILL);
  }
  return real(descriptor, parts, count, at);
}

ssize_t pwritev64(int descriptor, const iovec* parts, int count, off_t at) {
  return ::pwritev(descriptor, parts, count, at);
}

int ftruncate(int descriptor, off_t size) noexcept {
  static auto* const real = next<int(int, off_t)>("ftruncate");
  const Fate fate = next_change(descriptor);
  if (fate == Fate::tears) std::raise(SIGKILL);
  return fate == Fate::fails ? -1 : real(descriptor, size);
}

int ftruncate64(int descriptor, off_t size) noexcept { return ::ftruncate(descriptor, size); }

}  // extern "C"
