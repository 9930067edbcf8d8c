#pragma once
/// Conductors with the sources that feed them: what the supply of electric energy is booked by.
///
/// A source that holds the potential U of a conductor while its charge Q changes supplies dW = U dQ; so does one that
/// puts a charge on a conductor. At fixed positions the charges are linear in the potentials (every electric law here
/// is quadratic in the field), so that along a change of the controls at fixed positions, and over an interval of fixed
/// potentials, with no error of quadrature,
///
///     W = [U Q] - int Q dU,     int Q dU = 1/2 (Q_0 + Q_1) (U_1 - U_0) .
#include <functional>
#include <vector>

#include "model/observable.hpp"

namespace muldi::model {

/// Potential and charge of a conductor.
struct TerminalValues {
  double potential = 0.0;
  double charge = 0.0;

  /// 1/2 U Q; summed over all conductors, the energy of the field.
  double stored() const { return 0.5 * potential * charge; }
};

struct Terminal {
  bool gives_charge = false;  ///< the source gives the charge; else the potential
  std::function<TerminalValues(const NodeView&)> values;

  /// Energy supplied since the accounts were opened; `account` is this terminal's at the node.
  double supplied(double account, const TerminalValues& at) const {
    return gives_charge ? account : account + at.potential * at.charge;
  }
};

/// What a scene wants to know of its sources and conductors beside potentials and charges; nothing else is computed.
struct ElectricRecord {
  bool capacitance = false;
  bool stored_energy = false;
  bool supplied_energy = false;

  bool any() const { return capacitance || stored_energy || supplied_energy; }
};

}  // namespace muldi::model
