// Names of dimensions and of their units for messages and results.
#include <cmath>
#include <string>

#include "base/text.hpp"
#include "base/units.hpp"

namespace muldi::base {
namespace {

struct NamedDimension {
  Dimension dimension;
  const char* name;
};
constexpr NamedDimension dimension_names[] = {
    {dimension::none, "a number without unit"},
    {dimension::length, "length"},
    {dimension::mass, "mass"},
    {dimension::time, "time"},
    {dimension::current, "current"},
    {dimension::angle, "angle"},
    {dimension::area, "area"},
    {dimension::volume, "volume"},
    {dimension::density, "density"},
    {dimension::velocity, "velocity"},
    {dimension::acceleration, "acceleration"},
    {dimension::angular_velocity, "angular velocity"},
    {dimension::inertia, "moment of inertia"},
    {dimension::momentum, "momentum"},
    {dimension::momentum * dimension::length, "angular momentum"},
    {dimension::force, "force"},
    {dimension::energy, "torque or energy"},
    {dimension::power, "power"},
    {dimension::stress, "stress"},
    {dimension::viscosity, "viscosity"},
    {dimension::stiffness, "stiffness"},
    {dimension::damping, "damping"},
    {dimension::rotational_stiffness, "rotational stiffness"},
    {dimension::rotational_damping, "rotational damping"},
    {dimension::charge, "charge"},
    {dimension::voltage, "voltage"},
    {dimension::field, "electric field"},
    {dimension::permittivity, "permittivity"},
    {dimension::frequency, "frequency"},
};

/// Units with a name of their own that results use: alone, or times a rest of base units.
struct NamedUnit {
  Dimension dimension;
  const char* symbol;
};
constexpr NamedUnit named_units[] = {
    {dimension::force, "N"},
    {dimension::energy, "J"},
    {dimension::stress, "Pa"},
    {dimension::power, "W"},
    {dimension::voltage, "V"},
    {dimension::charge, "C"},
    {dimension::charge / dimension::voltage, "F"},
    {dimension::voltage / dimension::current, "Ohm"},
};
constexpr NamedUnit leading_units[] = {
    {dimension::stiffness, "N"},          {dimension::damping, "N"},      {dimension::field, "V"},
    {dimension::viscosity, "Pa"},         {dimension::permittivity, "F"}, {dimension::rotational_stiffness, "N"},
    {dimension::rotational_damping, "N"},
};

void append_power(std::string& text, std::string_view unit, int exponent) {
  if (exponent == 0) return;
  if (!text.empty() && text.back() != '/' && text.back() != '(') text += ' ';
  text += unit;
  if (exponent != 1) text += "^" + std::to_string(exponent);
}

/// `lead g mm^2/ms`; "1" for nothing.
std::string product(std::string lead, Dimension rest, const std::string (&names)[5]) {
  const int exponents[5] = {rest.mass, rest.length, rest.time, rest.current, rest.angle};
  std::string above = std::move(lead);
  std::string below;
  int n_below = 0;
  for (int i = 0; i < 5; ++i) {
    if (exponents[i] > 0) append_power(above, names[i], exponents[i]);
    if (exponents[i] < 0) {
      append_power(below, names[i], -exponents[i]);
      ++n_below;
    }
  }
  if (above.empty()) above = "1";
  if (n_below == 0) return above;
  return above + "/" + (n_below > 1 ? "(" + below + ")" : below);
}

/// The symbol with the prefix that makes it `si` SI units, e.g. mJ; empty if no prefix does.
std::string prefixed(const char* symbol, double si) {
  constexpr const char* prefixes[] = {"p", "n", "u", "m", "", "k", "M", "G", "T"};
  const double thousands = std::log10(si) / 3.0;
  const double index = std::round(thousands) + 4.0;
  if (std::abs(thousands - std::round(thousands)) > 1e-9 || index < 0.0 || index > 8.0) return {};
  return std::string(prefixes[static_cast<int>(index)]) + symbol;
}

}  // namespace

std::string dimension_name(Dimension dimension) {
  for (const NamedDimension& named : dimension_names) {
    if (named.dimension == dimension) return named.name;
  }
  return product({}, dimension, {"kg", "m", "s", "A", "rad"});
}

std::string UnitSystem::unit_name(Dimension dimension) const {
  for (const NamedUnit& unit : named_units) {
    if (unit.dimension != dimension) continue;
    const std::string name = prefixed(unit.symbol, si(dimension));
    if (!name.empty()) return name;
  }
  for (const NamedUnit& leading : leading_units) {
    if (leading.dimension != dimension) continue;
    for (const NamedUnit& unit : named_units) {
      if (std::string_view(unit.symbol) != leading.symbol) continue;
      const std::string name = prefixed(unit.symbol, si(unit.dimension));
      if (!name.empty()) return product(name, dimension / unit.dimension, {mass(), length(), time(), current(), "rad"});
    }
  }
  return product({}, dimension, {mass(), length(), time(), current(), "rad"});
}

}  // namespace muldi::base
