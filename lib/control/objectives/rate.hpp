#pragma once
/// Smooth controls: the squared changes of the optimiser's quantity (u/reference, or (u/reference)^2) between
/// intervals.
#include <string_view>
#include <vector>

namespace muldi::control {

struct Rate {
  static constexpr std::string_view name = "rate";

  template <class Sum>
  void contribute(Sum& sum) const {
    for (int c = 0; c < sum.n_controls(); ++c) sum.add_squared_change(c, 1.0);
  }
};

}  // namespace muldi::control
