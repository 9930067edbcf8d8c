#pragma once
/// Squared distance from wanted motions, integrated over time by the trapezoidal rule.
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "base/time_function.hpp"
#include "control/conditions.hpp"

namespace muldi::control {

struct Tracking {
  static constexpr std::string_view name = "tracking";

  struct Coordinate {
    int rate = 0;
    CutJoint cut = {};
    base::TimeFunction wanted = {};
  };
  struct Point {
    model::LinearPoint point = {};
    std::array<std::optional<base::TimeFunction>, 3> wanted = {};
  };
  std::vector<Coordinate> coordinates = {};
  std::vector<Point> points = {};

  template <class Sum>
  void contribute(Sum& sum) const {
    for (int n = 1; n <= sum.n_steps(); ++n) {
      const double weight = (n == sum.n_steps() ? 0.5 : 1.0) * sum.step();
      for (const Coordinate& c : coordinates) {
        sum.add_squared_coordinate(
            n, {.rate = c.rate, .cut = c.cut, .wanted = c.wanted.at(n * sum.step()), .factor = weight});
      }
      for (const Point& p : points) {
        for (int k = 0; k < 3; ++k) {
          const auto& wanted = p.wanted[static_cast<std::size_t>(k)];
          if (!wanted) continue;
          sum.add_squared_point(
              n, {.point = p.point, .component = k, .wanted = wanted->at(n * sum.step()), .factor = weight});
        }
      }
    }
  }
};

}  // namespace muldi::control
