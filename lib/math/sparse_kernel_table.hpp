#pragma once
/// The table of the kernels for the instruction set of the including file, which defines MULDI_LANES, MULDI_TABLE (the
/// variable) and MULDI_TABLE_NAME.
#include "math/sparse_kernel_panel.hpp"
#include "math/sparse_kernel_products.hpp"
#include "math/sparse_kernel_solve.hpp"

namespace muldi::math::kernels {

extern const Table MULDI_TABLE;
// The including file is the only one that names this table.
// NOLINTNEXTLINE(misc-definitions-in-headers)
const Table MULDI_TABLE{
    MULDI_TABLE_NAME,
    {nullptr, small_block_product<double, 1>, small_block_product<double, 2>, block_product<double, 3>,
     block_product<double, 4>},
    {nullptr, small_block_product<float, 1>, small_block_product<float, 2>, block_product<float, 3>,
     block_product<float, 4>},
    factor_panel,
    schur_update,
    forward<double>,
    backward<double>,
    forward<float>,
    backward<float>,
};

}  // namespace muldi::math::kernels
