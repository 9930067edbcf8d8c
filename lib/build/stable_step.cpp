#include "build/stable_step.hpp"

#include "fem/solid/step_bound.hpp"

namespace muldi::build {

StableStep exceeded_step(const BuiltModel& built, const Eigen::VectorXd& q, const Eigen::VectorXd& y, double dt) {
  StableStep least;
  for (const fem::Solid* solid : built.solids) {
    const fem::StepBound bound = fem::exceeded_bound(*solid, q, y, dt);
    if (bound.cell < 0 || (!least.name.empty() && bound.step >= least.step)) continue;
    least = {.name = "solid '" + solid->data().name + "' (" + solid->place_of_cell(bound.cell),
             .step = bound.step,
             .length = bound.length,
             .stress = bound.stress};
  }
  return least;
}

}  // namespace muldi::build
