#include "pipeline/advice.hpp"

namespace muldi::pipeline {
namespace {

Advice on_no_convergence(Task task) {
  switch (task) {
    case Task::statics:
      return {.meaning = "no equilibrium was found near the last one, or the system can move without any force",
              .remedy =
                  "more statics.steps, or continuation: arc_length; hold what can move freely by joints, springs "
                  "or muscles"};
    case Task::optimal_control:
      return {.meaning = "the optimiser lost its way: its linearisation no longer leads to a better iterate",
              .remedy =
                  "a stage {minimise: {feasibility: 1}} first, another guess (a simulation, random starts), or a "
                  "smaller step"};
    case Task::replay:
      return {.meaning =
                  "the controls were found; replaying them, Newton's iteration found no next state: held fields jump "
                  "by what the step of the replay cannot follow",
              .remedy = "half the optimal_control.replay.step; interpolation: linear; a rate in the objective"};
    case Task::dynamics:
    case Task::explicit_dynamics:
      break;
  }
  return {.meaning =
              "Newton's iteration found no next state: too much happens within one step, or the motion is not "
              "determined there",
          .remedy =
              "half the dynamics.step (for cells that keep their volume below h sqrt(density/stress), h their shortest "
              "edge); ramps for controls that jump; more solver.max_iterations; for components of your own `muldi-sim "
              "check --derivatives`"};
}

Advice on_step_too_large(Task task) {
  if (task == Task::explicit_dynamics) {
    return {.meaning = "beyond this step the explicit integrator multiplies every error, and the motion blows up",
            .remedy =
                "a dynamics.step below the stable one, coarser cells where they are smallest, or integrator: "
                "midpoint"};
  }
  return {.meaning = "the midpoint of two attitudes that far apart is no attitude: the step cannot follow the rotation",
          .remedy = "a dynamics.step in which no body turns by more than about 0.1 rad, or 0.5 at the most"};
}

}  // namespace

Advice advice_on(variational::Status status, Task task) {
  using variational::Status;
  switch (status) {
    case Status::no_convergence:
      return on_no_convergence(task);
    case Status::step_too_large:
      return on_step_too_large(task);
    case Status::loss_of_equilibrium:
      return {.meaning = "pull-in or buckling: beyond this load the system jumps to a state far away, or collapses",
              .remedy =
                  "stay below this load; statics.continuation: arc_length follows the curve past the limit onto "
                  "the unstable branch, and dynamics shows where the system goes"};
    case Status::muscle_collapse:
      return {.meaning =
                  "pull-in: the field squeezed the muscle faster than its elasticity could resist, or a load "
                  "crushed it",
              .remedy =
                  "a lower field, or a ramp instead of a jump (a sudden field pulls in at 94 % of the static "
                  "limit); more viscosity; a smaller dynamics.step if the field is moderate"};
    case Status::inverted_element:
      return {
          .meaning =
              "a cell of the mesh was pressed through itself, by a field beyond pull-in, a load, or a step "
              "that is too large",
          .remedy =
              "a smaller dynamics.step (for cells that keep their volume below h sqrt(density/stress), h their "
              "shortest edge), or a ramp instead of a jump; a lower field or load; finer or better shaped cells there"};
    case Status::rank_change:
      return {.meaning = "at a change point a closed mechanism may go on in two ways, and its joints do not say which",
              .remedy =
                  "another scene pose, links of slightly other lengths, or a joint stop that keeps the mechanism "
                  "off this pose"};
    case Status::breakdown:
      return {.meaning =
                  "a dielectric that is squeezed carries its voltage over less thickness, and the field in it has "
                  "grown beyond the strength of the material",
              .remedy =
                  "a lower field or voltage, thicker layers, a load or stop that keeps the material from being "
                  "squeezed; in optimal control the limit true_field, below the breakdown_field"};
    case Status::infeasible:
      return {.meaning = "no controls within their bounds meet all conditions, as far as can be told from this guess",
              .remedy =
                  "a longer duration, wider bounds or limits, or fewer conditions at the end (the largest "
                  "violation says which is in the way); another guess"};
    case Status::iteration_limit:
      return {.meaning = "the optimiser was stopped on its way; its best iterate is kept",
              .remedy = "more max_iterations in this stage, or go on from the result with guess: {from: FILE}"};
    case Status::running:
    case Status::completed:
    case Status::interrupted:
    case Status::write_error:
      break;
  }
  return {};
}

}  // namespace muldi::pipeline
