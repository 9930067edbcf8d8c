#pragma once
/// Solids that are attached to one another become one finite-element solid with several members.
#include <vector>

#include "build/build_solids.hpp"
#include "build/build_ties.hpp"

namespace muldi::build {

/// A solid of the scene before it is given to the model.
struct SolidPart {
  const scene::Entry<scene::Solid>* entry = nullptr;
  const fem::Mesh* mesh = nullptr;
  fem::SolidDescription data = {};
  std::vector<TiedNodes> tied = {};
};

/// What becomes one finite-element solid.
struct JoinedSolid {
  std::vector<std::size_t> solids = {};  ///< of the scene, in the order of the members
  fem::SolidDescription data = {};
  std::vector<std::vector<TiedNodes>> tied = {};  ///< of each member, in the numbers of `data`
  std::vector<JoinedNodes> joints = {};
  std::vector<base::Diagnostic> notes = {};
};

/// Puts attached solids together, in the order of the first of them; a solid that nothing is attached to stays as it
/// is. Errors for attachments that cannot be.
std::vector<JoinedSolid> join_solids(std::vector<SolidPart> parts, std::vector<base::Diagnostic>& errors);

}  // namespace muldi::build
