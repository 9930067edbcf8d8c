// The kernels for x86-64-v3 (the build gives this file its instruction set).
#define MULDI_LANES 4
#define MULDI_TABLE table_v3
#define MULDI_TABLE_NAME "x86-64-v3"
#include "math/sparse_kernel_table.hpp"
