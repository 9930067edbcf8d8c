// The kernels for x86-64-v4 (the build gives this file its instruction set).
#define MULDI_LANES 8
#define MULDI_TABLE table_v4
#define MULDI_TABLE_NAME "x86-64-v4"
#include "math/sparse_kernel_table.hpp"
