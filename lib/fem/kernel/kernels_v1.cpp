#include "fem/kernel/kernel_table.hpp"

namespace muldi::fem {

constinit const ElementKernels kernels_v1 = kernel_table<Lanes<2, 1>>(Isa::v1, "x86-64 (SSE2)");

}  // namespace muldi::fem
