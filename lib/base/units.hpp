#pragma once
/// Units of measurement: text with units to numbers of the scene's own unit system and back to unit names.
///
/// The system of units is built in code on the bases m, kg, s, A and rad (the XML data base of UDUNITS-2 costs 10 ms
/// and lacks `deg`), and only when the first unit text comes. Text of units is that of UDUNITS-2: `kV/mm`, `g/(ms*mm)`,
/// `N mm`, `m^2`, `m.s-1`.
#include <optional>
#include <string>
#include <string_view>

#include "base/describe.hpp"

namespace muldi::base {

/// What a unit text means: its value in SI units and its dimension.
struct Unit {
  double si = 1.0;
  Dimension dimension = {};
};

/// The unit that `text` names; empty if it is none (unknown symbol, bad syntax, an offset or logarithmic scale).
std::optional<Unit> parse_unit(std::string_view text);

/// The four units in which a scene is written, computed and recorded; angles are radians always.
class UnitSystem {
 public:
  /// mm, g, ms, A: force N, stress MPa, energy mJ, voltage V.
  UnitSystem() = default;

  /// The system of the named units. `error` gets a sentence and the default system comes back when a name is no unit of
  /// its quantity.
  static UnitSystem make(std::string_view length, std::string_view mass, std::string_view time,
                         std::string_view current, std::string& error);

  const std::string& length() const { return names_[0]; }
  const std::string& mass() const { return names_[1]; }
  const std::string& time() const { return names_[2]; }
  const std::string& current() const { return names_[3]; }

  /// SI value of one unit of the dimension.
  double si(Dimension dimension) const;

  /// A number given in `unit` as a number of this system; exact to the last bit when the units differ by a power of
  /// ten.
  double from(double number, Unit unit) const;

  /// Permittivity of vacuum in this system: 8.8542e-12 F/m, the value of the thesis.
  double eps0() const;

  /// The name of the unit of a dimension: `N`, `mJ`, `mm/ms`, `V/mm`, `MPa ms`; "1" without dimension.
  std::string unit_name(Dimension dimension) const;

  friend bool operator==(const UnitSystem&, const UnitSystem&) = default;

 private:
  std::string names_[4] = {"mm", "g", "ms", "A"};
  double si_[4] = {1e-3, 1e-3, 1e-3, 1.0};
};

/// A number, or a sentence that says why there is none.
struct QuantityResult {
  double value = 0.0;
  std::string error = {};  ///< empty if the value holds

  explicit operator bool() const { return error.empty(); }
};

/// Reads "30 kV/mm", "1e-3" or "7.73 deg" as a finite number of `system`.
/// A bare number is in the system's unit of `dimension` (radians for angles). A unit must have the dimension; where it
/// holds an angle, the text may leave the angle out ("N mm" for "N mm/rad"), elsewhere an angle is an error.
QuantityResult parse_quantity(std::string_view text, Dimension dimension, const UnitSystem& system);

/// What the dimension is called: `force`, `electric field`; its base units where it has no name (`kg m^2/s`).
std::string dimension_name(Dimension dimension);

}  // namespace muldi::base
