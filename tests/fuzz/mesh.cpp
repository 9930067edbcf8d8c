/// Meshes of Gmsh, text and binary: what is read has only nodes that exist.
#include <cstdlib>

#include "base/error.hpp"
#include "fem/mesh/gmsh.hpp"
#include "fuzz/target.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace muldi;
  try {
    const fem::Mesh mesh = fem::read_gmsh_text(fuzz::as_text(bytes, size), "fuzz.msh");
    for (const auto& cell : mesh.cells) {
      for (const int node : cell) {
        if (node < 0 || static_cast<std::size_t>(node) >= mesh.nodes.size()) std::abort();
      }
    }
  } catch (const base::InputError&) {
  }
  return 0;
}
