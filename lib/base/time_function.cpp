#include "base/time_function.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/text.hpp"

namespace muldi::base {

double Samples::at(double t) const {
  MULDI_EXPECT(!times.empty() && times.size() == values.size(), "samples have times and as many values");
  const auto after = std::upper_bound(times.begin(), times.end(), t);
  if (after == times.begin()) return values.front();
  if (after == times.end()) return values.back();
  const auto i = static_cast<std::size_t>(after - times.begin()) - 1;
  if (between == Between::held) return values[i];
  const double share = (t - times[i]) / (times[i + 1] - times[i]);
  return (1.0 - share) * values[i] + share * values[i + 1];
}

double Ramp::at(double t) const {
  const double share = std::clamp((t - start) / over, 0.0, 1.0);
  return (1.0 - share) * from + share * to;
}

double Sine::at(double t) const {
  const double two_pi = 6.28318530717958647692;
  return offset + amplitude * std::sin(two_pi * frequency * t + phase);
}

double TimeFunction::at(double t) const {
  if (const double* constant = std::get_if<double>(&kind_)) return *constant;
  if (const auto* samples = std::get_if<Samples>(&kind_)) return samples->at(t);
  if (const auto* ramp = std::get_if<Ramp>(&kind_)) return ramp->at(t);
  if (const auto* sine = std::get_if<Sine>(&kind_)) return sine->at(t);
  return std::get<Expression>(kind_).at(t);
}

std::string why_invalid(const Samples& samples, std::size_t* first_bad) {
  const auto bad = [first_bad](std::size_t i) {
    if (first_bad != nullptr) *first_bad = i;
  };
  bad(0);
  if (samples.times.empty()) return "has no rows";
  if (samples.times.size() != samples.values.size()) return "needs as many values as times";
  for (std::size_t i = 0; i < samples.times.size(); ++i) {
    bad(i);
    if (!std::isfinite(samples.times[i]) || !std::isfinite(samples.values[i])) return "needs finite numbers";
    if (i > 0 && !(samples.times[i] > samples.times[i - 1])) {
      return "needs increasing times, got " + number_text(samples.times[i]) + " after " +
             number_text(samples.times[i - 1]);
    }
  }
  return {};
}

}  // namespace muldi::base
