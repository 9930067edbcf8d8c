#pragma once
/// Which linear solver a solid gets, by a user's word and by its size.
#include <memory>
#include <string>

#include "fem/solid/solid_iteration.hpp"
#include "math/sparse_ldlt.hpp"
#include "model/substructure.hpp"

namespace muldi::fem {

/// Sizes that decide where the user has no wish.
inline constexpr int direct_in_dynamics = 60000;  ///< unknowns up to which a factor is kept
inline constexpr int direct_at_rest = 150000;

/// What is to be solved.
struct SolverTask {
  model::Linearisation kind = model::Linearisation::step;
  int n_unknowns = 0;  ///< free ones
  int n_negative = 0;  ///< pivots that the potentials must have
  bool tied = false;   ///< to bodies: such solids are small, and their answers to the bodies take a factor
};

/// True if the matrix is to be factorised, as those of tied solids always are. `name`: auto | direct | iterative | ldlt
/// | cg | minres | gmres; ContractError for another one.
bool is_direct(const SolverTask& task, const std::string& name);
/// Muscles are many and small: their factors are read from memory in every iteration, and these have exact residuals.
math::FactorStorage storage_for(const SolverTask& task);
/// The iteration for a task that is not; InputError for `cg` where the matrix is indefinite.
SolidIteration::Options iteration_for(const SolverTask& task, const std::string& name);

/// Both, made.
std::unique_ptr<SolidLinear> make_linear(const SolverTask& task, const std::string& name,
                                         const math::SymmetricBlockPattern& pattern, const math::NodeMask& mask,
                                         std::vector<std::vector<int>> electrodes);

}  // namespace muldi::fem
