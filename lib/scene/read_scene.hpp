#pragma once
/// Scenes from YAML and back.
#include <string>
#include <string_view>
#include <vector>

#include "scene/scene.hpp"

namespace muldi::scene {

/// Reads and checks a scene file. `overrides` are `path.to[2].key=value`, the value YAML, applied before anything is
/// checked. Throws base::InputError with every diagnostic that was found.
Scene read_scene(const std::string& path, const std::vector<std::string>& overrides = {});

/// The same from text; `name` stands for the file in messages and its folder is that of relative paths.
Scene read_scene_text(std::string_view text, const std::string& name, const std::vector<std::string>& overrides = {});

/// The scene with every default written out, in its own units, as YAML that reads back to an equal scene.
std::string resolved_text(const Scene& scene);

/// The JSON Schema (draft-07) of the scene format, from the same descriptions as the reader.
std::string schema_text();

/// One row of the documentation of the format.
struct DocumentedField {
  std::string path;   ///< e.g. `bodies.<name>.mass`
  std::string kind;   ///< e.g. `quantity`, `vector of 3`, `one of scene, from, to`
  std::string unit;   ///< in the default units; empty if none
  std::string range;  ///< e.g. `> 0`; empty if any
  bool required = false;
  std::string doc;
};

/// Every field of the format in the order of its description.
std::vector<DocumentedField> documented_fields();

}  // namespace muldi::scene
