#include "fem/solid/solver_choice.hpp"

#include "base/error.hpp"
#include "fem/solid/solid_factor.hpp"

namespace muldi::fem {
namespace {

/// Of linear solves within a step, whose residuals are exact, and of those whose result is final.
constexpr double accuracy_in_steps = 1e-3;
constexpr double final_accuracy = 1e-13;

}  // namespace

bool is_direct(const SolverTask& task, const std::string& name) {
  if (task.tied || name == "direct" || name == "ldlt") return true;
  if (name == "iterative" || name == "cg" || name == "minres" || name == "gmres") return false;
  MULDI_EXPECT(name == "auto", "a known solver");
  const bool rest = task.kind == model::Linearisation::rest;
  return task.n_unknowns <= (rest ? direct_at_rest : direct_in_dynamics);
}

math::FactorStorage storage_for(const SolverTask& task) {
  return task.tied && task.kind == model::Linearisation::step ? math::FactorStorage::single_precision
                                                              : math::FactorStorage::double_precision;
}

SolidIteration::Options iteration_for(const SolverTask& task, const std::string& name) {
  const bool step = task.kind == model::Linearisation::step;
  SolidIteration::Options options{.accuracy = step ? accuracy_in_steps : final_accuracy,
                                  .degree = step                                          ? 3
                                            : task.kind == model::Linearisation::velocity ? 1
                                                                                          : 6,
                                  .expected_negative = task.n_negative};
  // The block-diagonal preconditioner with the sign of the potentials needs half the iterations of MINRES.
  options.method = task.n_negative > 0 ? KrylovMethod::gmres : KrylovMethod::cg;
  if (name == "minres") options.method = KrylovMethod::minres;
  if (name == "gmres") options.method = KrylovMethod::gmres;
  if (name == "cg" && task.n_negative > 0) {
    base::Diagnostic wrong;
    wrong.message =
        "solver.linear: cg needs a definite matrix, and unknown potentials of a dielectric make it indefinite: take "
        "gmres, minres or auto";
    throw base::InputError({wrong});
  }
  return options;
}

std::unique_ptr<SolidLinear> make_linear(const SolverTask& task, const std::string& name,
                                         const math::SymmetricBlockPattern& pattern, const math::NodeMask& mask,
                                         std::vector<std::vector<int>> electrodes) {
  if (is_direct(task, name)) {
    return std::make_unique<SolidFactor>(pattern, mask, std::move(electrodes), storage_for(task));
  }
  return std::make_unique<SolidIteration>(pattern, mask, std::move(electrodes), iteration_for(task, name));
}

}  // namespace muldi::fem
