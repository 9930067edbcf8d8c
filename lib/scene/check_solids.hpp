#pragma once
/// What the fields of solids say together, and with the rest of the scene.
#include <string>
#include <vector>

#include "scene/scene_check.hpp"

namespace muldi::scene {

/// One look at the solids of a scene and at what is recorded of them. Names of faces and parts are checked where the
/// scene alone tells them; those of mesh files when the mesh is built.
class SolidCheck {
 public:
  SolidCheck(Scene& scene, SceneCheck& check, ReadContext& context) : scene_(scene), check_(check), context_(context) {}

  void solids();
  void record();
  /// Warnings about laws that only serve to reproduce earlier work.
  void legacy_laws();

 private:
  /// What a selection is for.
  enum class Need { nodes, faces, cells };

  void check_solid(const Entry<Solid>& solid);
  void check_mesh(const Entry<Solid>& solid);
  void check_parts(const Entry<Solid>& solid);
  void check_formulation(const Entry<Solid>& solid, const MaterialName& name);
  void check_condition(const Solid& solid, const Condition& condition);
  void check_electrode(const Solid& solid, const Entry<Electrode>& electrode);
  void check_alternating(const Solid& solid, const Electrode& electrode);
  void check_attachment(const Entry<Solid>& solid, const SolidAttachment& attachment);
  void check_field(const Entry<Solid>& solid);
  /// Whether it is attached to another solid, or another to it.
  bool is_joined(const Entry<Solid>& solid) const;
  void check_where(const Solid& solid, const Where& where, Need need);
  /// Where of a solid that is named, if it exists.
  void check_region(const ProbeRegion& region, Need need);
  void check_drive(const Drive& drive, const std::vector<ControlQuantity>& quantities);
  void check_probe(const Entry<Probe>& probe);
  void check_probe_point(ProbePoint& point);
  void check_along(const Entry<Probe>& probe, const std::optional<Vec3>& along);
  void check_muscle_fields(const Entry<RecordedFields>& entry, const Muscle& muscle, bool electric);
  void check_electric();
  void check_potential(const Origin& origin, const SolidName& solid);

  bool failed(const Origin& origin) const { return context_.failed(origin.path); }
  void error(const Origin& origin, std::string message) { context_.add(error_at(origin, std::move(message))); }

  Scene& scene_;
  SceneCheck& check_;
  ReadContext& context_;
};

}  // namespace muldi::scene
