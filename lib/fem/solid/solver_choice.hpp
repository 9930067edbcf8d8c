#pragma once
/// Which linear solver a solid gets, by a user's word and by its size.
#include <memory>
#include <optional>
#include <string>

#include "fem/solid/solid_iteration.hpp"
#include "fem/solid/solid_package.hpp"
#include "math/sparse_ldlt.hpp"
#include "model/substructure.hpp"

namespace muldi::fem {

/// Sizes that decide where the user has no wish.
inline constexpr int direct_in_dynamics = 60000;  ///< unknowns up to which a factor is kept
inline constexpr int direct_at_rest = 150000;

/// Sizes between which a solver of steps is chosen by how stiff they are.
inline constexpr int choice_from = 15000;
inline constexpr int choice_to = direct_at_rest;

/// What is to be solved.
struct SolverTask {
  model::Linearisation kind = model::Linearisation::step;
  int n_unknowns = 0;  ///< free ones
  int n_negative = 0;  ///< pivots that the potentials must have
  bool tied = false;   ///< to bodies: such solids are small, and their answers to the bodies take a factor
};

/// The library that a name forces, if it does.
std::optional<Package> package_of(const std::string& name);
/// True if the matrix is to be factorised, as those of tied solids always are. `name`: auto | direct | iterative | ldlt
/// | cholmod | umfpack | cg | minres | gmres; ContractError for another one.
bool is_direct(const SolverTask& task, const std::string& name);
/// True if the first matrix is to decide: make_linear gives the iteration, to be replaced where is_stiff.
bool is_open(const SolverTask& task, const std::string& name);
/// The stiffness of a step up to which an iteration takes less time than a kept factor: the diagonal of the matrix over
/// that of the mass, which is 1 + 3/4 (c dt/h)^2 for waves of speed c in cells h, and more with viscosity. Measured on
/// the cube of 16^3 cells: an iteration takes 0.54 of the time of a factor at 5 (with viscosity; 0.7 at 1.5 without),
/// 0.9 at 13, 1.1 at 50, 2.5 at 5000. A solve with the factor of a cube grows as n^(4/3), the iterations as n and the
/// root of the stiffness: the limit grows as n^(2/3).
double stiffest_step(int n_unknowns);
/// Mean of the diagonal of the free positions over that of the mass matrix of a step.
double stiffness_of_step(const math::SymmetricBlockMatrix& matrix, const math::NodeMask& mask, double mean_mass);
/// Muscles are many and small: their factors are read from memory in every iteration, and these have exact residuals.
math::FactorStorage storage_for(const SolverTask& task);
/// The iteration for a task that is not; InputError for `cg` where the matrix is indefinite.
SolidIteration::Options iteration_for(const SolverTask& task, const std::string& name);

/// Both, made.
std::unique_ptr<SolidLinear> make_linear(const SolverTask& task, const std::string& name,
                                         const math::SymmetricBlockPattern& pattern, const math::NodeMask& mask,
                                         std::vector<std::vector<int>> electrodes);

}  // namespace muldi::fem
