#pragma once
/// Instantiates the kernels for one kind of lanes; included by the file of each instruction set only.
#include "fem/kernel/element_kernels.hpp"
#include "fem/kernel/forces.hpp"
#include "fem/kernel/integrals.hpp"
#include "fem/kernel/scatter.hpp"
#include "fem/kernel/viscous_by_position.hpp"

namespace muldi::fem {

template <class L>
constexpr ElementKernels kernel_table(Isa isa, const char* name) {
  return {.isa = isa,
          .name = name,
          .lanes = L::size,
          .forces = &forces<L>,
          .action = &action<L>,
          .tangent = &tangent<L>,
          .dense = &dense<L>,
          .viscous_by_position = &viscous_by_position<L>,
          .volumes = &volumes<L>,
          .energies = &energies<L>,
          .point_values = &point_values<L>,
          .mass = &mass<L>,
          .loads = &loads<L>};
}

extern const ElementKernels kernels_v1;
extern const ElementKernels kernels_v3;
extern const ElementKernels kernels_v4;

}  // namespace muldi::fem
