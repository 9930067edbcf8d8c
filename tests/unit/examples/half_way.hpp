#pragma once
/// A wanted value of a joint coordinate in the middle of the horizon.
#include <string_view>

namespace muldi::control {

/// (theta - wanted)^2 at the node N/2.
struct HalfWay {
  static constexpr std::string_view name = "half_way";

  int rate = 0;         ///< which minimal coordinate
  double wanted = 0.0;  ///< mm or rad

  template <class Sum>
  void contribute(Sum& sum) const {
    sum.add_squared_coordinate(sum.n_steps() / 2, {.rate = rate, .wanted = wanted, .factor = 1.0});
  }
};

}  // namespace muldi::control
