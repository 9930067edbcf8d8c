#include "fem/kernel/kernel_table.hpp"

namespace muldi::fem {

constinit const ElementKernels kernels_v4 = kernel_table<Lanes<8, 4>>(Isa::v4, "x86-64-v4 (AVX-512)");

}  // namespace muldi::fem
