#include "math/sparse_kernels.hpp"

#include <atomic>

namespace muldi::math::kernels {

extern const Table table_v1;
#ifdef MULDI_KERNEL_LEVELS
extern const Table table_v3;
extern const Table table_v4;
#endif

namespace {

const Table* best(int level) {
  for (; level > 1; --level) {
    if (const Table* found = table_of_level(level)) return found;
  }
  return &table_v1;
}

std::atomic<const Table*>& current() {
  static std::atomic<const Table*> chosen{best(4)};
  return chosen;
}

}  // namespace

const Table* table_of_level(int level) {
  if (level == 1) return &table_v1;
#ifdef MULDI_KERNEL_LEVELS
  const bool v3 = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
  const bool v4 = v3 && __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
                  __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
                  __builtin_cpu_supports("avx512cd") != 0;
  if (level == 3 && v3) return &table_v3;
  if (level == 4 && v4) return &table_v4;
#endif
  return nullptr;
}

const Table& table() { return *current().load(std::memory_order_relaxed); }

void limit_level(int level) { current() = best(level); }

}  // namespace muldi::math::kernels
