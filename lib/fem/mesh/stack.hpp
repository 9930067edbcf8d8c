#pragma once
/// A bar of layers of different parts, e.g. electrodes and dielectric.
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/describe.hpp"
#include "base/diagnostic.hpp"
#include "fem/mesh/generators.hpp"

namespace muldi::fem {

/// One layer of a stack.
struct StackLayer {
  std::string part = {};
  double thickness = 0.0;
  int cells = 1;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(Field{.key = "part", .doc = "name of the part; layers of one name are one part"}, self.part);
    visit(Field{.key = "thickness", .doc = "thickness along the axis", .unit = dimension::length, .range = positive},
          self.thickness);
    visit(Field{.key = "cells",
                .doc = "cells through the thickness",
                .range = {.min = 1.0, .max = 1e5},
                .need = Need::optional},
          self.cells);
  }
  friend bool operator==(const StackLayer&, const StackLayer&) = default;
};

/// From the origin along the axis: the layers, repeated, then the closing layer.
struct Stack {
  static constexpr std::string_view name = "stack";
  static constexpr std::string_view doc =
      "a bar of layers of named parts, from the origin along its axis; faces as those of a cylinder or box";

  base::VariantOf<SectionTypes> section{};
  Axis axis = Axis::z;
  std::vector<StackLayer> layers{};
  int repeat = 1;
  std::string close{};  ///< part of the layer on top; empty: none

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "section", .doc = "{cylinder: {diameter, ...}} or {box: {size, cells}}"}, self.section);
    visit(Field{.key = "axis", .doc = "axis in the mesh's own frame", .need = optional}, self.axis);
    visit(Field{.key = "layers", .doc = "layers from below, repeated `repeat` times"}, self.layers);
    visit(Field{.key = "repeat",
                .doc = "how often the layers follow each other",
                .range = {.min = 1.0, .max = 1e6},
                .need = optional},
          self.repeat);
    visit(Field{.key = "close",
                .doc = "part of one more layer on top, as thick as the first of this name",
                .need = optional},
          self.close);
  }
  friend bool operator==(const Stack&, const Stack&) = default;

  std::vector<std::string> face_names() const { return extruded_faces(axis, section); }
  /// Each part once, in the order of the layers.
  std::vector<std::string> part_names() const {
    std::vector<std::string> names;
    for (const StackLayer& layer : layers) {
      if (std::find(names.begin(), names.end(), layer.part) == names.end()) names.push_back(layer.part);
    }
    return names;
  }
  /// The layer that `close` repeats, or null.
  const StackLayer* closing_layer() const {
    const auto found =
        std::find_if(layers.begin(), layers.end(), [this](const StackLayer& layer) { return layer.part == close; });
    return found == layers.end() ? nullptr : &*found;
  }
  double n_cells() const {
    double along = 0.0;
    for (const StackLayer& layer : layers) along += layer.cells;
    along *= repeat;
    if (const StackLayer* last = closing_layer()) along += last->cells;
    return along * std::visit([](const auto& shape) { return shape.n_cells(); }, section);
  }
  std::string why_invalid() const {
    const std::string why = std::visit([](const auto& shape) { return shape.why_invalid(); }, section);
    if (!why.empty()) return "section: " + why;
    if (layers.empty()) return "needs at least one layer";
    if (!close.empty() && closing_layer() == nullptr) {
      return "close: no layer of part " + base::in_quotes(close) + base::did_you_mean(close, part_names());
    }
    return why_too_large(n_cells());
  }
};

}  // namespace muldi::fem
