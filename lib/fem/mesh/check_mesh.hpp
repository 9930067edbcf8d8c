#pragma once
/// Whether a mesh can carry a solid.
#include <string>
#include <vector>

#include "fem/mesh/mesh.hpp"

namespace muldi::fem {

/// Sentences that name cells, nodes and faces; of each kind the first few.
struct MeshReport {
  std::vector<std::string> errors = {};
  std::vector<std::string> notes = {};
};

/// Errors: cells with a Jacobian that is not positive at a corner or Gauss point; nodes at the same place; nodes inside
/// a face or edge of a cell that does not have them; nodes of no cell; node numbers that do not exist. Notes: pieces
/// that do not hang together, and what the reader left out. Errors of numbers end the check.
MeshReport check_mesh(const Mesh& mesh);

}  // namespace muldi::fem
