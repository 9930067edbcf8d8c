#pragma once
/// Cross-sections of muscles; a scene names one by `shape`.
#include <numbers>
#include <string_view>
#include <variant>

#include "base/describe.hpp"

namespace muldi::muscles {

struct RoundSection {
  static constexpr std::string_view name = "round";
  static constexpr std::string_view doc = "a disc";

  double diameter = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "diameter",
                      .doc = "diameter of the undeformed section",
                      .unit = base::dimension::length,
                      .range = base::positive},
          self.diameter);
  }

  friend bool operator==(const RoundSection&, const RoundSection&) = default;

  double area() const { return 0.25 * std::numbers::pi * diameter * diameter; }
  /// k = 12 I / A^2, I the second moment of area about a diameter.
  static constexpr double shape_factor() { return 3.0 / std::numbers::pi; }
};

struct SquareSection {
  static constexpr std::string_view name = "square";
  static constexpr std::string_view doc = "a square";

  double edge = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "edge",
                      .doc = "edge length of the undeformed section",
                      .unit = base::dimension::length,
                      .range = base::positive},
          self.edge);
  }

  friend bool operator==(const SquareSection&, const SquareSection&) = default;

  double area() const { return edge * edge; }
  /// k = 12 I / A^2.
  static constexpr double shape_factor() { return 1.0; }
};

using SectionTypes = base::TypeList<RoundSection, SquareSection>;

/// The undeformed section of a muscle.
struct Section {
  base::VariantOf<SectionTypes> shape;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Choice{.key = "shape", .doc = "shape of the undeformed section"}, self.shape);
  }

  friend bool operator==(const Section&, const Section&) = default;

  double area() const {
    return std::visit([](const auto& of) { return of.area(); }, shape);
  }
  /// k = 12 I / A^2 of numerics C9: 1 for a square, 3/pi for a disc; weighs the inertia of the lateral expansion and
  /// the bending stiffness.
  double shape_factor() const {
    return std::visit([](const auto& of) { return of.shape_factor(); }, shape);
  }
};

}  // namespace muldi::muscles
