#pragma once
/// Scenes from text for the tests.
#include <string>
#include <vector>

#include "base/error.hpp"
#include "scene/read_scene.hpp"

namespace muldi::scene {

/// The scene of a text without errors.
inline Scene scene_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return read_scene_text("muldi: 1\n" + text, "test.yaml", overrides);
}

/// All that the reader says of a text with errors; the first line of `text` is line 2.
inline std::string errors_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    scene_of(text, overrides);
  } catch (const base::InputError& error) {
    return error.what();
  }
  return {};
}

/// A body `arm` at the origin with a point `tip`.
inline const std::string arm =
    "bodies: {arm: {mass: 1, inertia: [1, 1, 1], position: [0, 0, 0], points: {tip: [1, 0, 0]}}}\n";

/// A joint `j` of the ground and `arm` with these further fields.
inline std::string joint(const std::string& fields) {
  return arm + "joints: {j: {from: {body: ground, at: [0, 0, 0]}, to: {body: arm, at: tip}, " + fields + "}}\n";
}

}  // namespace muldi::scene
