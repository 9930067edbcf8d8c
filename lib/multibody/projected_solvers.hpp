#pragma once
/// Linear solvers of the projected Newton systems (model::ProjectedSolver).
///
///   tree      block elimination from the leaves to the roots, O(bodies); couplings between bodies and their parents
///   only dense     joint-space matrix with loop rows, LU with pivoting bordered  the tree solver with a dense border
///   for loop rows and couplings beyond neighbours
#include <memory>
#include <string>

#include "model/manifold.hpp"

namespace muldi::multibody {

struct KinematicTree;
class TreeManifold;

/// `kind` auto picks tree where the couplings allow it, dense up to a few dozen unknowns, else bordered.
/// InputError if `kind` cannot solve this system.
std::unique_ptr<model::ProjectedSolver> make_projected_solver(const TreeManifold& manifold,
                                                              const math::BlockPattern& pattern,
                                                              const std::string& kind);

/// True if the bodies are the same, or parent and child in the tree.
bool are_neighbours(const KinematicTree& tree, int body_i, int body_j);

/// True if every coupling of the pattern joins a body with its parent and no loop rows exist.
bool is_tree_local(const TreeManifold& manifold, const math::BlockPattern& pattern);

std::unique_ptr<model::ProjectedSolver> make_tree_solver(const TreeManifold& manifold,
                                                         const math::BlockPattern& pattern);
std::unique_ptr<model::ProjectedSolver> make_dense_solver(const TreeManifold& manifold);
std::unique_ptr<model::ProjectedSolver> make_bordered_solver(const TreeManifold& manifold,
                                                             const math::BlockPattern& pattern);

}  // namespace muldi::multibody
