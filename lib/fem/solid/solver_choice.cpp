#include "fem/solid/solver_choice.hpp"

#include <cmath>

#include "base/error.hpp"
#include "fem/solid/solid_factor.hpp"

namespace muldi::fem {
namespace {

/// Of linear solves within a step, whose residuals are exact, and of those whose result is final.
constexpr double accuracy_in_steps = 1e-3;
constexpr double final_accuracy = 1e-13;

/// Mass or viscosity leave a step's matrix a narrow spectrum, the more so the coarser the mesh.
math::BlockChebyshev::Degrees degrees_for(model::Linearisation kind) {
  switch (kind) {
    case model::Linearisation::step:
      return {.least = 3, .largest = 8};
    case model::Linearisation::velocity:
      return {.least = 1, .largest = 1};
    case model::Linearisation::rest:
      return {.least = 6, .largest = 6};
  }
  return {};
}

}  // namespace

std::optional<Package> package_of(const std::string& name) {
  if (name == "cholmod") return Package::cholmod;
  if (name == "umfpack") return Package::umfpack;
  return std::nullopt;
}

bool is_direct(const SolverTask& task, const std::string& name) {
  if (package_of(name) || task.tied || name == "direct" || name == "ldlt") return true;
  if (name == "iterative" || name == "cg" || name == "minres" || name == "gmres") return false;
  MULDI_EXPECT(name == "auto", "a known solver");
  const bool rest = task.kind == model::Linearisation::rest;
  return task.n_unknowns <= (rest ? direct_at_rest : direct_in_dynamics);
}

bool is_open(const SolverTask& task, const std::string& name) {
  return name == "auto" && !task.tied && task.kind == model::Linearisation::step && task.n_unknowns > choice_from &&
         task.n_unknowns <= choice_to;
}

double stiffest_step(int n_unknowns) {
  constexpr double measured = 30.0;
  constexpr double measured_at = 18e3;  // unknowns
  return measured * std::pow(n_unknowns / measured_at, 2.0 / 3.0);
}

double stiffness_of_step(const math::SymmetricBlockMatrix& matrix, const math::NodeMask& mask, double mean_mass) {
  const int block = matrix.block_size();
  const auto row_start = matrix.pattern().row_start();
  double sum = 0.0;
  long n = 0;
  for (std::size_t node = 0; node < mask.size(); ++node) {
    const double* values = matrix.values().data() + static_cast<std::ptrdiff_t>(block) * block * row_start[node];
    for (int i = 0; i < 3; ++i) {
      if ((mask[node] >> i & 1) != 0) continue;
      sum += values[(block + 1) * i];
      ++n;
    }
  }
  return n > 0 ? sum / (static_cast<double>(n) * mean_mass) : 0.0;
}

math::FactorStorage storage_for(const SolverTask& task) {
  return task.tied && task.kind == model::Linearisation::step ? math::FactorStorage::single_precision
                                                              : math::FactorStorage::double_precision;
}

SolidIteration::Options iteration_for(const SolverTask& task, const std::string& name) {
  const bool step = task.kind == model::Linearisation::step;
  SolidIteration::Options options{.accuracy = step ? accuracy_in_steps : final_accuracy,
                                  .degrees = degrees_for(task.kind),
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
  // The common potentials of floating electrodes are in the border, which counts its own.
  const int n_negative = task.n_negative > 0 ? task.n_negative - static_cast<int>(electrodes.size()) : 0;
  if (const std::optional<Package> package = package_of(name)) {
    return std::make_unique<SolidPackage>(pattern, mask, std::move(electrodes), *package, n_negative);
  }
  if (is_direct(task, name)) {
    return std::make_unique<SolidFactor>(pattern, mask, std::move(electrodes), storage_for(task), n_negative);
  }
  SolidIteration::Options options = iteration_for(task, name);
  options.expected_negative = n_negative;
  return std::make_unique<SolidIteration>(pattern, mask, std::move(electrodes), options);
}

}  // namespace muldi::fem
