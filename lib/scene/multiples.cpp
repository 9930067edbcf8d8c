#include "scene/multiples.hpp"

#include <cmath>

#include "base/text.hpp"

namespace muldi::scene {

std::string why_no_multiple(double time, double step, const std::string& what, const std::string& unit) {
  const double steps = time / step;
  // Both numbers are rounded once where they are written, so their quotient is off by a few units in the last place.
  if (std::abs(steps - std::round(steps)) <= 1e-9 * steps && steps > 0.5) return {};
  const auto shown = [&](double value) { return base::number_text(value, 12) + " " + unit; };
  const double below = std::floor(steps) * step;
  const double above = std::ceil(steps) * step;
  return "is no multiple of " + what + " " + shown(step) + ": take " + (below > 0.0 ? shown(below) + " or " : "") +
         shown(above) + ", got " + shown(time);
}

}  // namespace muldi::scene
