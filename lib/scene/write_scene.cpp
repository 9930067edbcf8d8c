// Scenes to YAML: the inverse of the reader, from the same descriptions.
#include <algorithm>
#include <utility>

#include "base/text.hpp"
#include "scene/node.hpp"
#include "scene/read_scene.hpp"
#include "scene/time_functions.hpp"

namespace muldi::scene {
namespace {

/// A number as YAML 1.1 and 1.2 readers take it: `1.0e-10`, not `1e-10`, which is text to the former.
Node number(double value) {
  std::string text = base::number_text(value);
  const std::size_t exponent = text.find('e');
  if (exponent != text.npos && text.find('.') == text.npos) text.insert(exponent, ".0");
  return Node::scalar(std::move(text));
}
/// A word that stands bare; words that YAML reads as something else come in quotes.
Node word(std::string_view text) {
  const bool bare = !text.empty() && text != "null" && text != "Null" && text != "NULL" &&
                    std::all_of(text.begin(), text.end(),
                                [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; });
  return Node::scalar(std::string(text), !bare);
}

class FieldWriter;
template <class T>
requires requires(const T& value, FieldWriter& writer) { T::describe(value, writer); }
Node to_node(const T& value);

Node to_node(const Drive& value);
Node to_node(const ProbePoint& value);
Node to_node(const JointPosition& value);
Node to_node(const JointVelocity& value);
Node to_node(const JointRange& value);
Node to_node(const JointTrajectory& value);
Node to_node(const EndMomentum& value);
Node to_node(const HeldControl& value);
Node to_node(const GuessedControl& value);
Node to_node(const Horizon& value);
Node to_node(const Guess& value);
Node to_node(const base::TimeFunction& function);
Node to_node(const Orientation& value);
template <class Type>
Node to_node(const Weighted<Type>& value);
template <class T>
Node to_node(const std::optional<T>& value);
template <class T, std::size_t n>
Node to_node(const std::array<T, n>& values);

Node to_node(double value) { return number(value); }
Node to_node(int value) { return Node::scalar(std::to_string(value)); }
Node to_node(const std::string& value) { return Node::scalar(value, true); }

template <class T, std::size_t n>
Node to_node(const std::array<T, n>& values) {
  Node list = Node::sequence();
  for (const T& value : values) list.items.push_back(to_node(value));
  return list;
}

/// ~ where there is none: in lists.
template <class T>
Node to_node(const std::optional<T>& value) {
  return value ? to_node(*value) : Node();
}

template <class T>
requires std::is_enum_v<T> Node to_node(T value) {
  for (const base::Word<T>& known : words(value)) {
    if (known.value == value) return word(known.word);
  }
  return {};
}

template <Family family>
Node to_node(const Reference<family>& value) {
  return word(value.name);
}

Node to_node(const base::UnitSystem& units) {
  Node map = Node::map();
  return map.with("length", to_node(units.length()))
      .with("mass", to_node(units.mass()))
      .with("time", to_node(units.time()))
      .with("current", to_node(units.current()));
}

Node to_node(const Inertia& value) {
  const Mat3& j = value.tensor;
  const bool principal = j[0][1] == 0 && j[0][2] == 0 && j[1][0] == 0 && j[1][2] == 0 && j[2][0] == 0 && j[2][1] == 0;
  return principal ? to_node(Vec3{j[0][0], j[1][1], j[2][2]}) : to_node(j);
}

Node to_node(const Orientation& value) { return Node::map().with("matrix", to_node(value.matrix)); }

Node to_node(const BodyPoint& value) { return value.name.empty() ? to_node(value.position) : word(value.name); }

Node to_node(const RecordedPoint& value) { return Node::scalar(value.body.name + "." + value.point.name, true); }

Node to_node(const InitialFrom& value) {
  switch (value.kind) {
    case InitialFrom::Kind::scene:
      return word("scene");
    case InitialFrom::Kind::static_equilibrium:
      return word("static_equilibrium");
    case InitialFrom::Kind::record:
      break;
  }
  return Node::scalar(value.file, true);
}

Node to_node(const JointMomentum& value) {
  Node list = Node::sequence();
  for (const double momentum : value.values) list.items.push_back(number(momentum));
  return list;
}

Node to_node(const fem::Interval& value) { return to_node(std::array{value.low, value.high}); }
Node to_node(const Where& value);
Node to_node(const SolidMaterial& value);
Node to_node(const ProbePoint& value) {
  if (value.body) return Node::scalar(value.body->name + "." + value.point.name, true);
  std::vector<std::string> numbers;
  for (const double coordinate : value.at) numbers.push_back(base::number_text(coordinate));
  return Node::scalar(value.solid->name + "@[" + base::joined(numbers) + "]", true);
}
Node to_node(const ElectrodeName& value) { return Node::scalar(value.solid.name + "." + value.name, true); }
template <class... Components>
Node to_node(const std::variant<Components...>& value);

Node to_node(const base::TimeFunction& function);
Node to_node(const Control& value);
Node to_node(const Drive& value);

Node to_node(const std::optional<Stops>& value);

template <class T>
Node section_node(const Named<T>& section) {
  Node map = Node::map();
  for (const Entry<T>& entry : section) map.with(entry.name, to_node(entry.value));
  return map;
}

/// Visitor that appends the fields of a value to a map.
class FieldWriter {
 public:
  explicit FieldWriter(Node& map) : map_(map) {}

  template <class T>
  void operator()(const base::Field& field, const T& value) {
    append(field.key, value);
  }
  template <class T>
  void operator()(const CoordinateField& field, const std::vector<T>& values) {
    append(field.key, values);
  }
  template <class... Components>
  void operator()(const base::Choice& choice, const std::variant<Components...>& value) {
    std::visit(
        [&](const auto& component) {
          map_.with(std::string(choice.key), word(component.name));
          component.describe(component, *this);
        },
        value);
  }

 private:
  template <class T>
  void append(std::string_view key, const T& value) {
    map_.with(std::string(key), to_node(value));
  }
  void append(std::string_view key, const fem::Interval& value) {
    if (value != fem::Interval{}) map_.with(std::string(key), to_node(value));
  }
  void append(std::string_view key, const std::string& value) {
    if (!value.empty()) map_.with(std::string(key), to_node(value));
  }
  template <class T>
  void append(std::string_view key, const std::optional<T>& value) {
    if (value) append(key, *value);
  }
  template <class T>
  void append(std::string_view key, const std::vector<T>& values) {
    if (values.empty()) return;
    Node list = Node::sequence();
    for (const T& value : values) list.items.push_back(to_node(value));
    map_.with(std::string(key), std::move(list));
  }
  template <class T>
  void append(std::string_view key, const Named<T>& section) {
    if (!section.empty()) map_.with(std::string(key), section_node(section));
  }
  template <class T>
  void append(std::string_view key, const ByPoint<T>& values) {
    if (values.empty()) return;
    Node map = Node::map();
    for (const auto& item : values.items) {
      map.with(item.point.body.name + "." + item.point.point.name, to_node(item.value));
    }
    map_.with(std::string(key), std::move(map));
  }
  void append(std::string_view key, const FinalCondition& value) {
    if (value != FinalCondition{}) map_.with(std::string(key), to_node(value));
  }
  void append(std::string_view key, const PathLimits& value) {
    if (value != PathLimits{}) map_.with(std::string(key), to_node(value));
  }

  Node& map_;
};

template <class T>
requires requires(const T& value, FieldWriter& writer) { T::describe(value, writer); }
Node to_node(const T& value) {
  Node map = Node::map();
  FieldWriter writer(map);
  T::describe(value, writer);
  return map;
}

Node to_node(const std::optional<Stops>& value) {
  if (!value) return {};
  Node map = Node::map();
  FieldWriter writer(map);
  describe_stops(Coordinate::slide, *value, writer);
  return map;
}

template <class... Components>
Node to_node(const std::variant<Components...>& value) {
  return std::visit(
      [](const auto& component) {
        if constexpr (requires { component.named_by_field; }) return to_node(component);
        return Node::map().with(std::string(component.name), to_node(component));
      },
      value);
}

Node to_node(const Where& value) {
  if (std::holds_alternative<fem::SelectAll>(value.selector)) return word(fem::SelectAll::name);
  const auto* face = std::get_if<fem::SelectFace>(&value.selector);
  if (face != nullptr && *face == fem::SelectFace{.face = face->face} && face->face != fem::SelectAll::name) {
    return word(face->face);
  }
  return std::visit(
      [](const auto& selector) {
        if constexpr (requires { selector.named_by_field; }) return to_node(selector);
        return Node();
      },
      value.selector);
}

Node to_node(const SolidMaterial& value) {
  if (value.parts.empty()) return to_node(value.whole);
  Node map = Node::map();
  for (const Entry<MaterialName>& part : value.parts) map.with(part.name, to_node(part.value));
  return map;
}

/// One value stands alone where the reader takes it for a list otherwise.
template <class T>
Node coordinates_node(const std::vector<std::optional<T>>& values) {
  if (values.size() == 1) return to_node(values.front());
  Node list = Node::sequence();
  for (const std::optional<T>& value : values) list.items.push_back(to_node(value));
  return list;
}
Node to_node(const JointPosition& value) { return coordinates_node(value.values); }
Node to_node(const JointVelocity& value) { return coordinates_node(value.values); }
Node to_node(const JointRange& value) { return coordinates_node(value.values); }
Node to_node(const JointTrajectory& value) { return coordinates_node(value.values); }

Node to_node(const EndMomentum& value) {
  if (value.kind == EndMomentum::Kind::given) return section_node(value.joints);
  return word(value.kind == EndMomentum::Kind::rest ? "rest" : "free");
}
Node to_node(const HeldControl& value) { return number(value.value); }
Node to_node(const GuessedControl& value) { return to_node(value.value); }
Node to_node(const Horizon& value) {
  if (!value.is_free()) return number(value.min);
  return Node::map().with("min", number(value.min)).with("max", number(value.max));
}
Node to_node(const Guess& value) {
  switch (value.kind) {
    case Guess::Kind::zero:
      return word("zero");
    case Guess::Kind::scene:
      return word("scene");
    case Guess::Kind::straight:
      return word("straight");
    case Guess::Kind::simulate:
      return Node::map().with("simulate", section_node(value.simulate));
    case Guess::Kind::record:
      return Node::map().with("from", Node::scalar(value.file, true));
    case Guess::Kind::random:
      break;
  }
  return Node::map().with("random", to_node(value.random));
}
template <class Type>
Node to_node(const Weighted<Type>& value) {
  Node map = Node::map();
  FieldWriter writer(map);
  Weighted<Type>::visit_all(value, writer);
  return map;
}

struct FunctionWriter {
  Node operator()(double constant) const { return number(constant); }
  Node operator()(const base::Samples& samples) const {
    Node rows = Node::sequence();
    for (std::size_t i = 0; i < samples.times.size(); ++i) {
      rows.items.push_back(Node::sequence({number(samples.times[i]), number(samples.values[i])}));
    }
    return Node::map().with(samples.between == base::Samples::Between::held ? "steps" : "table", std::move(rows));
  }
  Node operator()(const base::Ramp& ramp) const {
    Node map = Node::map();
    FieldWriter writer(map);
    describe_ramp(base::dimension::none, ramp, writer);
    return Node::map().with("ramp", std::move(map));
  }
  Node operator()(const base::Sine& sine) const {
    Node map = Node::map();
    FieldWriter writer(map);
    describe_sine(base::dimension::none, sine, writer);
    return Node::map().with("sine", std::move(map));
  }
  Node operator()(const base::Expression& expression) const {
    return Node::map().with("expression", Node::scalar(expression.text(), true));
  }
};

Node to_node(const base::TimeFunction& function) { return std::visit(FunctionWriter{}, function.kind()); }

Node to_node(const Control& value) { return Node::map().with(to_node(value.quantity).text, to_node(value.value)); }

Node to_node(const Drive& value) {
  if (value.control.name.empty()) return to_node(value.value);
  return Node::map().with("control", to_node(value.control));
}

}  // namespace

std::string resolved_text(const Scene& scene) { return to_yaml(to_node(scene)); }

}  // namespace muldi::scene
