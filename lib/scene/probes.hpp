#pragma once
/// What is recorded of solids: fields over the mesh, and single numbers over time.
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/describe.hpp"
#include "scene/bodies.hpp"
#include "scene/entries.hpp"
#include "scene/solids.hpp"

namespace muldi::scene {

/// A field over the mesh of a solid.
enum class SolidField { position, velocity, potential, pressure, stress, field, true_field, jacobian };

inline std::span<const base::Word<SolidField>> words(SolidField) {
  using enum SolidField;
  static constexpr base::Word<SolidField> all[] = {
      {.word = "position", .value = position, .doc = "positions of the nodes"},
      {.word = "velocity", .value = velocity, .doc = "velocities of the nodes"},
      {.word = "potential", .value = potential, .doc = "electric potential at the nodes"},
      {.word = "pressure", .value = pressure, .doc = "pressure of the cells, > 0 in compression"},
      {.word = "stress", .value = stress, .doc = "mean Cauchy stress of the cells (xx, yy, zz, xy, yz, zx)"},
      {.word = "field", .value = field, .doc = "nominal electric field of the cells"},
      {.word = "true_field", .value = true_field, .doc = "electric field in the deformed cells"},
      {.word = "jacobian", .value = jacobian, .doc = "volume of the cells by their reference volume"},
  };
  return all;
}

/// What is recorded of every driven muscle and every electrode beside its charge.
enum class ElectricQuantity { capacitance, stored_energy, supplied_energy };

inline std::span<const base::Word<ElectricQuantity>> words(ElectricQuantity) {
  using enum ElectricQuantity;
  static constexpr base::Word<ElectricQuantity> all[] = {
      {.word = "capacitance",
       .value = capacitance,
       .doc =
           "charge a volt at the present shape: of an electrode, or of one layer of a muscle with a layer_thickness"},
      {.word = "stored_energy", .value = stored_energy, .doc = "energy of the electric field, +1/2 C U^2"},
      {.word = "supplied_energy",
       .value = supplied_energy,
       .doc = "integral of U dQ since the first row: what the sources have given, < 0 where they have gained"},
  };
  return all;
}

/// Fields of one solid. In the input a list, or {fields, every}.
struct RecordedFields {
  std::vector<SolidField> fields = {};
  int every = 1;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(Field{.key = "fields", .doc = "fields that are recorded"}, self.fields);
    visit(Field{.key = "every",
                .doc = "records between records of these fields",
                .range = {.min = 1.0, .max = 1e9},
                .need = Need::optional},
          self.every);
  }
  friend bool operator==(const RecordedFields&, const RecordedFields&) = default;
};

/// A point of a solid or body. In the input "solid@[x, y, z]" (the node there, in the mesh's own frame) or
/// "body.point".
struct ProbePoint {
  std::optional<SolidName> solid = {};  ///< exactly one of solid and body
  Vec3 at = {};                         ///< with a solid
  std::optional<BodyName> body = {};
  BodyPoint point = {};  ///< with a body
  Origin origin = {};

  friend bool operator==(const ProbePoint&, const ProbePoint&) = default;
};

/// Faces or nodes of a solid. In the input "solid@face", or {solid, where}.
struct ProbeRegion {
  SolidName solid = {};
  Where where = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "solid", .doc = "name of a solid"}, self.solid);
    visit(base::Field{.key = "where", .doc = "faces or nodes, as in conditions"}, self.where);
  }
  friend bool operator==(const ProbeRegion&, const ProbeRegion&) = default;
};

/// An electrode of a solid. In the input "solid.electrode".
struct ElectrodeName {
  SolidName solid = {};
  std::string name = {};

  friend bool operator==(const ElectrodeName&, const ElectrodeName&) = default;
};

enum class ProbeQuantity { position, displacement, velocity, potential };

inline std::span<const base::Word<ProbeQuantity>> words(ProbeQuantity) {
  using enum ProbeQuantity;
  static constexpr base::Word<ProbeQuantity> all[] = {
      {.word = "position", .value = position, .doc = "where it is"},
      {.word = "displacement", .value = displacement, .doc = "how far it is from the scene pose"},
      {.word = "velocity", .value = velocity, .doc = "how fast it moves"},
      {.word = "potential", .value = potential, .doc = "electric potential"},
  };
  return all;
}

/// describe() of the direction along which a vector is recorded.
template <class Value, class Visit>
void describe_along(Value& along, Visit& visit) {
  visit(base::Field{.key = "along",
                    .doc = "record the component along this direction, world axes, of any length",
                    .need = base::Need::optional},
        along);
}
template <class Value, class Visit>
void describe_quantity(Value& quantity, Visit& visit) {
  visit(base::Field{.key = "of", .doc = "what is recorded", .need = base::Need::optional}, quantity);
}

struct DistanceProbe {
  static constexpr std::string_view name = "distance";
  static constexpr std::string_view doc = "distance of two points";
  static constexpr bool named_by_field = true;

  std::array<ProbePoint, 2> distance = {};
  std::optional<Vec3> along = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "distance", .doc = "two of \"solid@[x, y, z]\" and \"body.point\""}, self.distance);
    describe_along(self.along, visit);
  }
  friend bool operator==(const DistanceProbe&, const DistanceProbe&) = default;
};

struct PointProbe {
  static constexpr std::string_view name = "point";
  static constexpr std::string_view doc = "a node of a solid";
  static constexpr bool named_by_field = true;

  ProbePoint point = {};
  ProbeQuantity of = ProbeQuantity::position;
  std::optional<Vec3> along = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "point", .doc = "\"solid@[x, y, z]\""}, self.point);
    describe_quantity(self.of, visit);
    describe_along(self.along, visit);
  }
  friend bool operator==(const PointProbe&, const PointProbe&) = default;
};

struct AverageProbe {
  static constexpr std::string_view name = "average";
  static constexpr std::string_view doc = "average over faces, by reference area";
  static constexpr bool named_by_field = true;

  ProbeRegion average = {};
  ProbeQuantity of = ProbeQuantity::position;
  std::optional<Vec3> along = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "average", .doc = "\"solid@face\" or {solid, where}"}, self.average);
    describe_quantity(self.of, visit);
    describe_along(self.along, visit);
  }
  friend bool operator==(const AverageProbe&, const AverageProbe&) = default;
};

struct ReactionProbe {
  static constexpr std::string_view name = "reaction";
  static constexpr std::string_view doc = "force that holds prescribed displacements, on the solid";
  static constexpr bool named_by_field = true;

  ProbeRegion reaction = {};
  std::optional<Vec3> along = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "reaction", .doc = "\"solid@face\" or {solid, where}"}, self.reaction);
    describe_along(self.along, visit);
  }
  friend bool operator==(const ReactionProbe&, const ReactionProbe&) = default;
};

struct ChargeProbe {
  static constexpr std::string_view name = "charge";
  static constexpr std::string_view doc = "charge of an electrode";
  static constexpr bool named_by_field = true;

  ElectrodeName charge = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "charge", .doc = "\"solid.electrode\""}, self.charge);
  }
  friend bool operator==(const ChargeProbe&, const ChargeProbe&) = default;
};

using ProbeTypes = base::TypeList<DistanceProbe, PointProbe, AverageProbe, ReactionProbe, ChargeProbe>;

/// A number or vector over time.
using Probe = base::VariantOf<ProbeTypes>;

}  // namespace muldi::scene
