#pragma once
/// How the cells of solids and of muscles keep their volume.
#include <array>
#include <optional>
#include <span>
#include <string>

#include "base/describe.hpp"
#include "scene/materials.hpp"

namespace muldi::scene {

enum class Formulation { displacement, mean_dilatation, incompressible, incompressible_direct };

inline std::span<const base::Word<Formulation>> words(Formulation) {
  using enum Formulation;
  static constexpr base::Word<Formulation> all[] = {
      {.word = "displacement", .value = displacement, .doc = "volume energy at every Gauss point (model I; locks)"},
      {.word = "mean_dilatation", .value = mean_dilatation, .doc = "volume energy of each cell's mean (model II)"},
      {.word = "incompressible",
       .value = incompressible,
       .doc = "each cell keeps its volume exactly, with a pressure of its own (model III)"},
      {.word = "incompressible_direct",
       .value = incompressible_direct,
       .doc = "the same without the intermediate dilatation (model IV)"},
  };
  return all;
}

/// The formulation of the cells of a material: the one that is said, or the default of the material.
Formulation formulation_of(const std::optional<Formulation>& said, const Material& material);

/// Why cells of this formulation cannot be of the material with this name, for people; empty if they can.
std::string why_unfit(Formulation formulation, const Elastic& elastic, const std::string& name);

}  // namespace muldi::scene
