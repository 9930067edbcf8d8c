#pragma once
/// Values of described components as a scene might give them, from their fields alone.
#include <algorithm>
#include <optional>
#include <random>
#include <type_traits>
#include <variant>

#include "base/describe.hpp"

namespace muldi::test {

/// A visitor of describe() that fills every field; about half of the optional values are left out.
class Plausible {
 public:
  explicit Plausible(unsigned seed) : random_(seed) {}

  template <class T>
  void operator()(const base::Field& field, T& value) {
    fill(field, value);
  }
  template <class... Components>
  void operator()(const base::Choice&, std::variant<Components...>& value) {
    std::size_t left = random_() % sizeof...(Components);
    ((left-- == 0 ? Components::describe(value.template emplace<Components>(), *this) : void()), ...);
  }

 private:
  void fill(const base::Field& field, double& value) {
    value = size_of(field.unit) * std::uniform_real_distribution<double>(0.5, 1.5)(random_);
    value = std::clamp(value, field.range.min, field.range.max);
  }
  template <class T>
  void fill(const base::Field& field, std::optional<T>& value) {
    if (random_() % 2 == 0) return;
    fill(field, value.emplace());
  }
  template <class T>
  requires std::is_enum_v<T>
  void fill(const base::Field&, T& value) {
    const auto all = words(T{});
    value = all[random_() % all.size()].value;
  }
  template <class T>
  requires requires(T& value, Plausible& visit) { T::describe(value, visit); }
  void fill(const base::Field&, T& value) { T::describe(value, *this); }

  /// A usual size in mm, g, ms, A, for elements of 70 to 120 mm that pull with tens of N.
  static double size_of(base::Dimension unit) {
    namespace dimension = base::dimension;
    if (unit == dimension::length) return 60.0;
    if (unit == dimension::area) return 100.0;
    if (unit == dimension::damping) return 0.3;
    if (unit == dimension::stress) return 0.7;
    if (unit == dimension::viscosity || unit == dimension::force) return 10.0;
    if (unit == dimension::density) return 1e-3;
    return 2.0;
  }

  std::mt19937 random_;
};

/// A component with plausible fields, the same for the same seed.
template <class Component>
Component plausible(unsigned seed) {
  Component component;
  Plausible visit(seed);
  Component::describe(component, visit);
  return component;
}

}  // namespace muldi::test
