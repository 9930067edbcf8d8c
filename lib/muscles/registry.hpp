#pragma once
/// The components of this folder that scenes may name: the reader, the schema, the documentation, the builder, the
/// records and the tests follow these lists.
///
/// A component is a described type; it makes a two-point element (muscles/axial.hpp, muscles/two_point.hpp):
///
///     static constexpr std::string_view name, doc;       // the word in the scene
///     describe(self, visit), operator==                  // its fields
///
///     a spring:        Element element(double distance) const;      // `distance` of the ends in the scene pose
///     a muscle model:  Element element(MuscleGiven given) const;
///                      static std::span<const std::string_view> quantities;  // of controls that may drive it
///                      double control_factor(std::string_view quantity, const MuscleGiven& given);
///                      bool is_driven(bool dielectric) const;     // by a control; by the material's nature
///                      std::optional<Fault> fault() const;        // of its options
///
/// The fields of a muscle model stand in a section of its name, those of a spring beside its ends.
#include <utility>

#include "base/describe.hpp"
#include "muscles/cable.hpp"
#include "muscles/lumped_dea.hpp"
#include "muscles/spring.hpp"

namespace muldi::muscles {

/// Values of `model:` of a muscle.
using MuscleModels = base::TypeList<LumpedModel>;

/// Values of `type:` of a spring; the first is meant without it.
using SpringTypes = base::TypeList<LinearSpring, CableSpring>;

/// One type of spring with what the scene says of it.
using SpringType = base::VariantOf<SpringTypes>;

/// What the components make.
template <class Model>
using MuscleElement = decltype(std::declval<const Model&>().element(MuscleGiven{}));
template <class Type>
using SpringElement = decltype(std::declval<const Type&>().element(0.0));

template <class... Models, class... Springs>
auto elements_of(base::TypeList<Models...>, base::TypeList<Springs...>)
    -> base::TypeList<MuscleElement<Models>..., SpringElement<Springs>...>;

using MuscleElements = decltype(elements_of(MuscleModels{}, base::TypeList<>{}));
/// All elements between two points; each type present in a model becomes one term.
using TwoPointTypes = decltype(elements_of(MuscleModels{}, SpringTypes{}));

}  // namespace muldi::muscles
