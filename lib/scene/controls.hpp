#pragma once
/// Controls: named functions of time of one quantity.
#include <span>

#include "base/describe.hpp"
#include "base/time_function.hpp"
#include "scene/entries.hpp"

namespace muldi::scene {

/// What a control prescribes. `field` is the nominal (reference) electric field; `layer_voltage` and `total_voltage`
/// become a field through the muscle's layer thickness and rest length.
enum class ControlQuantity {
  field,
  layer_voltage,
  total_voltage,
  force,
  torque,
  potential,
  charge,
  displacement,
  pressure
};

inline std::span<const base::Word<ControlQuantity>> words(ControlQuantity) {
  using enum ControlQuantity;
  static constexpr base::Word<ControlQuantity> all[] = {
      {.word = "field", .value = field, .doc = "nominal electric field of muscles"},
      {.word = "layer_voltage", .value = layer_voltage, .doc = "voltage over one layer of muscles"},
      {.word = "total_voltage", .value = total_voltage, .doc = "voltage over the rest length of muscles"},
      {.word = "force", .value = force, .doc = "force of loads and along joints"},
      {.word = "torque", .value = torque, .doc = "torque of loads and about joints"},
      {.word = "potential", .value = potential, .doc = "electric potential on solids"},
      {.word = "charge", .value = charge, .doc = "charge of electrodes of solids"},
      {.word = "displacement", .value = displacement, .doc = "prescribed displacement of solids"},
      {.word = "pressure", .value = pressure, .doc = "pressure and components of traction on solids"},
  };
  return all;
}

/// The dimension of the values of a control.
constexpr base::Dimension dimension_of(ControlQuantity quantity) {
  using enum ControlQuantity;
  switch (quantity) {
    case field:
      return base::dimension::field;
    case layer_voltage:
    case total_voltage:
    case potential:
      return base::dimension::voltage;
    case force:
      return base::dimension::force;
    case torque:
      return base::dimension::torque;
    case charge:
      return base::dimension::charge;
    case pressure:
      return base::dimension::stress;
    case displacement:
      break;
  }
  return base::dimension::length;
}

/// `{<quantity>: <function of time>}`.
struct Control {
  ControlQuantity quantity = ControlQuantity::field;
  base::TimeFunction value = {};

  friend bool operator==(const Control&, const Control&) = default;
};

/// A value that is a function of its own or that of a control: `{control: name}`.
struct Drive {
  ControlName control = {};  ///< empty name: `value` holds
  base::TimeFunction value = {};

  friend bool operator==(const Drive&, const Drive&) = default;
};

}  // namespace muldi::scene
