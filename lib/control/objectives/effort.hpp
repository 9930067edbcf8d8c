#pragma once
/// Control effort: the sum of squared controls over the intervals 0 .. N - 1 (thesis 8.3, without its u_N).
#include <string_view>
#include <vector>

namespace muldi::control {

struct Effort {
  static constexpr std::string_view name = "effort";

  /// Of each choice in Problem::controls: sum_n sum_c factors[c] u_c,n^2. Of muscles the factor is scale Z^2, summed
  /// over the muscles that the control drives.
  std::vector<double> factors = {};

  template <class Sum>
  void contribute(Sum& sum) const {
    for (std::size_t c = 0; c < factors.size(); ++c) sum.add_squared_control(static_cast<int>(c), factors[c]);
  }
};

}  // namespace muldi::control
