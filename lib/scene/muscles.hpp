#pragma once
/// Muscles between two points and isolated actuators.
#include <optional>
#include <span>
#include <string_view>

#include "base/describe.hpp"
#include "muscles/registry.hpp"
#include "scene/bodies.hpp"
#include "scene/controls.hpp"
#include "scene/materials.hpp"

namespace muldi::scene {

enum class MuscleModel { lumped, fe };

inline std::span<const base::Word<MuscleModel>> words(MuscleModel) {
  static constexpr base::Word<MuscleModel> all[] = {
      {.word = "lumped", .value = MuscleModel::lumped, .doc = "one element between two points"},
      {.word = "fe", .value = MuscleModel::fe, .doc = "the finite element model", .later = true},
  };
  return all;
}

enum class MuscleEnds { attached, free };

inline std::span<const base::Word<MuscleEnds>> words(MuscleEnds) {
  static constexpr base::Word<MuscleEnds> all[] = {
      {.word = "attached", .value = MuscleEnds::attached, .doc = "between `from` and `to`"},
      {.word = "free",
       .value = MuscleEnds::free,
       .doc = "isolated actuator along `axis`: centre at rest, its length moves"},
  };
  return all;
}

struct Muscle {
  MuscleModel model = MuscleModel::lumped;
  MuscleEnds ends = MuscleEnds::attached;
  std::optional<Attachment> from = {};  ///< these two: given where the ends are attached
  std::optional<Attachment> to = {};    ///<
  std::optional<Vec3> axis = {};        ///< these two: given where the ends are free; world axes, any length
  std::optional<double> length = {};    ///< length in the scene pose
  muscles::Section section = {};
  MaterialName material = {};
  std::optional<ControlName> control = {};     ///< given where the material is a dielectric
  std::optional<double> rest_length = {};      ///< none: distance of the ends (or `length`) in the scene pose
  std::optional<double> layer_thickness = {};  ///< given where the control is a layer voltage
  muscles::LumpedModel lumped = {};            ///< its optional fields replace what the muscle and its material say

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "model", .doc = "model of the muscle"}, self.model);
    visit(Field{.key = "ends", .doc = "what the ends are fixed to", .need = optional}, self.ends);
    visit(Field{.key = "from", .doc = "first end", .need = optional}, self.from);
    visit(Field{.key = "to", .doc = "second end", .need = optional}, self.to);
    visit(Field{.key = "axis", .doc = "direction of an isolated actuator, world axes", .need = optional}, self.axis);
    visit(Field{.key = "length",
                .doc = "length of an isolated actuator in the scene pose",
                .unit = dimension::length,
                .range = positive,
                .need = optional},
          self.length);
    visit(Field{.key = "section", .doc = "undeformed cross-section"}, self.section);
    visit(Field{.key = "material", .doc = "name of a material"}, self.material);
    visit(Field{.key = "control", .doc = "name of the control that drives it: a field or a voltage", .need = optional},
          self.control);
    visit(Field{.key = "rest_length",
                .doc = "undeformed length; default that in the scene pose",
                .unit = dimension::length,
                .range = positive,
                .need = optional},
          self.rest_length);
    visit(Field{.key = "layer_thickness",
                .doc = "undeformed thickness of one dielectric layer, for layer voltages and charges",
                .unit = dimension::length,
                .range = positive,
                .need = optional},
          self.layer_thickness);
    visit(Field{.key = "lumped", .doc = "options of the lumped model", .need = optional}, self.lumped);
    visit(Later{.key = "fe", .doc = "the finite element model of muscles"});
  }
  friend bool operator==(const Muscle&, const Muscle&) = default;
};

/// The cross-section that the lumped model uses.
const muscles::Section& lumped_section(const Muscle& muscle);
/// The material that the lumped model uses: that of the muscle with the replacements of `lumped` (a neo-Hookean
/// replacement is given by mu and Poisson's ratio).
Material lumped_material(const Muscle& muscle, const Material& material);

}  // namespace muldi::scene
