#include "scene/check_solids.hpp"

#include <algorithm>

#include "base/text.hpp"
#include "scene/input_file.hpp"

namespace muldi::scene {
namespace {

bool contains(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_file(const Solid& solid) { return std::holds_alternative<fem::MeshFile>(solid.mesh); }

}  // namespace

void SolidCheck::solids() {
  for (const Entry<Solid>& solid : scene_.solids) check_solid(solid);
}

void SolidCheck::check_solid(const Entry<Solid>& solid) {
  check_mesh(solid);
  if (!context_.failed(solid.origin.path + ".material")) {
    check_parts(solid);
    for (const MaterialName& name : solid.value.material.names()) check_formulation(solid, name);
  }
  for (const Condition& condition : solid.value.conditions) {
    if (!failed(condition.origin)) check_condition(solid.value, condition);
  }
  for (const Entry<Electrode>& electrode : solid.value.electrodes) {
    if (!failed(electrode.origin)) check_electrode(solid.value, electrode);
  }
  for (const SolidAttachment& attachment : solid.value.attach) {
    if (!failed(attachment.origin)) check_attachment(solid, attachment);
  }
  if (!failed(solid.origin)) check_field(solid);
}

void SolidCheck::check_mesh(const Entry<Solid>& solid) {
  if (context_.failed(solid.origin.path + ".mesh")) return;
  const std::string why = std::visit([](const auto& mesh) { return mesh.why_invalid(); }, solid.value.mesh);
  if (!why.empty()) check_.error({"solids", solid.name, "mesh"}, why);
  const auto* file = std::get_if<fem::MeshFile>(&solid.value.mesh);
  if (file == nullptr || context_.failed(solid.origin.path + ".mesh.file")) return;
  const std::string outside = why_not_in_folder(file->path);
  if (!outside.empty()) check_.error({"solids", solid.name, "mesh", "file"}, outside);
}

void SolidCheck::check_parts(const Entry<Solid>& solid) {
  const SolidMaterial& material = solid.value.material;
  if (material.parts.empty() || is_file(solid.value) || context_.failed(solid.origin.path + ".mesh")) return;
  const std::vector<std::string> parts = part_names_of(solid.value.mesh);
  for (const Entry<MaterialName>& part : material.parts) {
    if (contains(parts, part.name)) continue;
    error(part.origin, "the mesh has no part " + base::in_quotes(part.name) + base::did_you_mean(part.name, parts));
  }
  if (failed(material.origin)) return;
  for (const std::string& part : parts) {
    if (material.parts.find(part) == nullptr)
      error(material.origin, "missing key '" + part + "': the material of this part");
  }
}

void SolidCheck::check_formulation(const Entry<Solid>& solid, const MaterialName& name) {
  const Entry<Material>* material = scene_.materials.find(name.name);
  if (material == nullptr || context_.failed("materials." + name.name)) return;
  if (context_.failed(solid.origin.path + ".formulation")) return;
  const Formulation formulation = formulation_of(solid.value.formulation, material->value);
  const std::string why = why_unfit(formulation, material->value.elastic, name.name);
  if (why.empty()) return;
  if (solid.value.formulation) {
    check_.error({"solids", solid.name, "formulation"}, why);
  } else {
    error(name.origin, why);
  }
}

void SolidCheck::check_drive(const Drive& drive, const std::vector<ControlQuantity>& quantities) {
  if (drive.control.name.empty()) return;
  if (!quantities.empty()) {
    check_.check_quantity(drive.control, quantities);
  } else {
    error(drive.control.origin, "no control has this quantity; give a number or a function of time");
  }
}

void SolidCheck::check_condition(const Solid& solid, const Condition& condition) {
  using enum ControlQuantity;
  const bool on_faces = condition.traction || condition.pressure || condition.surface_charge;
  if (!condition.displacement && !condition.potential && !condition.body_force && !on_faces) {
    error(condition.origin,
          "prescribes nothing: give displacement, potential, traction, pressure, body_force or surface_charge");
    return;
  }
  check_where(solid, condition.where, on_faces ? Need::faces : condition.body_force ? Need::cells : Need::nodes);
  if (condition.displacement) {
    bool any = false;
    for (const FreeOrDriven& component : *condition.displacement) {
      any = any || component.has_value();
      if (component) check_drive(*component, {displacement});
    }
    if (!any) error(condition.origin, "the displacement is free in all directions");
  }
  if (condition.potential) check_drive(*condition.potential, {potential});
  if (condition.pressure) check_drive(*condition.pressure, {pressure});
  if (condition.surface_charge) check_drive(*condition.surface_charge, {});
  if (condition.traction) {
    for (const Drive& component : *condition.traction) check_drive(component, {pressure});
  }
  if (condition.body_force) {
    for (const Drive& component : *condition.body_force) check_drive(component, {});
  }
}

void SolidCheck::check_electrode(const Solid& solid, const Entry<Electrode>& entry) {
  const Electrode& electrode = entry.value;
  if (electrode.where.has_value() == electrode.alternate.has_value()) {
    error(electrode.origin, electrode.where ? "give either where or alternate, not both"
                                            : "missing key 'where' (one electrode) or 'alternate' (a stack of them)");
    return;
  }
  if (electrode.alternate) {
    check_alternating(solid, electrode);
    return;
  }
  check_where(solid, *electrode.where, Need::nodes);
  if (!electrode.potentials.empty()) error(electrode.origin, "potentials belong to an electrode with 'alternate'");
  if (!electrode.part.empty()) {
    error(electrode.origin, "part belongs to an electrode with 'alternate'; one part is where: {part: name}");
  }
  if (electrode.charge && electrode.potential) {
    error(electrode.origin, "give either charge or potential, not both: the other follows");
  } else if (!electrode.charge && !electrode.potential) {
    error(electrode.origin,
          "missing key 'charge' or 'potential': a floating electrode has a total charge, 0 where it was never charged");
  }
  if (electrode.charge) check_drive(*electrode.charge, {ControlQuantity::charge});
  if (electrode.potential) check_drive(*electrode.potential, {ControlQuantity::potential});
}

void SolidCheck::check_alternating(const Solid& solid, const Electrode& electrode) {
  if (electrode.charge || electrode.potential) {
    error(electrode.origin, "alternating electrodes have 'potentials', not charge or potential");
    return;
  }
  if (electrode.potentials.empty()) error(electrode.origin, "missing key 'potentials' of alternating electrodes");
  for (const Drive& drive : electrode.potentials) check_drive(drive, {ControlQuantity::potential});
  if (is_file(solid)) error(electrode.origin, "the mesh of a file has no layers; name its electrodes one by one");
  const bool by_part = electrode.alternate == Alternate::parts;
  if (by_part != !electrode.part.empty()) {
    error(electrode.origin, by_part ? "missing key 'part' with 'alternate: parts': the part whose layers are electrodes"
                                    : "part belongs to 'alternate: parts'");
  }
  const std::vector<std::string> parts = part_names_of(solid.mesh);
  if (by_part && !electrode.part.empty() && !parts.empty() && !contains(parts, electrode.part)) {
    error(electrode.origin,
          "the mesh has no part " + base::in_quotes(electrode.part) + base::did_you_mean(electrode.part, parts));
  }
}

void SolidCheck::check_attachment(const Entry<Solid>& solid, const SolidAttachment& attachment) {
  check_where(solid.value, attachment.where, Need::nodes);
  if (attachment.body.has_value() == attachment.solid.has_value()) {
    error(attachment.origin, attachment.body ? "give either body or solid, not both" : "missing key 'body' or 'solid'");
    return;
  }
  if (attachment.where_other.has_value() != attachment.solid.has_value()) {
    error(attachment.origin, attachment.solid ? "missing key 'where_other': faces of the other solid"
                                              : "where_other belongs to the attachment to a solid");
    return;
  }
  if (!attachment.solid) return;
  if (attachment.solid->name == solid.name) {
    error(attachment.solid->origin, "a solid cannot be attached to itself");
    return;
  }
  if (const Entry<Solid>* other = scene_.solids.find(attachment.solid->name)) {
    check_where(other->value, *attachment.where_other, Need::faces);
  }
}

bool SolidCheck::is_joined(const Entry<Solid>& solid) const {
  const auto attaches = [](const Solid& one, const std::string* to) {
    return std::any_of(one.attach.begin(), one.attach.end(), [to](const SolidAttachment& said) {
      return said.solid && (to == nullptr || said.solid->name == *to);
    });
  };
  return attaches(solid.value, nullptr) ||
         std::any_of(scene_.solids.begin(), scene_.solids.end(),
                     [&](const Entry<Solid>& other) { return attaches(other.value, &solid.name); });
}

void SolidCheck::check_field(const Entry<Solid>& solid) {
  if (!has_field(solid.value)) return;
  bool dielectric = false;
  for (const MaterialName& name : solid.value.material.names()) {
    const Entry<Material>* material = scene_.materials.find(name.name);
    if (material == nullptr || context_.failed("materials." + name.name)) return;
    dielectric = dielectric || material->value.electric.has_value();
  }
  const auto& conditions = solid.value.conditions;
  const auto& electrodes = solid.value.electrodes;
  if (!dielectric) {
    const auto first = std::find_if(conditions.begin(), conditions.end(),
                                    [](const Condition& c) { return c.potential || c.surface_charge; });
    error(first != conditions.end() ? first->origin : electrodes.begin()->origin,
          "no material of this solid has an electric law: potentials and charges do nothing");
    return;
  }
  const bool fixed =
      std::any_of(conditions.begin(), conditions.end(), [](const Condition& c) { return c.potential.has_value(); }) ||
      std::any_of(electrodes.begin(), electrodes.end(),
                  [](const Entry<Electrode>& e) { return e.value.potential || !e.value.potentials.empty(); });
  // The potential may come through what it is attached to: that is seen once the meshes are.
  if (!fixed && !is_joined(solid))
    error(solid.origin, "its potential is nowhere fixed: give a condition or an electrode a `potential`");
}

void SolidCheck::check_where(const Solid& solid, const Where& where, Need need) {
  const fem::Selector& selector = where.selector;
  const bool thin = !std::holds_alternative<fem::SelectAll>(selector) &&
                    !std::holds_alternative<fem::SelectPart>(selector) &&
                    !std::holds_alternative<fem::SelectBox>(selector);
  if (need == Need::cells && thin) {
    error(where.origin, "selects no volume: take all, {part: name} or {box: ...}");
    return;
  }
  if (need == Need::faces && std::holds_alternative<fem::SelectPoint>(selector)) {
    error(where.origin, "a point has no area: take a face");
    return;
  }
  if (const auto* box = std::get_if<fem::SelectBox>(&selector)) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (box->box[0][i] && box->box[1][i] && *box->box[0][i] > *box->box[1][i]) {
        error(where.origin, "the box is empty: its low corner is above the high one along " + std::string(1, "xyz"[i]));
        return;
      }
    }
  }
  if (is_file(solid)) return;
  const auto unknown = [&](const char* what, const std::string& name, const std::vector<std::string>& names) {
    if (contains(names, name)) return;
    error(where.origin,
          std::string("the mesh has no ") + what + " " + base::in_quotes(name) + base::did_you_mean(name, names));
  };
  if (const auto* face = std::get_if<fem::SelectFace>(&selector)) {
    unknown("face", face->face, face_names_of(solid.mesh));
  } else if (const auto* part = std::get_if<fem::SelectPart>(&selector)) {
    unknown("part", part->part, part_names_of(solid.mesh));
  } else if (std::holds_alternative<fem::SelectSet>(selector)) {
    error(where.origin, "only the mesh of a file has sets of nodes; take a face, a plane or a box");
  }
}

}  // namespace muldi::scene
