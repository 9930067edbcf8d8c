#include "variational/contraction.hpp"

namespace muldi::variational {
namespace {

/// Relative residual below which increments may stop falling: round-off of badly conditioned systems.
constexpr double round_off_residual = 1e-12;
/// The same of pressures, by increments of positions that are round-off and by those of the pressures themselves (over
/// the shear modulus): the viscous stress by which a step resists the last bit of a position is eta/dt times as large.
constexpr double round_off_positions = 1e-13;
constexpr double round_off_pressures = 1e-8;
/// Increments that must have been taken before they may have stopped falling.
constexpr int before_stagnation = 3;
/// A kept factor is made anew where an iteration reduces the increment by less than this.
constexpr double slow_rate = 0.4;
/// Rate up to which a geometric series is believed; its rest is then no longer than its last term.
constexpr double believed_rate = 0.5;

}  // namespace

void Contraction::take(const Increment& increment, bool renewed, double residual) {
  previous_ = last_;
  last_ = increment;
  residual_ = residual;
  ++n_increments_;
  since_change_ = renewed ? 1 : since_change_ + 1;
  is_new_ |= renewed;
}

bool Contraction::is_small(double tolerance) const {
  if (n_increments_ == 0 || !(last_.length <= tolerance)) return false;
  const bool falls = n_increments_ > 1 && last_.stage < believed_rate * previous_.stage;
  const double rate = falls ? last_.stage / previous_.stage : believed_rate;
  return last_.stage * rate / (1.0 - rate) <= tolerance;
}

bool Contraction::stagnates() const {
  const bool in_last_bits = last_.length <= round_off_positions && last_.size <= round_off_pressures;
  return n_increments_ > before_stagnation && last_.size > believed_rate * previous_.size &&
         (residual_ < round_off_residual || in_last_bits);
}

bool Contraction::is_slow(double tolerance) const {
  return since_change_ > 1 && last_.size > slow_rate * previous_.size && !is_small(tolerance);
}

}  // namespace muldi::variational
