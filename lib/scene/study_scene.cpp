// The scene of a study: points by overrides, keys with `*`, its text with entries replaced.
#include <algorithm>

#include "base/error.hpp"
#include "base/text.hpp"
#include "scene/input_file.hpp"
#include "scene/key_path.hpp"
#include "scene/overrides.hpp"
#include "scene/read_scene.hpp"
#include "scene/study.hpp"
#include "scene/yaml.hpp"

namespace muldi::scene {
namespace {

/// Byte of the text at which a mark stands; npos if the text is shorter.
std::size_t offset_of(const std::string& text, const Mark& mark) {
  std::size_t at = 0;
  for (int line = 1; line < mark.line; ++line) {
    at = text.find('\n', at);
    if (at == std::string::npos) return at;
    ++at;
  }
  return at + static_cast<std::size_t>(std::max(mark.column - 1, 0));
}

/// A scalar as it stands in the text: its place and length.
struct Written {
  std::size_t first = std::string::npos;
  std::size_t size = 0;
};

/// Where a scalar stands; nothing if it came through an alias, is missing, or spreads over lines.
std::optional<Written> written(const std::string& text, const Node* node) {
  if (node == nullptr || !node->is_scalar() || node->mark.anchor_line > 0) return {};
  const std::size_t first = offset_of(text, node->mark);
  if (first >= text.size()) return {};
  if (!node->quoted) {
    if (text.compare(first, node->text.size(), node->text) != 0) return {};
    return Written{.first = first, .size = node->text.size()};
  }
  if (text.compare(first + 1, node->text.size(), node->text) != 0) return {};
  return Written{.first = first, .size = node->text.size() + 2};
}

}  // namespace

SceneText::SceneText(const std::string& path, std::vector<std::string> overrides)
    : path_(path), overrides_(std::move(overrides)) {
  InputFile file = read_input_file(path);
  if (!file.error.empty()) {
    throw base::InputError(
        {base::Diagnostic{.place = {.file = path, .line = 0, .column = 0}, .message = "cannot read: " + file.error}});
  }
  text_ = std::move(file.text);
  static_cast<void>(read({}));
  std::vector<base::Diagnostic> none;
  root_ = *parse_yaml(text_, path_, 0, none);
  for (const std::string& override : overrides_) apply_override(root_, override, 1, none);
}

Scene SceneText::read(const std::vector<std::string>& overrides) const {
  std::vector<std::string> all = overrides_;
  all.insert(all.end(), overrides.begin(), overrides.end());
  return read_scene_text(text_, path_, all);
}

std::vector<std::string> SceneText::keys(const std::string& path, const Origin& origin,
                                         std::vector<base::Diagnostic>& errors) const {
  const auto steps = parse_key_path(path);
  if (!steps) {
    errors.push_back(error_at(origin, "no key of a scene: needs a path such as controls.agonist.field"));
    return {};
  }
  std::vector<std::string> found{""};
  for (std::size_t i = 0; i < steps->size(); ++i) {
    const KeyStep& step = (*steps)[i];
    const std::string_view noun = i == 1 ? noun_of((*steps)[0].key) : std::string_view();
    std::vector<std::string> next;
    for (const std::string& before : found) {
      const Node* parent = before.empty() ? &root_ : node_at(root_, before);
      const std::string stem = before.empty() ? "" : before + ".";
      if (step.is_index) {
        next.push_back(before + "[" + std::to_string(step.index) + "]");
      } else if (step.key == "*") {
        if (parent == nullptr || parent->entries.empty()) continue;
        for (const MapEntry& entry : parent->entries) next.push_back(stem + entry.key);
      } else if (!noun.empty() && (parent == nullptr || parent->find(step.key) == nullptr)) {
        const std::vector<std::string> names = parent == nullptr ? std::vector<std::string>() : names_in(*parent);
        errors.push_back(error_at(
            origin, base::format("the scene has no {} '{}'{}", noun, step.key, base::did_you_mean(step.key, names))));
        return {};
      } else {
        next.push_back(stem + step.key);
      }
    }
    found = std::move(next);
  }
  if (found.empty()) errors.push_back(error_at(origin, "'*' stands for nothing in this scene"));
  return found;
}

std::string SceneText::replaced(const std::vector<std::string>& overrides, const std::string& heading) const {
  const Scene wanted = read(overrides);
  std::vector<base::Diagnostic> none;
  Node root = *parse_yaml(text_, path_, 0, none);
  std::vector<std::pair<Written, std::string>> edits;
  std::vector<std::string> all = overrides_;
  all.insert(all.end(), overrides.begin(), overrides.end());
  for (const std::string& override : all) {
    const std::size_t equals = override.find('=');
    const std::optional<Written> place = written(text_, node_at(root, std::string_view(override).substr(0, equals)));
    if (place) edits.emplace_back(*place, override.substr(equals + 1));
  }
  std::stable_sort(edits.begin(), edits.end(),
                   [](const auto& a, const auto& b) { return a.first.first > b.first.first; });
  std::string text = text_;
  for (std::size_t i = 0; i < edits.size(); ++i) {
    if (i > 0 && edits[i].first.first == edits[i - 1].first.first) continue;
    text.replace(edits[i].first.first, edits[i].first.size, edits[i].second);
  }
  // The modeline of editors stays first.
  const std::size_t first = text.starts_with("# yaml-language-server") ? text.find('\n') + 1 : 0;
  try {
    if (read_scene_text(text, path_) == wanted) return text.insert(first, heading);
  } catch (const base::InputError&) {  // the edit has spoilt the text: the tree is written instead
  }
  Node tree = root_;
  for (const std::string& override : overrides) apply_override(tree, override, 1, none);
  return heading + "# Keys that stand in no line of their own were set: comments and anchors are gone.\n" +
         to_yaml(tree);
}

SceneText scene_of_study(const Origin& study, const std::string& scene, const SetEntries& set,
                         const std::vector<std::string>& overrides) {
  const std::string path = path_of_file(study, scene);
  const SceneText plain(path, {});
  std::vector<base::Diagnostic> errors;
  std::vector<std::string> all;
  std::vector<const SetEntry*> sources;
  for (const SetEntry& entry : set.items) {
    for (const std::string& key : plain.keys(entry.path, entry.origin, errors)) {
      all.push_back(base::format("{}={}", key, entry.text));
      sources.push_back(&entry);
    }
  }
  if (!errors.empty()) throw base::InputError(std::move(errors));
  all.insert(all.end(), overrides.begin(), overrides.end());
  try {
    return SceneText(path, all);
  } catch (const base::InputError& error) {
    errors = error.diagnostics();
  }
  for (base::Diagnostic& found : errors) {
    for (std::size_t i = 0; i < sources.size(); ++i) {
      if (found.place.file != override_name(all[i])) continue;
      found = error_at(sources[i]->origin, (found.path.empty() ? "" : found.path + ": ") + found.message);
      break;
    }
  }
  throw base::InputError(std::move(errors));
}

std::optional<double> number_at(const Node& resolved, const std::string& path) {
  const Node* node = node_at(resolved, path);
  // Values by coordinate of a joint, of which there may be one.
  if (node != nullptr && node->is_sequence() && node->items.size() == 1) node = &node->items.front();
  if (node == nullptr || !node->is_scalar() || node->quoted) return {};
  return base::parse_number(node->text);
}

Node resolved_tree(const Scene& scene) {
  std::vector<base::Diagnostic> none;
  return parse_yaml(resolved_text(scene), "resolved scene", 0, none).value_or(Node());
}

std::optional<double> number_at(const Scene& scene, const std::string& path) {
  return number_at(resolved_tree(scene), path);
}

}  // namespace muldi::scene
