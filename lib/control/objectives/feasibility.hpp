#pragma once
/// Nothing to minimise: any motion that fulfils all conditions will do.
#include <string_view>

namespace muldi::control {

struct Feasibility {
  static constexpr std::string_view name = "feasibility";

  template <class Sum>
  void contribute(Sum&) const {}
};

}  // namespace muldi::control
