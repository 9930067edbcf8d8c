#pragma once
/// The duration of the horizon.
#include <string_view>

namespace muldi::control {

struct FinalTime {
  static constexpr std::string_view name = "final_time";

  template <class Sum>
  void contribute(Sum& sum) const {
    sum.add_duration(1.0);
  }
};

}  // namespace muldi::control
