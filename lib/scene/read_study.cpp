#include <algorithm>

#include "base/error.hpp"
#include "scene/input_file.hpp"
#include "scene/read_scene.hpp"
#include "scene/read_values.hpp"
#include "scene/study.hpp"
#include "scene/yaml.hpp"

namespace muldi::scene {

namespace {

constexpr base::Word<StudyVerb> verb_words[] = {
    {.word = "run", .value = StudyVerb::run, .doc = "its statics and dynamics"},
    {.word = "optimise", .value = StudyVerb::optimise, .doc = "its optimal control and the replay"},
};
constexpr base::Word<Design> design_words[] = {
    {.word = "grid", .value = Design::grid, .doc = "all combinations, the last key fastest"},
    {.word = "list", .value = Design::list, .doc = "the first values of all keys, then the second ones, ..."},
    {.word = "lhs", .value = Design::lhs, .doc = "latin hypercube of `samples` points between min and max"},
};

std::string flow_text(const Node& node) {
  if (!node.is_map()) return std::string(base::trimmed(to_yaml(node)));
  return std::string(base::trimmed(to_json(node)));
}

/// `linspace: [a, b, n]`.
bool read_spaced(ReadContext& context, const Node& node, VariedValues& values) {
  if (!node.is_sequence() || node.items.size() != 3) {
    context.error(node.mark, "needs [first, last, number], got " + shown(node));
    return false;
  }
  const base::Field end{.key = {}, .doc = {}};
  const base::Field count{.key = {}, .doc = {}, .range = {.min = 1}};
  bool good = true;
  const auto at = [&](std::size_t i, auto& value, const base::Field& field) {
    const ReadContext::Scope scope(context, i);
    good = read_value(context, node.items[i], field, value) && good;
  };
  at(0, values.from, end);
  at(1, values.to, end);
  at(2, values.count, count);
  return good;
}

bool read_range(ReadContext& context, const Node& node, VariedValues& values) {
  const std::size_t n_errors = context.diagnostics().size();
  FieldReader reader(context, node);
  std::string scale = "linear";
  reader(base::Field{.key = "min", .doc = "smallest value"}, values.from);
  reader(base::Field{.key = "max", .doc = "largest value"}, values.to);
  reader(base::Field{.key = "scale", .doc = "linear or logarithmic", .need = base::Need::optional}, scale);
  reader.finish();
  if (scale != "linear" && scale != "logarithmic") {
    const ReadContext::Scope scope(context, "scale");
    context.error(node.find("scale")->mark, "needs one of linear, logarithmic, got " + base::in_quotes(scale) +
                                                base::did_you_mean(scale, {"linear", "logarithmic"}));
  }
  values.logarithmic = scale == "logarithmic";
  return context.diagnostics().size() == n_errors;
}

bool read_texts(ReadContext& context, const Node& node, VariedValues& values) {
  if (!node.is_sequence() || node.items.empty()) {
    context.error(node.mark, "needs a list of values, got " + shown(node));
    return false;
  }
  for (const Node& item : node.items) values.texts.push_back(flow_text(item));
  return true;
}

bool read_value(ReadContext& context, const Node& node, const base::Field&, VariedValues& values) {
  using Kind = VariedValues::Kind;
  if (!node.is_map()) return read_texts(context, node, values);
  if (node.find("min") != nullptr || node.find("max") != nullptr) {
    values.kind = Kind::range;
    return read_range(context, node, values);
  }
  const std::optional<std::size_t> form = read_component_name(context, node, {"values", "linspace", "logspace"});
  if (!form) return false;
  const std::string key = *form == 0 ? "values" : *form == 1 ? "linspace" : "logspace";
  values.kind = *form == 0 ? Kind::values : *form == 1 ? Kind::linspace : Kind::logspace;
  if (node.entries.size() > 1) {
    for (const MapEntry& entry : node.entries) {
      const ReadContext::Scope scope(context, entry.key);
      if (entry.key != key) context.error(entry.mark, "unknown key beside '" + key + "'");
    }
    return false;
  }
  const ReadContext::Scope scope(context, key);
  return *form == 0 ? read_texts(context, *node.find(key), values) : read_spaced(context, *node.find(key), values);
}

/// A map of free keys that must not be empty: read(key, entry, origin).
template <class Read>
bool read_keys(ReadContext& context, const Node& node, const char* what, const Read& read) {
  if (!node.is_map() || node.entries.empty()) {
    context.error(node.mark, std::string("needs a map of ") + what + ", got " + shown(node));
    return false;
  }
  bool good = true;
  for (const MapEntry& entry : node.entries) {
    const ReadContext::Scope scope(context, entry.key);
    good = read(entry, context.origin(entry.mark)) && good;
  }
  return good;
}

}  // namespace

std::span<const base::Word<StudyVerb>> words(StudyVerb) { return verb_words; }
std::span<const base::Word<Design>> words(Design) { return design_words; }

bool read_value(ReadContext& context, const Node& node, const base::Field& field, VariedKeys& keys) {
  return read_keys(context, node, "keys of the scene", [&](const MapEntry& entry, Origin origin) {
    VariedKey& key = keys.items.emplace_back();
    key.path = entry.key;
    key.origin = std::move(origin);
    return read_value(context, entry.value, field, key.values);
  });
}

bool read_value(ReadContext& context, const Node& node, const base::Field&, SetEntries& entries) {
  return read_keys(context, node, "entries of the scene", [&](const MapEntry& entry, Origin origin) {
    entries.items.push_back({.path = entry.key, .origin = std::move(origin), .text = flow_text(entry.value)});
    return true;
  });
}

bool read_value(ReadContext& context, const Node& node, const base::Field& field, SweepOutputs& outputs) {
  return read_keys(context, node, "outputs", [&](const MapEntry& entry, Origin origin) {
    SweepOutput& output = outputs.items.emplace_back();
    output.name = entry.key;
    output.origin = std::move(origin);
    return check_name(context, entry.mark, entry.key) && read_value(context, entry.value, field, output.expression);
  });
}

bool read_value(ReadContext& context, const Node& node, const base::Field& field, FittedKeys& keys) {
  return read_keys(context, node, "keys of the scene", [&](const MapEntry& entry, Origin origin) {
    FittedKey& key = keys.items.emplace_back();
    key.path = entry.key;
    key.origin = std::move(origin);
    return read_value(context, entry.value, field, key.range);
  });
}

bool read_value(ReadContext& context, const Node& node, const base::Field& field, ComparedKeys& keys) {
  return read_keys(context, node, "data sets", [&](const MapEntry& entry, Origin origin) {
    ComparedKey& key = keys.items.emplace_back();
    key.path = entry.key;
    key.origin = std::move(origin);
    return entry.value.is_null() || read_value(context, entry.value, field, key.comparison);
  });
}

namespace {

void check(ReadContext& context, const Node& root, const SweepStudy& study) {
  const bool lhs = study.design == Design::lhs;
  if (lhs && !study.samples) context.error(root.mark, "missing key 'samples' (of design: lhs)");
  if (!lhs && study.samples) {
    const ReadContext::Scope scope(context, "samples");
    context.error(root.find("samples")->mark, "belongs to design: lhs");
  }
  const ReadContext::Scope scope(context, "vary");
  std::optional<std::size_t> length;
  for (const VariedKey& key : study.vary.items) {
    const bool range = key.values.kind == VariedValues::Kind::range;
    const ReadContext::Scope inner(context, key.path);
    if (context.failed(context.path())) continue;
    if (lhs != range) {
      context.add(error_at(key.origin, lhs ? "needs {min, max}, as every key of design: lhs"
                                           : "{min, max} belongs to design: lhs; give values, linspace or logspace"));
    }
    if (study.design != Design::list || range) continue;
    const std::size_t own = key.values.kind == VariedValues::Kind::values ? key.values.texts.size()
                                                                          : static_cast<std::size_t>(key.values.count);
    if (length && own != *length) {
      context.add(error_at(key.origin, "has " + std::to_string(own) + " values, the keys before " +
                                           std::to_string(*length) + ": design: list needs as many of each"));
    }
    if (!length) length = own;
  }
}

void check(ReadContext& context, const Node&, const CalibrateStudy& study) {
  const bool table = study.reference.ends_with(".csv");
  for (const ComparedKey& key : study.compare.items) {
    const Comparison& said = key.comparison;
    if (table && !said.column) context.add(error_at(key.origin, "missing key 'column': the reference is a CSV file"));
    if (!table && said.column) context.add(error_at(key.origin, "'column' belongs to a CSV reference"));
    if (!table && said.unit) context.add(error_at(key.origin, "'unit' belongs to a CSV reference"));
    if (table && said.data_set) context.add(error_at(key.origin, "'data_set' belongs to a reference in a result file"));
    if (said.unit && !base::parse_unit(*said.unit)) {
      context.add(error_at(key.origin, "no unit " + base::in_quotes(*said.unit)));
    }
  }
}

template <class Study>
Study read_study(const std::string& path, const char* keyword) {
  const InputFile file = read_input_file(path);
  const base::Place place{.file = path, .line = 0, .column = 0};
  if (!file.error.empty()) throw base::InputError({{.place = place, .message = "cannot read: " + file.error}});
  std::vector<base::Diagnostic> syntax;
  const std::optional<Node> root = parse_yaml(file.text, path, 0, syntax);
  if (!root) throw base::InputError(std::move(syntax));
  if (!root->is_map() || root->find(keyword) == nullptr) {
    throw base::InputError({{.place = {.file = path, .line = root->mark.line, .column = root->mark.column},
                             .message = base::format("needs a map that starts with '{}: {}', got {}", keyword,
                                                     study_version, shown(*root))}});
  }
  Scene units;
  ReadContext context({path}, units);
  context.diagnostics() = std::move(syntax);
  Study study;
  study.file = path;
  study.origin = {.place = place, .path = {}, .anchor_line = 0};
  read_value(context, *root, base::Field{.key = {}, .doc = {}}, study);
  check(context, *root, study);
  std::vector<base::Diagnostic>& found = context.diagnostics();
  if (found.empty()) return study;
  std::stable_sort(found.begin(), found.end(), [](const base::Diagnostic& a, const base::Diagnostic& b) {
    return a.place.line != b.place.line ? a.place.line < b.place.line : a.place.column < b.place.column;
  });
  throw base::InputError(std::move(found));
}

}  // namespace

SweepStudy read_sweep_study(const std::string& path) { return read_study<SweepStudy>(path, "sweep"); }
CalibrateStudy read_calibrate_study(const std::string& path) { return read_study<CalibrateStudy>(path, "calibrate"); }

std::string path_of_file(const Origin& study, const std::string& file) {
  const std::string& own = study.place.file;
  const std::size_t slash = own.rfind('/');
  if (file.front() == '/' || slash == std::string::npos) return file;
  return own.substr(0, slash + 1) + file;
}

}  // namespace muldi::scene
