#pragma once
/// One declaration per described aggregate; the YAML reader, the schema, `explain` and the documentation are visitors
/// of it.
///
/// A described type has a static member
///
///     template <class Self, class Visit>
///     static void describe(Self& self, Visit& visit) {
///       visit(base::Field{.key = "mass", .doc = "mass", .unit = base::dimension::mass, .range = base::positive},
///       self.mass);
///     }
///
/// where `Self` is the type or its const. The type of the member says what is read: double (a quantity of dimension
/// `unit`), int, std::string, Vec3, std::optional<T>, std::vector<T>, an enum with a `words()` overload (Word), a
/// described type, or a type for which the visitors have an overload. A member of a component family also has
/// `static constexpr std::string_view name, doc`; a std::variant of the family (VariantOf) is visited with a Choice.
#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

namespace muldi::base {

using Vec3 = std::array<double, 3>;

/// Exponents of the base quantities; angle is a base of its own.
struct Dimension {
  int length = 0;
  int mass = 0;
  int time = 0;
  int current = 0;
  int angle = 0;

  friend constexpr bool operator==(const Dimension&, const Dimension&) = default;
};

constexpr Dimension operator*(Dimension a, Dimension b) {
  return {a.length + b.length, a.mass + b.mass, a.time + b.time, a.current + b.current, a.angle + b.angle};
}
constexpr Dimension operator/(Dimension a, Dimension b) {
  return {a.length - b.length, a.mass - b.mass, a.time - b.time, a.current - b.current, a.angle - b.angle};
}

namespace dimension {
inline constexpr Dimension none{};
inline constexpr Dimension length{.length = 1};
inline constexpr Dimension mass{.mass = 1};
inline constexpr Dimension time{.time = 1};
inline constexpr Dimension current{.current = 1};
inline constexpr Dimension angle{.angle = 1};
inline constexpr Dimension area = length * length;
inline constexpr Dimension volume = area * length;
inline constexpr Dimension density = mass / volume;
inline constexpr Dimension velocity = length / time;
inline constexpr Dimension acceleration = velocity / time;
inline constexpr Dimension angular_velocity = angle / time;
inline constexpr Dimension inertia = mass * area;
inline constexpr Dimension momentum = mass * velocity;
inline constexpr Dimension force = mass * acceleration;
inline constexpr Dimension torque = force * length;  // no angle: N mm is N mm whatever turns
inline constexpr Dimension energy = force * length;
inline constexpr Dimension power = energy / time;
inline constexpr Dimension stress = force / area;
inline constexpr Dimension viscosity = stress * time;
inline constexpr Dimension stiffness = force / length;
inline constexpr Dimension damping = force / velocity;
inline constexpr Dimension rotational_stiffness = torque / angle;
inline constexpr Dimension rotational_damping = torque / angular_velocity;
inline constexpr Dimension charge = current * time;
inline constexpr Dimension voltage = power / current;
inline constexpr Dimension capacitance = charge / voltage;
inline constexpr Dimension field = voltage / length;
inline constexpr Dimension permittivity = charge / (voltage * length);
inline constexpr Dimension frequency = none / time;
}  // namespace dimension

/// Admissible numbers of a field; an open end excludes its value.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false;
  bool max_open = false;
};
inline constexpr Range any{};
inline constexpr Range positive{.min = 0.0, .min_open = true};
inline constexpr Range non_negative{.min = 0.0};

enum class Need { required, optional };

/// `> 0`, `>= 1 and <= 10`; empty for any number.
std::string range_text(const Range& range);

/// What is known of a field beside its C++ type. `optional` fields keep the member's initial value as the default.
struct Field {
  std::string_view key;
  std::string_view doc;
  Dimension unit = dimension::none;
  Range range = any;
  Need need = Need::required;
};

/// What is known of a choice between components: `key` takes the name of one, whose fields stand beside it. Where the
/// choice is optional, the first component of the family is meant without the key.
struct Choice {
  std::string_view key;
  std::string_view doc;
  Need need = Need::required;
};

/// The word in the input for a value of an enum. An enum that is read has an overload, found by its arguments,
/// `std::span<const Word<E>> words(E)` (any value) in the order of the documentation.
template <class Enum>
struct Word {
  std::string_view word;
  Enum value;
  std::string_view doc;
};

/// A component family: its alternatives in the order of registration (registry.hpp of the folder).
template <class... Components>
struct TypeList {
  static constexpr std::size_t size = sizeof...(Components);
  using Variant = std::variant<Components...>;
};

template <class First, class Second>
struct JoinedLists;
template <class... First, class... Second>
struct JoinedLists<TypeList<First...>, TypeList<Second...>> {
  using List = TypeList<First..., Second...>;
};
/// The components of two families, in order.
template <class First, class Second>
using Joined = typename JoinedLists<First, Second>::List;

/// A value of one component of the family.
template <class List>
using VariantOf = typename List::Variant;

/// Calls visit(std::type_identity<Component>{}) for each component of the family in its order.
template <class... Components, class Visit>
constexpr void for_each_type(TypeList<Components...>, Visit visit) {
  (visit(std::type_identity<Components>{}), ...);
}

/// Position of a component in its family; the size of the family if it is none of it.
template <class Component, class... Components>
constexpr std::size_t index_in(TypeList<Components...>) {
  std::size_t index = 0;
  bool found = false;
  ((found = found || std::is_same_v<Component, Components>, index += found ? 0 : 1), ...);
  return index;
}

}  // namespace muldi::base
