#include "variational/control_rates.hpp"

#include <algorithm>

namespace muldi::variational {
namespace {

/// Part of a step that a difference reaches over: its error is h^2/3 of the third derivative, that of rounding the
/// spacing of numbers over h.
constexpr double reach = 1e-4;

}  // namespace

ControlRates::ControlRates(const model::Model& model, double dt)
    : model_(model), dt_(dt), here_(model.controls.size()), values_(here_), rates_(here_) {}

std::span<const double> ControlRates::at(double t, Side side) {
  std::ranges::fill(rates_, 0.0);
  const double share = side == Side::both ? 0.5 : 1.0;
  if (side != Side::after) add(t, -reach * dt_, share);
  if (side != Side::before) add(t, reach * dt_, share);
  return rates_;
}

void ControlRates::add(double t, double h, double share) {
  // (4 (u(t + h) - u(t)) - (u(t + 2 h) - u(t)))/2h, all beyond a jump at t; zero where the control stands.
  const double first = t + (h > 0.0 ? before_end : -before_end) * dt_;
  model_.evaluate_controls(first, here_);
  for (const double k : {1.0, 2.0}) {
    model_.evaluate_controls(first + k * h, values_);
    const double weight = share * (k == 1.0 ? 2.0 : -0.5) / h;
    for (std::size_t c = 0; c < rates_.size(); ++c) rates_[c] += weight * (values_[c] - here_[c]);
  }
}

}  // namespace muldi::variational
