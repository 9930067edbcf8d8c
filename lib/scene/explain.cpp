#include "scene/explain.hpp"

#include <algorithm>
#include <string_view>

#include "base/diagnostic.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "scene/documentation.hpp"
#include "scene/schema.hpp"

namespace muldi::scene {
namespace {

constexpr std::string_view any_name = "<name>";

using Nodes = std::vector<const Node*>;

const Node& schema_root() {
  static const Node tree = schema_tree();
  return tree;
}

std::string text_of(const Node& schema, std::string_view key) {
  const Node* node = schema.find(key);
  return node == nullptr ? std::string() : node->text;
}

/// The forms that a value may take: alternatives and references followed.
void add_forms(const Node& schema, Nodes& forms) {
  if (const Node* reference = schema.find("$ref")) {
    const std::string name = reference->text.substr(reference->text.rfind('/') + 1);
    add_forms(*schema_root().find("definitions")->find(name), forms);
    return;
  }
  const Node* all = schema.find("allOf");
  if (all != nullptr && schema.find("type") == nullptr) {
    for (const Node& part : all->items) add_forms(part, forms);
    return;
  }
  if (const Node* options = schema.find("anyOf")) {
    for (const Node& option : options->items) add_forms(option, forms);
    return;
  }
  forms.push_back(&schema);
}

Nodes forms_of(const Nodes& schemas) {
  Nodes forms;
  for (const Node* schema : schemas) add_forms(*schema, forms);
  return forms;
}

/// The items of lists among the forms, the forms of the items included.
Nodes items_of(const Nodes& forms) {
  Nodes items;
  for (const Node* form : forms) {
    if (const Node* item = form->find("items")) items.push_back(item);
  }
  return forms_of(items);
}

const Node* entry_of(const Node& form) {
  const Node* named = form.find("additionalProperties");
  return named != nullptr && named->is_map() ? named : nullptr;
}

/// One key deeper.
struct Step {
  Nodes found = {};      // schemas of the key
  Nodes objects = {};    // the maps in which it stands
  bool is_name = false;  // the key is the name of an entry
};

Step step_into(const Nodes& forms, const std::string& key) {
  Step step;
  for (const Node* form : forms) {
    const Node* properties = form->find("properties");
    if (const Node* property = properties == nullptr ? nullptr : properties->find(key)) {
      step.found.push_back(property);
      step.objects.push_back(form);
    }
  }
  if (!step.found.empty()) return step;
  for (const Node* form : forms) {
    if (const Node* named = entry_of(*form)) step.found.push_back(named);
  }
  step.is_name = !step.found.empty();
  return step;
}

std::vector<std::string> keys_of(const Nodes& forms) {
  std::vector<std::string> keys;
  for (const Node* form : forms) {
    const Node* properties = form->find("properties");
    if (properties == nullptr) continue;
    for (const MapEntry& property : properties->entries) {
      if (std::find(keys.begin(), keys.end(), property.key) == keys.end()) keys.push_back(property.key);
    }
  }
  return keys;
}

/// `a.b[2].c` as a, b, [], c.
std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  std::string part;
  const auto end_part = [&] {
    if (!part.empty()) parts.push_back(std::exchange(part, {}));
  };
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i] == '.') {
      end_part();
    } else if (path[i] == '[') {
      end_part();
      parts.emplace_back("[]");
      i = std::min(path.find(']', i), path.size());
    } else {
      part += path[i];
    }
  }
  end_part();
  return parts;
}

/// `yes`, `no`, or under which conditions of the maps in which the key stands.
std::string need_of(const Nodes& objects, const std::string& key) {
  std::vector<std::string> conditions;
  for (const Node* object : objects) {
    if (is_required(*object, key)) return "yes";
    const Node* all = object->find("allOf");
    if (all == nullptr) continue;
    for (const Node& rule : all->items) {
      const Node* then = rule.find("then");
      if (then == nullptr || !is_required(*then, key)) continue;
      for (const MapEntry& word : rule.find("if")->find("properties")->entries) {
        conditions.push_back(word.key + ": " + text_of(word.value, "const"));
      }
    }
  }
  return conditions.empty() ? "no" : "with " + base::joined(conditions, ", ");
}

void add_once(std::vector<std::string>& list, const std::string& text) {
  if (!text.empty() && std::find(list.begin(), list.end(), text) == list.end()) list.push_back(text);
}

void add_words(const Node& form, KeyHelp& help) {
  if (const Node* words = form.find("oneOf")) {
    for (const Node& word : words->items) help.words.emplace_back(text_of(word, "const"), text_of(word, "description"));
  }
  if (const Node* words = form.find("enum")) {
    for (const Node& word : words->items) help.words.emplace_back(word.text, "");
  }
}

void add_keys(const Nodes& forms, KeyHelp& help) {
  for (const std::string& key : keys_of(forms)) {
    for (const Node* form : forms) {
      const Node* properties = form->find("properties");
      const Node* property = properties == nullptr ? nullptr : properties->find(key);
      if (property == nullptr) continue;
      help.keys.emplace_back(key, text_of(*property, "description"));
      break;
    }
  }
}

KeyHelp help_of(const Step& step, const std::string& path, const std::string& key) {
  KeyHelp help{.path = path};
  std::vector<std::string> docs, kinds, units, ranges, standards;
  for (const Node* schema : step.found) {
    add_once(docs, text_of(*schema, "description"));
    add_once(kinds, schema->find("type") == nullptr && schema->find("const") != nullptr ? "word" : kind_of(*schema));
    add_once(units, text_of(*schema, "x-unit"));
    add_once(standards, text_of(*schema, "default"));
  }
  const Nodes forms = forms_of(step.found);
  for (const Node* form : forms) {
    add_once(ranges, range_of(*form));
    if (const Node* item = form->find("items")) add_once(ranges, range_of(*item));
    add_words(*form, help);
  }
  if (help.words.empty()) {
    for (const Node* item : items_of(forms)) add_words(*item, help);
  }
  Nodes below = forms;
  for (const Node* form : forms) {
    if (const Node* named = entry_of(*form)) add_forms(*named, below);
  }
  if (keys_of(below).empty()) below = items_of(forms);
  add_keys(below, help);
  help.doc = base::joined(docs, "; or ");
  help.kind = base::joined(kinds, " or ");
  help.unit = base::joined(units, " or ");
  help.range = base::joined(ranges, "; or ");
  help.standard = base::joined(standards, " or ");
  help.need = step.is_name ? "" : need_of(step.objects, key);
  if (step.is_name && help.doc.empty()) help.doc = "an entry; the name is free";
  return help;
}

[[noreturn]] void refuse(const std::string& at, const std::string& key, const Nodes& forms) {
  const std::vector<std::string> known = keys_of(forms);
  const std::string message = known.empty()
                                  ? base::format("has no keys, got {}", base::in_quotes(key))
                                  : base::format("no key {}{}", base::in_quotes(key), base::did_you_mean(key, known));
  throw base::InputError({base::Diagnostic{.path = at.empty() ? "scene" : at, .message = message}});
}

void append_row(std::string& text, std::string_view name, const std::string& value) {
  if (!value.empty()) text += base::format("  {:<8} {}\n", name, value);
}

void append_list(std::string& text, std::string_view heading,
                 const std::vector<std::pair<std::string, std::string>>& rows) {
  if (rows.empty()) return;
  text += base::format("{}\n", heading);
  std::size_t width = 0;
  for (const auto& [word, doc] : rows) width = std::max(width, word.size());
  for (const auto& [word, doc] : rows) {
    text += doc.empty() ? base::format("  {}\n", word) : base::format("  {:<{}}  {}\n", word, width, doc);
  }
}

}  // namespace

KeyHelp look_up(const std::string& path) {
  Step step{.found = {&schema_root()}};
  std::string at;
  std::string last;
  for (const std::string& key : parts_of(path)) {
    Nodes forms = forms_of(step.found);
    if (key == "[]") {
      const Nodes items = items_of(forms);
      if (items.empty()) refuse(at, "[]", {});
      step = {.found = items, .is_name = true};
      at += "[]";
      continue;
    }
    Step next = step_into(forms, key);
    if (next.found.empty() && keys_of(forms).empty()) {
      forms = items_of(forms);
      next = step_into(forms, key);
      if (!next.found.empty()) at += "[]";
    }
    if (next.found.empty()) refuse(at, key, forms);
    step = std::move(next);
    last = key;
    at += (at.empty() ? "" : ".") + (step.is_name ? std::string(any_name) : key);
  }
  if (at.empty()) {
    KeyHelp help{.path = "scene", .doc = "the whole scene", .kind = "map"};
    add_keys(step.found, help);
    return help;
  }
  return help_of(step, at, last);
}

std::optional<KeyHelp> find_key(const std::string& path) {
  try {
    return look_up(path);
  } catch (const base::InputError&) {
    return {};
  }
}

std::string explain(const std::string& path) {
  const KeyHelp help = look_up(path);
  std::string text = help.path + "\n";
  if (!help.doc.empty()) text += base::format("  {}\n", help.doc);
  append_row(text, "kind", help.kind);
  append_row(text, "unit", help.unit.empty() ? "" : help.unit + " for bare numbers; or text with its own unit");
  append_row(text, "range", help.range);
  append_row(text, "default", help.standard);
  append_row(text, "needed", help.need);
  append_list(text, "words", help.words);
  append_list(text, "keys", help.keys);
  return text;
}

}  // namespace muldi::scene
