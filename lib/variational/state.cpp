#include "variational/state.hpp"

namespace muldi::variational {

std::string name_of(Status status) {
  switch (status) {
    case Status::running:
      return "running";
    case Status::completed:
      return "completed";
    case Status::interrupted:
      return "interrupted";
    case Status::no_convergence:
      return "no_convergence";
    case Status::loss_of_equilibrium:
      return "loss_of_equilibrium";
    case Status::muscle_collapse:
      return "muscle_collapse";
    case Status::inverted_element:
      return "inverted_element";
    case Status::breakdown:
      return "breakdown";
    case Status::step_too_large:
      return "step_too_large";
    case Status::rank_change:
      return "rank_change";
    case Status::infeasible:
      return "infeasible";
    case Status::iteration_limit:
      return "iteration_limit";
    case Status::write_error:
      return "write_error";
  }
  return "unknown";
}

}  // namespace muldi::variational
