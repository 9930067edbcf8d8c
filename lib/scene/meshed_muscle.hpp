#pragma once
/// The finite element model of a muscle: a bar of layers of cells between its ends, electrodes between the layers.
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/describe.hpp"
#include "fem/mesh/registry.hpp"
#include "muscles/registry.hpp"
#include "scene/formulation.hpp"

namespace muldi::scene {

/// What a scene says under `fe:` of a muscle. The bar runs from end to end in the scene pose, where it is undeformed.
/// All nodes of its two end faces are fixed to what the muscle's ends are fixed to. The node layers are electrodes, at
/// potential 0 and at the voltage of one layer of cells in turn, from `from` on.
struct MeshedMuscle {
  static constexpr std::string_view name = "fe";
  static constexpr std::string_view doc = "finite elements between two end faces";
  static constexpr std::span<const std::string_view> quantities = muscles::field_quantities;

  int layers = 0;
  int section_cells = 0;
  fem::Rim rim = fem::Rim::circle;
  std::optional<Formulation> formulation = {};  ///< none: by material
  std::optional<base::Vec3> section_axis = {};
  muscles::Replacements replacements = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "layers", .doc = "layers of cells along the muscle", .range = {.min = 1.0, .max = 1e5}},
          self.layers);
    visit(Field{.key = "section_cells",
                .doc = "cells of the section: 4, 16, 64, ... of a round one (4: eight nodes of a regular octagon and "
                       "the centre); 1, 4, 9, 16, ... of a square",
                .range = {.min = 1.0, .max = 262144.0}},
          self.section_cells);
    visit(Field{.key = "rim", .doc = "where the nodes of a round rim are", .need = optional}, self.rim);
    visit(Field{.key = "formulation",
                .doc = "treatment of volume; default incompressible where Poisson's ratio is 0.5, else mean_dilatation",
                .need = optional},
          self.formulation);
    visit(Field{.key = "section_axis",
                .doc = "direction of the section's first axis in the scene pose, world axes; default the x axis of the "
                       "body at `from`, or its y axis if the muscle runs within 45 degrees of x",
                .need = optional},
          self.section_axis);
    muscles::Replacements::describe(self.replacements, visit);
  }
  friend bool operator==(const MeshedMuscle&, const MeshedMuscle&) = default;

  std::optional<muscles::Fault> fault() const { return replacements.fault(); }
  bool is_driven(bool dielectric) const { return replacements.is_dielectric(dielectric); }

  /// Cells along an edge of a square section; 0 if section_cells is no square number.
  int cells_along_edge() const;
  /// Why the section of the muscle cannot be meshed so, for people; empty if it can.
  std::string why_no_mesh(const muscles::Section& said) const;
};

}  // namespace muldi::scene
