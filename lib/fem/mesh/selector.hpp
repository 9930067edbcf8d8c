#pragma once
/// What a scene says of where on a mesh something is: faces, nodes or cells, in the mesh's own frame.
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "base/describe.hpp"

namespace muldi::fem {

/// From low to high, both included; an open end has no bound.
struct Interval {
  std::optional<double> low = {};
  std::optional<double> high = {};

  friend bool operator==(const Interval&, const Interval&) = default;
};

/// The boundary faces of this name whose centre lies in the ranges, with all their nodes.
struct SelectFace {
  static constexpr std::string_view name = "face";
  static constexpr std::string_view doc = "faces of this name whose centre lies in the ranges, with all their nodes";
  static constexpr bool named_by_field = true;

  std::string face = {};
  Interval x = {};
  Interval y = {};
  Interval z = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "face", .doc = "name of a face, or of a set of nodes"}, self.face);
    const auto range = [&](std::string_view key, auto& interval) {
      visit(Field{.key = key,
                  .doc = "[low, high] of the faces' centres in the mesh's own frame, ~ for no bound",
                  .unit = dimension::length,
                  .need = optional},
            interval);
    };
    range("x", self.x);
    range("y", self.y);
    range("z", self.z);
  }
  friend bool operator==(const SelectFace&, const SelectFace&) = default;
};

/// The nodes in a box.
struct SelectBox {
  static constexpr std::string_view name = "box";
  static constexpr std::string_view doc = "nodes in a box";
  static constexpr bool named_by_field = true;

  std::array<std::array<std::optional<double>, 3>, 2> box = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "box",
                      .doc = "[[low x, y, z], [high x, y, z]] in the mesh's own frame, ~ for no bound",
                      .unit = base::dimension::length},
          self.box);
  }
  friend bool operator==(const SelectBox&, const SelectBox&) = default;
};

/// One coordinate of a plane, e.g. {z: 1}.
struct PlaneAt {
  std::optional<double> x = {};
  std::optional<double> y = {};
  std::optional<double> z = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "x", .doc = "plane across x", .unit = dimension::length, .need = optional}, self.x);
    visit(Field{.key = "y", .doc = "plane across y", .unit = dimension::length, .need = optional}, self.y);
    visit(Field{.key = "z", .doc = "plane across z", .unit = dimension::length, .need = optional}, self.z);
  }
  friend bool operator==(const PlaneAt&, const PlaneAt&) = default;
};

/// The nodes on a plane across one axis (a line or a point with two or three coordinates).
struct SelectPlane {
  static constexpr std::string_view name = "plane";
  static constexpr std::string_view doc = "nodes on a plane, e.g. {z: 1}";
  static constexpr bool named_by_field = true;

  PlaneAt plane = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "plane", .doc = "plane across an axis in the mesh's own frame; two coordinates: a line"},
          self.plane);
  }
  friend bool operator==(const SelectPlane&, const SelectPlane&) = default;
};

/// The nodes of a set of the mesh's file.
struct SelectSet {
  static constexpr std::string_view name = "set";
  static constexpr std::string_view doc = "nodes of a physical group of the mesh's file";
  static constexpr bool named_by_field = true;

  std::string set = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "set", .doc = "name of a physical group of points, curves or surfaces"}, self.set);
  }
  friend bool operator==(const SelectSet&, const SelectSet&) = default;
};

/// The node at a point.
struct SelectPoint {
  static constexpr std::string_view name = "point";
  static constexpr std::string_view doc = "the node at a point";
  static constexpr bool named_by_field = true;

  base::Vec3 point = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(
        base::Field{
            .key = "point", .doc = "coordinates of a node in the mesh's own frame", .unit = base::dimension::length},
        self.point);
  }
  friend bool operator==(const SelectPoint&, const SelectPoint&) = default;
};

/// The nodes of the cells of a part.
struct SelectPart {
  static constexpr std::string_view name = "part";
  static constexpr std::string_view doc = "a part: its nodes, cells and boundary faces";
  static constexpr bool named_by_field = true;

  std::string part = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "part", .doc = "name of a part"}, self.part);
  }
  friend bool operator==(const SelectPart&, const SelectPart&) = default;
};

/// Everything; in the input the word `all`.
struct SelectAll {
  static constexpr std::string_view name = "all";
  static constexpr std::string_view doc = "the whole solid";

  friend bool operator==(const SelectAll&, const SelectAll&) = default;
};

/// The selectors that are maps in the input.
using SelectorTypes = base::TypeList<SelectFace, SelectBox, SelectPlane, SelectSet, SelectPoint, SelectPart>;

using Selector = std::variant<SelectFace, SelectBox, SelectPlane, SelectSet, SelectPoint, SelectPart, SelectAll>;

}  // namespace muldi::fem
