#include "fem/kernel/element_kernels.hpp"

#include "base/error.hpp"
#include "fem/kernel/kernel_table.hpp"

namespace muldi::fem {

bool runs(Isa isa) {
  switch (isa) {
    case Isa::v1:
      return true;
    case Isa::v3:
      return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0 &&
             __builtin_cpu_supports("bmi2") != 0;
    case Isa::v4:
      return runs(Isa::v3) && __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
             __builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
             __builtin_cpu_supports("avx512cd") != 0;
  }
  return false;
}

Isa best_isa() {
  if (runs(Isa::v4)) return Isa::v4;
  return runs(Isa::v3) ? Isa::v3 : Isa::v1;
}

const ElementKernels& element_kernels(Isa isa) {
  MULDI_EXPECT(runs(isa), "an instruction set of this processor");
  switch (isa) {
    case Isa::v1:
      return kernels_v1;
    case Isa::v3:
      return kernels_v3;
    case Isa::v4:
      return kernels_v4;
  }
  return kernels_v1;
}

PointValues mean_of(std::span<const PointValues, 8> points) {
  PointValues mean{};
  for (const PointValues& point : points) mean.volume += point.volume;
  for (const PointValues& point : points) {
    const double share = point.volume / mean.volume;
    mean.J += share * point.J;
    for (int i = 0; i < 3; ++i) {
      mean.X[i] += share * point.X[i];
      mean.field[i] += share * point.field[i];
      mean.D[i] += share * point.D[i];
    }
    for (int n = 0; n < 6; ++n) mean.cauchy[n] += share * point.cauchy[n];
    for (int n = 0; n < 9; ++n) {
      mean.F[n] += share * point.F[n];
      mean.P[n] += share * point.P[n];
    }
  }
  return mean;
}

}  // namespace muldi::fem
