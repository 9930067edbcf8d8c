#pragma once
/// What makes a joint a joint: its constraints and its free motions, as constexpr tables (numerics, 1.7).
///
/// Two triads e^A, e^B ride on the bodies A (from) and B (to) and coincide in the scene pose; p runs from the connector
/// on A to the connector on B. Every joint is a list of constraint primitives and a list of motion primitives over
/// them; null-space columns, kinematics, coordinates, reactions and springs are generic.
#include <array>
#include <cstddef>
#include <span>

namespace muldi::multibody {

/// One or three scalar constraints.
struct Constraint {
  enum class Kind {
    coincident,     ///< p = 0, three rows e_kA . p = 0
    no_slide,       ///< e_a^A . p = 0
    perpendicular,  ///< e_a^A . e_b^B = 0
  };
  Kind kind = Kind::coincident;
  int a = 0;
  int b = 0;

  constexpr int n_rows() const { return kind == Kind::coincident ? 3 : 1; }
};

/// sign e_a^A . e_b^B
struct TriadProduct {
  int a = 0;
  int b = 0;
  double sign = 0.0;
};

/// One free motion of B relative to A; a ball holds three rotations and is stored as a unit quaternion.
struct Motion {
  enum class Kind {
    slide,       ///< along e_axis^A
    rotation_a,  ///< about e_axis^A
    rotation_b,  ///< about e_axis^B
    ball,        ///< any rotation, rates in the triad of A
  };
  Kind kind = Kind::slide;
  int axis = 0;
  /// The angle of a rotation is atan2(sum sine, sum cosine).
  std::array<TriadProduct, 2> sine{};
  std::array<TriadProduct, 2> cosine{};

  constexpr int n_rates() const { return kind == Kind::ball ? 3 : 1; }
  constexpr int n_coordinates() const { return kind == Kind::ball ? 4 : 1; }
  constexpr bool is_angle() const { return kind == Kind::rotation_a || kind == Kind::rotation_b; }
};

/// Kinematics of a joint type.
struct JointPattern {
  std::span<const Constraint> constraints;
  std::span<const Motion> motions;

  constexpr int n_constraints() const {
    int n = 0;
    for (const Constraint& constraint : constraints) n += constraint.n_rows();
    return n;
  }
  /// Degrees of freedom that the joint leaves (entries of a joint's rate).
  constexpr int n_rates() const {
    int n = 0;
    for (const Motion& motion : motions) n += motion.n_rates();
    return n;
  }
  /// Stored coordinates (a ball needs four for three).
  constexpr int n_coordinates() const {
    int n = 0;
    for (const Motion& motion : motions) n += motion.n_coordinates();
    return n;
  }
};

/// What a joint coordinate measures: a length or an angle (rad).
enum class Coordinate { slide, angle };

/// The kinds of the coordinates that users read, in order.
template <int n>
constexpr std::array<Coordinate, n> coordinate_kinds(const JointPattern& pattern) {
  std::array<Coordinate, n> kinds{};
  std::size_t at = 0;
  for (const Motion& motion : pattern.motions) {
    for (int k = 0; k < motion.n_rates(); ++k) {
      kinds[at++] = motion.kind == Motion::Kind::slide ? Coordinate::slide : Coordinate::angle;
    }
  }
  return kinds;
}

/// Building blocks of the tables.
namespace primitive {
inline constexpr Constraint coincident{Constraint::Kind::coincident, 0, 0};
constexpr Constraint no_slide(int a) { return {Constraint::Kind::no_slide, a, 0}; }
constexpr Constraint perpendicular(int a, int b) { return {Constraint::Kind::perpendicular, a, b}; }

constexpr Motion slide(int axis) { return {.kind = Motion::Kind::slide, .axis = axis}; }
inline constexpr Motion ball{.kind = Motion::Kind::ball};
/// The only rotation of a joint, about e_3: the average of both bodies' views keeps the formula symmetric.
inline constexpr Motion turn{.kind = Motion::Kind::rotation_a,
                             .axis = 2,
                             .sine = {{{1, 0, 1.0}, {0, 1, -1.0}}},
                             .cosine = {{{0, 0, 1.0}, {1, 1, 1.0}}}};
}  // namespace primitive

}  // namespace muldi::multibody
