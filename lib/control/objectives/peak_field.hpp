#pragma once
/// The largest of the optimiser's quantities: of fields the square (E/reference)^2, over all intervals.
///
/// A new unknown, not below any of them, is minimised.
#include <string_view>
#include <vector>

namespace muldi::control {

struct PeakField {
  static constexpr std::string_view name = "peak_field";

  /// Of each choice in Problem::controls: minimise max_n,c factors[c] u_c,n^2; controls with factor 0 do not count.
  /// Only for controls that are squared.
  std::vector<double> factors = {};

  template <class Sum>
  void contribute(Sum& sum) const {
    sum.add_peak(factors);
  }
};

}  // namespace muldi::control
