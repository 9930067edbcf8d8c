#pragma once
/// Fixed-step integrators of x'' = a(x, x') for the comparison: textbook methods, written plainly.
#include <Eigen/LU>
#include <functional>
#include <string>
#include <vector>

#include "bench/work_precision/minimal_system.hpp"

namespace muldi::bench {

/// The motion at equally spaced times, the first after one sampling interval.
struct Samples {
  std::vector<Coordinates> x = {};
  std::vector<Coordinates> v = {};
  bool completed = true;
};

struct Grid {
  double step = 0.0;
  double sample = 0.0;  ///< a multiple of the step
  double end = 0.0;     ///< a multiple of the sampling interval

  long steps() const { return std::lround(end / step); }
  long steps_a_sample() const { return std::lround(sample / step); }
};

enum class Method { runge_kutta_4, implicit_euler, trapezoidal, generalised_alpha };

/// Name and all options, for the page.
std::string name_of(Method method);
std::string options_of(Method method);

/// Integrates from rest at the system's start.
Samples integrate(const MinimalSystem& system, Method method, const Grid& grid);

}  // namespace muldi::bench
