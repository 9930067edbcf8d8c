#include "variational/factor_use.hpp"

namespace muldi::variational {
namespace {

/// Cost of the factors, the assembly of their matrices included, in iterations. For muscles of 60 to 500 cells 5 to 10
/// were measured; the mean cost of a step hardly depends on it (it is flat at its minimum).
constexpr int cost_of_factor = 6;

}  // namespace

void FactorUse::book(int iterations_of_step, bool renewed) {
  if (renewed) *this = {};
  ++steps;
  iterations += iterations_of_step;
  renews = iterations_of_step * steps > cost_of_factor + iterations;
}

}  // namespace muldi::variational
