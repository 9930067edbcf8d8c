#pragma once
/// How fast controls change at a node in time: what they prescribe moves with the scheme's own sides of a jump.
#include <span>
#include <vector>

#include "model/model.hpp"

namespace muldi::variational {

/// Part of a step by which positions are prescribed before its end: where a held control jumps, its old value counts.
inline constexpr double before_end = 1e-9;

/// Sides of a node that rates are taken from.
enum class Side { before, after, both };

class ControlRates {
 public:
  /// `dt`: the step of the run; the model must outlive the object.
  ControlRates(const model::Model& model, double dt);

  /// Derivatives of the controls by time at t (n_controls), from one side or the mean of both, which is what a kink at
  /// a node does to the momentum there. By differences of second order over a small part of a step: functions of time
  /// are exact to about 1e-10 of their change over a step. A jump at t has no rate, its two sides have theirs.
  std::span<const double> at(double t, Side side);

 private:
  void add(double t, double h, double share);

  const model::Model& model_;
  double dt_;
  std::vector<double> here_;
  std::vector<double> values_;
  std::vector<double> rates_;
};

}  // namespace muldi::variational
