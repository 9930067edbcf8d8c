#pragma once
/// Kinetic energy at the end of the horizon.
#include <string_view>

namespace muldi::control {

struct KineticEnergy {
  static constexpr std::string_view name = "kinetic_energy";

  template <class Sum>
  void contribute(Sum& sum) const {
    sum.add_final_kinetic_energy(1.0);
  }
};

}  // namespace muldi::control
