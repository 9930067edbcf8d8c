#include "scene/check_scene.hpp"

#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "scene/check_optimal_control.hpp"
#include "scene/check_solids.hpp"
#include "scene/scene_check.hpp"

namespace muldi::scene {
namespace {

struct FamilyNames {
  const char* what;
  std::vector<std::string> names;
};

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace

Origin SceneCheck::origin_of(Keys keys) const {
  const Node* node = &root_;
  std::string path;
  for (const std::string_view key : keys) {
    path += (path.empty() ? "" : ".") + std::string(key);
    const Node* next = node->find(key);
    if (next == nullptr) break;
    node = next;
  }
  Origin origin = context_.origin(node->mark);
  origin.path = path;
  return origin;
}

void SceneCheck::error(Keys keys, std::string message) { context_.add(error_at(origin_of(keys), std::move(message))); }

const Node* SceneCheck::find(Keys keys) const {
  const Node* node = &root_;
  for (const std::string_view key : keys) {
    node = node->find(key);
    if (node == nullptr) return nullptr;
  }
  return node;
}

bool SceneCheck::failed(Keys keys) const { return context_.failed(base::joined(keys, ".")); }

void SceneCheck::references() {
  const FamilyNames families[] = {{"body", scene_.bodies.names()},
                                  {"joint", scene_.joints.names()},
                                  {"control", scene_.controls.names()},
                                  {"material", scene_.materials.names()},
                                  {"solid", scene_.solids.names()}};
  for (const PendingReference& reference : context_.references()) {
    const FamilyNames& family = families[static_cast<int>(reference.family)];
    if (reference.family == Family::body && reference.name == ground) continue;
    if (std::find(family.names.begin(), family.names.end(), reference.name) != family.names.end()) continue;
    context_.add(error_at(reference.origin, std::string("no ") + family.what + " " + base::in_quotes(reference.name) +
                                                base::did_you_mean(reference.name, family.names)));
  }
}

void SceneCheck::resolve(std::string_view body, BodyPoint& point) {
  if (point.name.empty()) return;
  const Entry<Body>* entry = scene_.bodies.find(body);
  if (entry == nullptr) {
    if (body == ground) {
      context_.add(error_at(point.origin,
                            "the ground has no named points; give coordinates, got " + base::in_quotes(point.name)));
    }
    return;
  }
  if (const Entry<Vec3>* found = entry->value.points.find(point.name)) {
    point.position = found->value;
    return;
  }
  context_.add(error_at(point.origin, "body '" + entry->name + "' has no point " + base::in_quotes(point.name) +
                                          base::did_you_mean(point.name, entry->value.points.names())));
}

void SceneCheck::points() {
  for (Entry<Joint>& joint : scene_.joints) {
    resolve(joint.value.from.body.name, joint.value.from.at);
    resolve(joint.value.to.body.name, joint.value.to.at);
  }
  for (Entry<Muscle>& muscle : scene_.muscles) {
    if (muscle.value.from) resolve(muscle.value.from->body.name, muscle.value.from->at);
    if (muscle.value.to) resolve(muscle.value.to->body.name, muscle.value.to->at);
  }
  for (Entry<Spring>& spring : scene_.springs) {
    resolve(spring.value.from.body.name, spring.value.from.at);
    resolve(spring.value.to.body.name, spring.value.to.at);
  }
  for (Entry<Load>& load : scene_.loads) {
    if (load.value.at && load.value.body.name != ground) resolve(load.value.body.name, *load.value.at);
  }
  for (RecordedPoint& recorded : scene_.record.points) {
    if (recorded.body.name != ground) resolve(recorded.body.name, recorded.point);
  }
}

void SceneCheck::check_two_ends(std::string_view section, std::string_view name, const Attachment& from,
                                const Attachment& to) {
  const bool same = from.body.name == to.body.name && !from.body.name.empty();
  if (!same || failed({section, name, "from", "body"}) || failed({section, name, "to", "body"})) return;
  error({section, name, "to", "body"},
        from.on_ground() ? "both ends are on the ground" : "both ends are on the same body '" + to.body.name + "'");
}

void SceneCheck::check_direction(Keys keys, const Vec3& direction) {
  if (dot(direction, direction) == 0.0 && exists(keys) && !failed(keys)) error(keys, "the vector is zero");
}

void SceneCheck::check_quantity(const ControlName& control, const std::vector<ControlQuantity>& quantities) {
  const Entry<Control>* entry = scene_.controls.find(control.name);
  if (entry == nullptr || failed({"controls", control.name})) return;
  const ControlQuantity got = entry->value.quantity;
  if (std::find(quantities.begin(), quantities.end(), got) != quantities.end()) return;
  std::vector<std::string_view> wanted;
  std::string_view got_word;
  for (const auto& word : words(ControlQuantity{})) {
    if (std::find(quantities.begin(), quantities.end(), word.value) != quantities.end()) wanted.push_back(word.word);
    if (word.value == got) got_word = word.word;
  }
  context_.add(error_at(control.origin, "needs a control of " + base::joined(wanted, " or ") + ", but '" +
                                            control.name + "' is a " + std::string(got_word)));
}

void SceneCheck::joints() {
  for (const Entry<Joint>& entry : scene_.joints) {
    const std::string_view name = entry.name;
    const Joint& joint = entry.value;
    check_two_ends("joints", name, joint.from, joint.to);
    if (failed({"joints", name, "type"})) continue;
    std::visit(
        [&](const auto& type) {
          if constexpr (requires { type.axis; }) check_direction({"joints", name, "axis"}, type.axis);
          if constexpr (requires { type.normal; }) check_direction({"joints", name, "normal"}, type.normal);
          if constexpr (requires { type.axis2; }) {
            check_direction({"joints", name, "axis2"}, type.axis2);
            const double off = std::abs(dot(type.axis, type.axis2)) /
                               std::sqrt(dot(type.axis, type.axis) * dot(type.axis2, type.axis2));
            if (off > 1e-6) {
              error({"joints", name, "axis2"},
                    "must be perpendicular to axis in the scene pose, the cosine is " + base::number_text(off, 3));
            }
          }
        },
        joint.type);
    for (const Drive& drive : joint.force) check_quantity(drive.control, {ControlQuantity::force});
    for (const Drive& drive : joint.torque) check_quantity(drive.control, {ControlQuantity::torque});
  }
}

void SceneCheck::unused_controls() {
  if (!context_.diagnostics().empty()) return;  // a misspelt name or key may have been the use
  for (const Entry<Control>& control : scene_.controls) {
    const auto& references = context_.references();
    const bool used = std::any_of(references.begin(), references.end(), [&](const PendingReference& reference) {
      return reference.family == Family::control && reference.name == control.name;
    });
    if (!used) context_.add(warning_at(control.origin, "nothing uses this control"));
  }
}

void check_scene(Scene& scene, const Node& root, ReadContext& context) {
  SceneCheck check(scene, root, context);
  check.references();
  check.points();
  check.materials();
  check.bodies();
  check.joints();
  check.muscles();
  check.springs();
  check.loads();
  check.initial();
  check.tasks();
  if (scene.optimal_control) OptimalControlCheck(scene, check, context).all();
  SolidCheck solids(scene, check, context);
  solids.solids();
  solids.record();
  check.unused_controls();
  solids.legacy_laws();
}

}  // namespace muldi::scene
