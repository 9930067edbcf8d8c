#pragma once
/// Deformable solids: mesh, material, conditions, electrodes, attachments.
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/describe.hpp"
#include "fem/mesh/registry.hpp"
#include "scene/bodies.hpp"
#include "scene/controls.hpp"
#include "scene/entries.hpp"
#include "scene/formulation.hpp"
#include "scene/materials.hpp"
#include "scene/rigid_velocity.hpp"

namespace muldi::scene {

/// Where on a solid something is, in the mesh's own frame. In the input the name of a face (or of a set of nodes), the
/// word `all`, or a map with one of face, box, plane, set, point, part.
struct Where {
  fem::Selector selector = {};
  Origin origin = {};

  friend bool operator==(const Where&, const Where&) = default;
};

/// The materials of a solid. In the input one name, or {part: name}.
struct SolidMaterial {
  MaterialName whole = {};         ///< empty name: see `parts`
  Named<MaterialName> parts = {};  ///< by part of the mesh
  Origin origin = {};

  /// All materials that are named, in order.
  std::vector<MaterialName> names() const;

  friend bool operator==(const SolidMaterial&, const SolidMaterial&) = default;
};

/// A component of a displacement: a value, or ~ where the direction is free.
using FreeOrDriven = std::optional<Drive>;

/// What is prescribed on a part of a solid; at least one of the values is given. Components are along the world axes.
struct Condition {
  Where where = {};
  std::optional<std::array<FreeOrDriven, 3>> displacement = {};
  std::optional<Drive> potential = {};
  std::optional<std::array<Drive, 3>> traction = {};
  std::optional<Drive> pressure = {};
  std::optional<std::array<Drive, 3>> body_force = {};
  std::optional<Drive> surface_charge = {};
  Origin origin = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "where",
                .doc = "face, set, {face, x, y, z}, {box}, {plane}, {set}, {point}, {part} or all, in the mesh's own "
                       "frame"},
          self.where);
    visit(Field{.key = "displacement",
                .doc = "displacement from the scene pose along the world axes, ~ where free",
                .unit = dimension::length,
                .need = optional},
          self.displacement);
    visit(Field{.key = "potential", .doc = "electric potential", .unit = dimension::voltage, .need = optional},
          self.potential);
    visit(Field{.key = "traction",
                .doc = "force by reference area along the world axes; keeps its direction",
                .unit = dimension::stress,
                .need = optional},
          self.traction);
    visit(Field{.key = "pressure",
                .doc = "force by deformed area against the surface, which it follows",
                .unit = dimension::stress,
                .need = optional},
          self.pressure);
    visit(Field{.key = "body_force",
                .doc = "force by reference volume along the world axes, on `all`, a part or a box",
                .unit = dimension::force / dimension::volume,
                .need = optional},
          self.body_force);
    visit(Field{.key = "surface_charge",
                .doc = "charge by reference area",
                .unit = dimension::charge / dimension::area,
                .need = optional},
          self.surface_charge);
  }
  friend bool operator==(const Condition&, const Condition&) = default;
};

/// What alternates in a stack of electrodes.
enum class Alternate { layers, parts };

inline std::span<const base::Word<Alternate>> words(Alternate) {
  static constexpr base::Word<Alternate> all[] = {
      {.word = "layers", .value = Alternate::layers, .doc = "the node layers of an extruded mesh, from below"},
      {.word = "parts", .value = Alternate::parts, .doc = "the layers of cells of one part, from below"},
  };
  return all;
}

/// An equipotential, or a stack of them: either where with charge or potential, or alternate with potentials.
struct Electrode {
  std::optional<Where> where = {};
  std::optional<Drive> charge = {};     ///< total charge; the potential is an unknown
  std::optional<Drive> potential = {};  ///< given potential; the charge is a result
  std::optional<Alternate> alternate = {};
  std::string part = {};               ///< with Alternate::parts
  std::vector<Drive> potentials = {};  ///< taken in turn
  Origin origin = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "where", .doc = "nodes of one potential", .need = optional}, self.where);
    visit(Field{.key = "charge",
                .doc = "total charge of a floating electrode; its potential follows",
                .unit = dimension::charge,
                .need = optional},
          self.charge);
    visit(
        Field{.key = "potential", .doc = "potential; the charge follows", .unit = dimension::voltage, .need = optional},
        self.potential);
    visit(Field{.key = "alternate", .doc = "instead of where: many electrodes, one upon the other", .need = optional},
          self.alternate);
    visit(
        Field{.key = "part", .doc = "with `alternate: parts`: the part whose layers are electrodes", .need = optional},
        self.part);
    visit(Field{.key = "potentials",
                .doc = "with `alternate`: potentials that the electrodes have in turn",
                .unit = dimension::voltage,
                .need = optional},
          self.potentials);
  }
  friend bool operator==(const Electrode&, const Electrode&) = default;
};

/// Ties nodes of a solid to a body, or to another solid: there each becomes one with the corner that it meets, or a
/// weighted sum of the corners of the face that it lies on, as it is in the scene pose.
struct SolidAttachment {
  Where where = {};
  std::optional<BodyName> body = {};  ///< exactly one of body and solid
  std::optional<SolidName> solid = {};
  std::optional<Where> where_other = {};  ///< with a solid
  Origin origin = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "where",
                .doc = "nodes that are fixed to the other, for the whole motion and as they are in the scene pose; "
                       "between solids of the finer mesh where the meshes differ"},
          self.where);
    visit(Field{.key = "body", .doc = "name of a body, or `ground`", .need = optional}, self.body);
    visit(Field{.key = "solid",
                .doc = "name of another solid, instead of a body; the potential of two dielectrics is continuous "
                       "across the joint, and an electrode there is one of both",
                .need = optional},
          self.solid);
    visit(Field{.key = "where_other",
                .doc = "faces of the other solid on which the nodes lie, within 1e-6 of the size of the attached one: "
                       "nodes that meet become one, others follow the four corners of their face",
                .need = optional},
          self.where_other);
  }
  friend bool operator==(const SolidAttachment&, const SolidAttachment&) = default;
};

struct Solid {
  fem::MeshType mesh = {};
  Vec3 position = {};            ///< of the origin of the mesh's own frame
  Orientation orientation = {};  ///< of the axes of the mesh's own frame
  SolidMaterial material = {};
  std::optional<Formulation> formulation = {};  ///< none: by material, formulation_of()
  std::vector<Condition> conditions = {};
  Named<Electrode> electrodes = {};
  std::vector<SolidAttachment> attach = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "mesh", .doc = "{box: ...}, {cylinder: ...}, {stack: ...} or {file: ...}"}, self.mesh);
    visit(Field{.key = "position",
                .doc = "where the origin of the mesh's own frame is in the scene pose",
                .unit = dimension::length,
                .need = optional},
          self.position);
    visit(Field{.key = "orientation",
                .doc = "axes of the mesh's own frame in the scene pose, as of bodies",
                .need = optional},
          self.orientation);
    visit(Field{.key = "material", .doc = "name of a material, or {part: material} for all parts of the mesh"},
          self.material);
    visit(Field{.key = "formulation",
                .doc = "treatment of volume; default incompressible where Poisson's ratio is 0.5, else mean_dilatation",
                .need = optional},
          self.formulation);
    visit(Field{.key = "conditions", .doc = "what is prescribed where", .need = optional}, self.conditions);
    visit(Field{.key = "electrodes", .doc = "equipotentials by name", .need = optional}, self.electrodes);
    visit(Field{.key = "attach", .doc = "ties to bodies and other solids", .need = optional}, self.attach);
  }
  friend bool operator==(const Solid&, const Solid&) = default;
};

/// Whether any potential or charge is prescribed: without it there is no field to compute.
bool has_field(const Solid& solid);
/// Names of faces that the mesh will have; empty where only its file knows.
std::vector<std::string> face_names_of(const fem::MeshType& mesh);
/// Names of the parts that the mesh will have; empty where only its file knows.
std::vector<std::string> part_names_of(const fem::MeshType& mesh);

/// Initial velocity of a solid as a rigid body.
struct SolidVelocity : RigidVelocity {
  friend bool operator==(const SolidVelocity&, const SolidVelocity&) = default;
};

}  // namespace muldi::scene
