#include "fem/kernel/kernel_table.hpp"

namespace muldi::fem {

constinit const ElementKernels kernels_v3 = kernel_table<Lanes<4, 3>>(Isa::v3, "x86-64-v3 (AVX2)");

}  // namespace muldi::fem
