#include "base/memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <limits>

#include "base/error.hpp"
#include "base/text.hpp"

namespace muldi::base {

double machine_memory() {
  const long pages = ::sysconf(_SC_PHYS_PAGES);
  const long page = ::sysconf(_SC_PAGESIZE);
  if (pages <= 0 || page <= 0) return std::numeric_limits<double>::infinity();
  const double all = static_cast<double>(pages) * static_cast<double>(page);
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return all;
  return std::min(all, static_cast<double>(limit.rlim_cur));
}

void require_memory(double bytes, const std::string& what, const std::string& mend) {
  constexpr double gibi = 1024.0 * 1024.0 * 1024.0;
  const double there = machine_memory();
  if (bytes <= there) return;
  throw InputError(format("{} takes {:.3g} GiB, more than the {:.3g} GiB of this machine: {}", what, bytes / gibi,
                          there / gibi, mend));
}

}  // namespace muldi::base
