#include "app/drawing.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/log.hpp"
#include "results/result_file.hpp"
#include "scene/read_scene.hpp"

namespace muldi::app {
namespace {

using base::Vec3;
using results::DrawnBody;
using results::DrawnPoint;

// A box is at least and, where no point says more, at most this part of its longest edge.
constexpr double least_thickness = 0.08;
constexpr double most_thickness = 0.35;

DrawnPoint point_of(const scene::Scene& scene, const scene::Attachment& end) {
  return {.body = end.on_ground() ? -1 : scene.bodies.index(end.body.name), .at = end.at.position};
}

/// Edges of the homogeneous box with these moments about its axes.
Vec3 edges_by_inertia(const scene::Body& body) {
  const auto moment = [&](std::size_t i) { return body.inertia.tensor[i][i]; };
  Vec3 edges{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double across = moment((i + 1) % 3) + moment((i + 2) % 3) - moment(i);
    edges[i] = std::sqrt(std::max(0.0, 6.0 * across / body.mass));
  }
  return edges;
}

DrawnBody box_of(const scene::Entry<scene::Body>& entry, const std::vector<Vec3>& points) {
  const Vec3 inertial = edges_by_inertia(entry.value);
  DrawnBody box{.name = entry.name};
  std::array<bool, 3> flat{};
  Vec3 extent{};
  for (std::size_t i = 0; i < 3; ++i) {
    double low = 0.0;
    double high = 0.0;
    for (const Vec3& point : points) {
      low = std::min(low, point[i]);
      high = std::max(high, point[i]);
    }
    // The centre of mass lies inside: points on one side only tell of half the body.
    if (low == 0.0) low = -high;
    if (high == 0.0) high = -low;
    extent[i] = high - low;
    box.centre[i] = 0.5 * (low + high);
    flat[i] = !(extent[i] > 0.0);
  }
  const double longest = *std::max_element(extent.begin(), extent.end());
  const double whole = longest > 0.0 ? longest : *std::max_element(inertial.begin(), inertial.end());
  for (std::size_t i = 0; i < 3; ++i) {
    if (flat[i]) extent[i] = longest > 0.0 ? std::min(inertial[i], most_thickness * whole) : inertial[i];
    box.half[i] = 0.5 * std::max(extent[i], least_thickness * whole);
  }
  return box;
}

double radius_of(const muscles::Section& section) {
  return std::visit([](const auto& shape) { return std::sqrt(shape.area() / std::numbers::pi); }, section.shape);
}

void add_lines(const scene::Scene& scene, results::Drawing& drawing) {
  for (const auto& muscle : scene.muscles) {
    results::DrawnLine line{.folder = "muscles/" + muscle.name, .radius = radius_of(muscle.value.section)};
    if (muscle.value.from && muscle.value.to) {
      line.ends = {point_of(scene, *muscle.value.from), point_of(scene, *muscle.value.to)};
    } else if (muscle.value.axis) {
      const Vec3& axis = *muscle.value.axis;
      const double length = std::hypot(axis[0], axis[1], axis[2]);
      line.isolated = true;
      line.axis = {axis[0] / length, axis[1] / length, axis[2] / length};
    }
    drawing.lines.push_back(line);
  }
  for (const auto& spring : scene.springs) {
    drawing.lines.push_back({.folder = "springs/" + spring.name,
                             .ends = {point_of(scene, spring.value.from), point_of(scene, spring.value.to)}});
  }
}

void add_joints(const scene::Scene& scene, results::Drawing& drawing) {
  for (const auto& joint : scene.joints) {
    const std::string type = std::visit([](const auto& each) { return std::string(each.name); }, joint.value.type);
    // A joint that hangs on the ground is drawn there, any other on its first body.
    drawing.joints.push_back({.name = joint.name, .type = type, .at = point_of(scene, joint.value.from)});
  }
}

}  // namespace

results::Drawing drawing_of(const scene::Scene& scene) {
  results::Drawing drawing;
  add_lines(scene, drawing);
  add_joints(scene, drawing);
  std::vector<std::vector<Vec3>> points(scene.bodies.size());
  const auto add_point = [&](const DrawnPoint& point) {
    if (point.body >= 0) points[static_cast<std::size_t>(point.body)].push_back(point.at);
  };
  for (const results::DrawnLine& line : drawing.lines) {
    for (const DrawnPoint& end : line.ends) add_point(end);
  }
  for (const auto& joint : scene.joints) {
    for (const scene::Attachment* end : {&joint.value.from, &joint.value.to}) add_point(point_of(scene, *end));
  }
  drawing.bodies.reserve(scene.bodies.size());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    for (const auto& named : scene.bodies[i].value.points) points[i].push_back(named.value);
    drawing.bodies.push_back(box_of(scene.bodies[i], points[i]));
  }
  return drawing;
}

results::Drawing drawing_in(const std::string& result_path) {
  const std::string text = results::ResultFile(result_path).text("scene");
  if (text.empty()) return {};
  try {
    return drawing_of(scene::read_scene_text(text, result_path));
  } catch (const base::InputError& error) {
    base::log_warning("bodies and muscles are not drawn, the scene in '" + result_path + "' cannot be read again:\n" +
                      error.what());
    return {};
  }
}

}  // namespace muldi::app
