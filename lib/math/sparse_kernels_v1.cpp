// The kernels for x86-64-v1 and for every other processor (the build gives this file its instruction set).
#define MULDI_LANES 2
#define MULDI_TABLE table_v1
#define MULDI_TABLE_NAME "baseline"
#include "math/sparse_kernel_table.hpp"
