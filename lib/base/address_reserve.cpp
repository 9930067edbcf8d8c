#include "base/address_reserve.hpp"

#include <sys/mman.h>
#include <sys/resource.h>

#include <new>

namespace muldi::base {

AddressReserve::AddressReserve(std::size_t bytes) : bytes_(bytes) {
  rlimit limit{};
  limited_ = ::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

void AddressReserve::take() {
  try_take();
  if (limited_ && held_ == nullptr) throw std::bad_alloc();
}

void AddressReserve::try_take() noexcept {
  if (!limited_ || held_ != nullptr) return;
  void* const got = ::mmap(nullptr, bytes_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (got != MAP_FAILED) held_ = got;
}

void AddressReserve::release() noexcept {
  if (held_ != nullptr) ::munmap(held_, bytes_);
  held_ = nullptr;
}

}  // namespace muldi::base
