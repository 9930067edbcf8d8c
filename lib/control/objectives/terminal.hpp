#pragma once
/// Squared distance from a wanted pose at the end.
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "control/conditions.hpp"

namespace muldi::control {

struct Terminal {
  static constexpr std::string_view name = "terminal";

  struct Coordinate {
    int rate = 0;
    CutJoint cut = {};
    double wanted = 0.0;
  };
  struct Point {
    model::LinearPoint point = {};
    std::array<std::optional<double>, 3> wanted = {};
  };
  std::vector<Coordinate> coordinates = {};
  std::vector<Point> points = {};

  template <class Sum>
  void contribute(Sum& sum) const {
    const int n = sum.n_steps();
    for (const Coordinate& c : coordinates) {
      sum.add_squared_coordinate(n, {.rate = c.rate, .cut = c.cut, .wanted = c.wanted, .factor = 1.0});
    }
    for (const Point& p : points) {
      for (int k = 0; k < 3; ++k) {
        const auto& wanted = p.wanted[static_cast<std::size_t>(k)];
        if (wanted) sum.add_squared_point(n, {.point = p.point, .component = k, .wanted = *wanted, .factor = 1.0});
      }
    }
  }
};

}  // namespace muldi::control
