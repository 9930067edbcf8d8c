// Physics of bodies and materials.
#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "scene/scene_check.hpp"

namespace muldi::scene {
namespace {

/// Why no body has this inertia tensor; empty if one may.
std::string why_no_inertia(const Mat3& j) {
  const double trace = j[0][0] + j[1][1] + j[2][2];
  double largest = 0.0;
  for (const Vec3& row : j) {
    for (const double entry : row) largest = std::max(largest, std::abs(entry));
  }
  const double tolerance = 1e-6 * largest;  // moments are often rounded where they are written
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (std::abs(j[i][k] - j[k][i]) > tolerance) return "the tensor is not symmetric";
    }
  }
  // The Euler tensor trace/2 - J must not be negative: all its principal minors are >= 0.
  Mat3 e{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) e[i][k] = (i == k ? trace / 2 : 0.0) - j[i][k];
  }
  bool good = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = (i + 1) % 3;
    good = good && e[i][i] >= -tolerance;
    good = good && e[i][i] * e[k][k] - e[i][k] * e[k][i] >= -tolerance * largest;
  }
  const double determinant = e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                             e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                             e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
  good = good && determinant >= -tolerance * largest * largest;
  if (good) return {};
  const bool diagonal = j[0][1] == 0.0 && j[0][2] == 0.0 && j[1][2] == 0.0;
  const std::string moments = diagonal ? ", got " + base::number_text(j[0][0], 8) + ", " +
                                             base::number_text(j[1][1], 8) + ", " + base::number_text(j[2][2], 8)
                                       : std::string();
  return "no body has this inertia: no principal moment may exceed the sum of the other two" + moments;
}

}  // namespace

void SceneCheck::materials() {
  for (const Entry<Material>& material : scene_.materials) {
    if (failed({"materials", material.name, "elastic"})) continue;
    const std::string why = material.value.elastic.why_invalid();
    if (!why.empty()) error({"materials", material.name, "elastic"}, why);
  }
}

void SceneCheck::check_body(const Entry<Body>& entry) {
  const std::string_view name = entry.name;
  const Body& body = entry.value;
  if (!failed({"bodies", name, "inertia"})) {
    const std::string why = why_no_inertia(body.inertia.tensor);
    if (!why.empty()) error({"bodies", name, "inertia"}, why);
  }
  if (body.position && body.place) error({"bodies", name, "place"}, "give either position or place, not both");
  if (!body.position && !body.place && !failed({"bodies", name})) {
    error({"bodies", name}, "missing key 'position' or 'place'");
  }
  const Entry<Joint>* joint = body.place ? scene_.joints.find(body.place->joint.name) : nullptr;
  if (joint != nullptr && joint->value.from.body.name != name && joint->value.to.body.name != name &&
      !failed({"joints", joint->name})) {
    context_.add(
        error_at(body.place->joint.origin, "joint '" + joint->name + "' is none of body '" + entry.name + "'"));
  }
}

void SceneCheck::bodies() {
  for (const Entry<Body>& body : scene_.bodies) check_body(body);
}

}  // namespace muldi::scene
