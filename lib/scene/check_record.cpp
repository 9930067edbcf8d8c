// What is recorded of solids.
#include <algorithm>

#include "base/text.hpp"
#include "scene/check_solids.hpp"

namespace muldi::scene {
namespace {

bool is_electric(SolidField field) {
  return field == SolidField::potential || field == SolidField::field || field == SolidField::true_field;
}

}  // namespace

void SolidCheck::check_potential(const Origin& origin, const SolidName& name) {
  const Entry<Solid>* solid = scene_.solids.find(name.name);
  if (solid == nullptr || failed(solid->origin) || has_field(solid->value)) return;
  error(origin, "solid " + base::in_quotes(name.name) + " has no field: no potential or charge is prescribed on it");
}

void SolidCheck::check_region(const ProbeRegion& region, Need need) {
  const Entry<Solid>* solid = scene_.solids.find(region.solid.name);
  if (solid != nullptr && !context_.failed(solid->origin.path + ".mesh")) {
    check_where(solid->value, region.where, need);
  }
}

void SolidCheck::check_probe_point(ProbePoint& point) {
  if (!point.body) return;
  if (point.body->name == ground) {
    error(point.origin, "the ground has no named points");
  } else {
    check_.resolve(point.body->name, point.point);
  }
}

void SolidCheck::check_along(const Entry<Probe>& probe, const std::optional<Vec3>& along) {
  if (along) check_.check_direction({"record", "probes", probe.name, "along"}, *along);
}

void SolidCheck::check_probe(const Entry<Probe>& entry) {
  const auto potential_along = [&](ProbeQuantity quantity, const std::optional<Vec3>& along) {
    if (quantity == ProbeQuantity::potential && along) {
      check_.error({"record", "probes", entry.name, "along"}, "a potential has no direction");
    }
  };
  if (const auto* distance = std::get_if<DistanceProbe>(&entry.value)) {
    check_along(entry, distance->along);
  } else if (const auto* point = std::get_if<PointProbe>(&entry.value)) {
    check_along(entry, point->along);
    potential_along(point->of, point->along);
    if (point->of != ProbeQuantity::potential) return;
    if (point->point.solid) {
      check_potential(point->point.origin, *point->point.solid);
    } else {
      error(point->point.origin, "a body has no potential");
    }
  } else if (const auto* average = std::get_if<AverageProbe>(&entry.value)) {
    check_along(entry, average->along);
    potential_along(average->of, average->along);
    check_region(average->average, Need::faces);
    if (average->of == ProbeQuantity::potential) check_potential(average->average.where.origin, average->average.solid);
  } else if (const auto* reaction = std::get_if<ReactionProbe>(&entry.value)) {
    check_along(entry, reaction->along);
    check_region(reaction->reaction, Need::nodes);
  } else if (const auto* charge = std::get_if<ChargeProbe>(&entry.value)) {
    const Entry<Solid>* solid = scene_.solids.find(charge->charge.solid.name);
    if (solid == nullptr || solid->value.electrodes.find(charge->charge.name) != nullptr) return;
    error(charge->charge.solid.origin, "solid " + base::in_quotes(solid->name) + " has no electrode " +
                                           base::in_quotes(charge->charge.name) +
                                           base::did_you_mean(charge->charge.name, solid->value.electrodes.names()));
  }
}

void SolidCheck::check_muscle_fields(const Entry<RecordedFields>& entry, const Muscle& muscle, bool electric) {
  if (!is_meshed(muscle)) {
    context_.add(warning_at(entry.origin, "muscle " + base::in_quotes(entry.name) +
                                              " has no mesh, only those of model fe have: none of its fields are "
                                              "recorded"));
  } else if (electric && !muscle.control) {
    error(entry.origin, "muscle " + base::in_quotes(entry.name) + " has no field: no control drives it");
  }
}

void SolidCheck::check_electric() {
  const std::vector<ElectricQuantity>& wanted = scene_.record.electric;
  const auto wrong = [&](const std::string& why) { check_.error({"record", "electric"}, why); };
  const auto failed_any = [&](const auto& family) {
    return std::any_of(family.begin(), family.end(), [&](const auto& entry) { return failed(entry.origin); });
  };
  if (wanted.empty() || failed_any(scene_.muscles) || failed_any(scene_.solids)) return;
  for (auto one = wanted.begin(); one != wanted.end(); ++one) {
    if (std::find(wanted.begin(), one, *one) == one) continue;
    return wrong(base::in_quotes(words(*one)[static_cast<std::size_t>(*one)].word) + " stands twice");
  }
  bool has_source = false;
  bool has_capacitance = false;
  for (const Entry<Muscle>& muscle : scene_.muscles) {
    has_source |= muscle.value.control.has_value();
    has_capacitance |= muscle.value.control && muscle.value.layer_thickness;
  }
  for (const Entry<Solid>& solid : scene_.solids) {
    has_source |= has_field(solid.value);
    has_capacitance |= !solid.value.electrodes.empty();
  }
  if (!has_source) {
    wrong("no muscle has a control and no solid a field: there is nothing to record");
  } else if (!has_capacitance && std::ranges::count(wanted, ElectricQuantity::capacitance) > 0) {
    wrong(
        "nothing has a capacitance: it is that of an electrode of a solid, or of a layer of a muscle with a "
        "control and a layer_thickness");
  }
}

void SolidCheck::record() {
  check_electric();
  for (const Entry<RecordedFields>& entry : scene_.record.fields) {
    if (failed(entry.origin)) continue;
    const bool electric = std::any_of(entry.value.fields.begin(), entry.value.fields.end(), is_electric);
    const Entry<Muscle>* muscle = scene_.muscles.find(entry.name);
    if (scene_.solids.find(entry.name) == nullptr && muscle != nullptr) {
      if (!failed(muscle->origin)) check_muscle_fields(entry, muscle->value, electric);
    } else if (electric) {
      check_potential(entry.origin, {.name = entry.name, .origin = entry.origin});
    }
  }
  for (Entry<Probe>& entry : scene_.record.probes) {
    if (failed(entry.origin)) continue;
    if (auto* distance = std::get_if<DistanceProbe>(&entry.value)) {
      for (ProbePoint& point : distance->distance) check_probe_point(point);
    } else if (auto* point = std::get_if<PointProbe>(&entry.value)) {
      check_probe_point(point->point);
    }
    if (!failed(entry.origin)) check_probe(entry);
  }
}

void SolidCheck::legacy_laws() {
  for (const Entry<Material>& material : scene_.materials) {
    if (!material.value.electric || !std::holds_alternative<Vu>(material.value.electric->law)) continue;
    context_.add(warning_at(check_.origin_of({"materials", material.name, "electric"}),
                            "the law vu only serves to reproduce earlier work, whose constants mean a negative "
                            "permittivity; to predict, take ideal_dielectric"));
  }
}

}  // namespace muldi::scene
