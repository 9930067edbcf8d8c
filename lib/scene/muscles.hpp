#pragma once
/// Muscles between two points and isolated actuators.
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "base/describe.hpp"
#include "muscles/registry.hpp"
#include "scene/bodies.hpp"
#include "scene/controls.hpp"
#include "scene/materials.hpp"
#include "scene/meshed_muscle.hpp"

namespace muldi::scene {

/// All values of `model:`.
using MuscleModels = base::Joined<muscles::MuscleModels, base::TypeList<MeshedMuscle>>;

/// A place in MuscleModels.
enum class MuscleModel : std::size_t {};

template <class Model>
inline constexpr MuscleModel muscle_model{base::index_in<Model>(MuscleModels{})};

template <class... Models>
constexpr std::array<base::Word<MuscleModel>, sizeof...(Models)> muscle_model_words(base::TypeList<Models...>) {
  return {{{.word = Models::name, .value = muscle_model<Models>, .doc = Models::doc}...}};
}

inline std::span<const base::Word<MuscleModel>> words(MuscleModel) {
  static constexpr auto all = muscle_model_words(MuscleModels{});
  return all;
}

/// The options of each model of a list, where given.
template <class List>
struct OptionsOf;
template <class... Models>
struct OptionsOf<base::TypeList<Models...>> {
  using Tuple = std::tuple<std::optional<Models>...>;
};
/// Those of models that are not chosen are kept, so that a scene can change its model by one word.
using MuscleOptions = OptionsOf<MuscleModels>::Tuple;

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
  MuscleModel model = {};
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
  MuscleOptions options = {};

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
    for_each_type(MuscleModels{}, [&]<class Model>(std::type_identity<Model>) {
      visit(Field{.key = Model::name, .doc = "options of the model of this name", .need = optional},
            std::get<std::optional<Model>>(self.options));
    });
  }
  friend bool operator==(const Muscle&, const Muscle&) = default;
};

/// Whether the muscle is built from finite elements.
inline bool is_meshed(const Muscle& muscle) { return muscle.model == muscle_model<MeshedMuscle>; }

}  // namespace muldi::scene
