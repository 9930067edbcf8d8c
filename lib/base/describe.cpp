#include "base/describe.hpp"

#include <cmath>

#include "base/text.hpp"

namespace muldi::base {

std::string range_text(const Range& range) {
  const bool low = std::isfinite(range.min);
  const bool high = std::isfinite(range.max);
  if (low && high && range.min == range.max) return number_text(range.min);
  std::string text;
  if (low) text = (range.min_open ? "> " : ">= ") + number_text(range.min);
  if (low && high) text += " and ";
  if (high) text += (range.max_open ? "< " : "<= ") + number_text(range.max);
  return text;
}

}  // namespace muldi::base
