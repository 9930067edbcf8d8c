#pragma once
/// What the user wrote: plain values in the scene's own units, checked, without numerics.
///
///     Scene scene = read_scene("pendulum.yaml", {"dynamics.step=0.5 ms"});      // scene/read_scene.hpp
///     for (const Entry<Joint>& joint : scene.joints) {
///       joint.name; joint.value.from.body.name; joint.value.from.at.position;   // names exist, points are resolved
///       throw base::InputError({error_at(joint.origin, "does not close: gap 0.1 mm")});
///     }
#include <optional>
#include <string>
#include <vector>

#include "base/describe.hpp"
#include "base/diagnostic.hpp"
#include "base/units.hpp"
#include "scene/bodies.hpp"
#include "scene/controls.hpp"
#include "scene/entries.hpp"
#include "scene/forces.hpp"
#include "scene/initial.hpp"
#include "scene/joints.hpp"
#include "scene/materials.hpp"
#include "scene/muscles.hpp"
#include "scene/optimal_control.hpp"
#include "scene/solids.hpp"
#include "scene/tasks.hpp"

namespace muldi::scene {

/// The version of the format that this program reads.
inline constexpr int format_version = 1;

struct Scene {
  int version = format_version;
  std::string title = {};
  base::UnitSystem units = {};  ///< all numbers of the scene, the model and the results are in these units
  Vec3 gravity = {};
  Named<Material> materials = {};
  Named<Body> bodies = {};
  Named<Joint> joints = {};
  Named<Control> controls = {};
  Named<Muscle> muscles = {};
  Named<Solid> solids = {};
  Named<Spring> springs = {};
  Named<Load> loads = {};
  Initial initial = {};
  std::optional<Statics> statics = {};
  std::optional<Dynamics> dynamics = {};
  std::optional<OptimalControl> optimal_control = {};
  Record record = {};
  Solver solver = {};

  Origin origin = {};                           ///< the file, for messages about the scene as a whole
  std::vector<base::Diagnostic> warnings = {};  ///< of the reader; beside the content, not compared

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "muldi", .doc = "version of the scene format", .range = {.min = 1.0, .max = 1.0}}, self.version);
    visit(Field{.key = "title", .doc = "one line for people", .need = optional}, self.title);
    visit(
        Field{
            .key = "units", .doc = "units of bare numbers and of the results; default mm, g, ms, A", .need = optional},
        self.units);
    visit(Field{.key = "gravity",
                .doc = "acceleration of bodies, muscles and solids; default none",
                .unit = dimension::acceleration,
                .need = optional},
          self.gravity);
    visit(Field{.key = "materials", .doc = "materials by name", .need = optional}, self.materials);
    visit(Field{.key = "bodies", .doc = "rigid bodies by name", .need = optional}, self.bodies);
    visit(Field{.key = "joints", .doc = "joints by name", .need = optional}, self.joints);
    visit(Field{.key = "controls", .doc = "{<quantity>: function of time} by name", .need = optional}, self.controls);
    visit(Field{.key = "muscles", .doc = "muscles by name", .need = optional}, self.muscles);
    visit(Field{.key = "solids", .doc = "deformable solids by name", .need = optional}, self.solids);
    visit(Field{.key = "springs", .doc = "springs between points by name", .need = optional}, self.springs);
    visit(Field{.key = "loads", .doc = "forces and torques on bodies by name", .need = optional}, self.loads);
    visit(Field{.key = "initial", .doc = "state at t = 0", .need = optional}, self.initial);
    visit(Field{.key = "statics", .doc = "equilibria to compute", .need = optional}, self.statics);
    visit(Field{.key = "dynamics", .doc = "motion to compute", .need = optional}, self.dynamics);
    visit(Field{.key = "optimal_control", .doc = "controls to find", .need = optional}, self.optimal_control);
    visit(Field{.key = "record", .doc = "what is recorded", .need = optional}, self.record);
    visit(Field{.key = "solver", .doc = "numerical options", .need = optional}, self.solver);
  }

  /// Equal content; positions in the input and warnings do not count.
  friend bool operator==(const Scene& a, const Scene& b) {
    return a.version == b.version && a.title == b.title && a.units == b.units && a.gravity == b.gravity &&
           a.materials == b.materials && a.bodies == b.bodies && a.joints == b.joints && a.controls == b.controls &&
           a.muscles == b.muscles && a.solids == b.solids && a.springs == b.springs && a.loads == b.loads &&
           a.initial == b.initial && a.statics == b.statics && a.dynamics == b.dynamics &&
           a.optimal_control == b.optimal_control && a.record == b.record && a.solver == b.solver;
  }
};

/// The path of a file that the scene names: from the scene's folder unless it is absolute.
std::string path_of_file(const Scene& scene, const std::string& file);

}  // namespace muldi::scene
