#include "scene/read_scene.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "scene/check_scene.hpp"
#include "scene/input_file.hpp"
#include "scene/overrides.hpp"
#include "scene/read_values.hpp"
#include "scene/yaml.hpp"

namespace muldi::scene {
namespace {

using base::Diagnostic;

/// In the order of the file, overrides last.
void sort_by_place(std::vector<Diagnostic>& diagnostics, const std::string& file) {
  std::stable_sort(diagnostics.begin(), diagnostics.end(), [&](const Diagnostic& a, const Diagnostic& b) {
    const bool a_elsewhere = a.place.file != file;
    const bool b_elsewhere = b.place.file != file;
    if (a_elsewhere != b_elsewhere) return b_elsewhere;
    if (a_elsewhere) return false;
    return a.place.line != b.place.line ? a.place.line < b.place.line : a.place.column < b.place.column;
  });
}

[[noreturn]] void refuse(std::vector<Diagnostic> diagnostics, const std::string& file) {
  sort_by_place(diagnostics, file);
  throw base::InputError(std::move(diagnostics));
}

}  // namespace

Scene read_scene_text(std::string_view text, const std::string& name, const std::vector<std::string>& overrides) {
  std::vector<Diagnostic> syntax;
  std::optional<Node> root = parse_yaml(text, name, 0, syntax);
  if (!root) refuse(std::move(syntax), name);
  if (!root->is_map()) {
    const Diagnostic no_map{.place = {.file = name, .line = root->mark.line, .column = root->mark.column},
                            .message = "needs a map that starts with 'muldi: 1', got " + shown(*root)};
    refuse({no_map}, name);
  }
  std::vector<std::string> sources{name};
  for (const std::string& override : overrides) {
    apply_override(*root, override, static_cast<int>(sources.size()), syntax);
    sources.push_back(override_name(override));
  }

  Scene scene;
  ReadContext context(std::move(sources), scene);
  context.diagnostics() = std::move(syntax);
  scene.origin = {.place = {.file = name, .line = 0, .column = 0}, .path = {}, .anchor_line = 0};
  read_value(context, *root, base::Field{.key = {}, .doc = {}}, scene);
  check_scene(scene, *root, context);

  std::vector<Diagnostic>& found = context.diagnostics();
  const bool wrong =
      std::any_of(found.begin(), found.end(), [](const Diagnostic& d) { return d.severity == base::Severity::error; });
  if (wrong) refuse(std::move(found), name);
  sort_by_place(found, name);
  scene.warnings = std::move(found);
  return scene;
}

Scene read_scene(const std::string& path, const std::vector<std::string>& overrides) {
  const InputFile file = read_input_file(path);
  if (!file.error.empty()) {
    throw base::InputError(
        {Diagnostic{.place = {.file = path, .line = 0, .column = 0}, .message = "cannot read: " + file.error}});
  }
  return read_scene_text(file.text, path, overrides);
}

}  // namespace muldi::scene
