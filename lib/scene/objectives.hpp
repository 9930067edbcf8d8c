#pragma once
/// What optimal control minimises: the family of objectives. A new one is a struct and a place in the list.
#include <optional>
#include <string_view>
#include <tuple>

#include "base/describe.hpp"
#include "scene/end_conditions.hpp"

namespace muldi::scene {

struct FeasibilityObjective {
  static constexpr std::string_view name = "feasibility";
  static constexpr std::string_view doc = "nothing: any motion that fulfils all conditions will do";

  template <class Self, class Visit>
  static void describe(Self&, Visit&) {}
  friend bool operator==(const FeasibilityObjective&, const FeasibilityObjective&) = default;
};

/// scale times the sum over intervals of U^2 in V^2 (over muscles, U = E Z) and of u^2 (other controls).
struct EffortObjective {
  static constexpr std::string_view name = "effort";
  static constexpr std::string_view doc = "squared controls, summed over the intervals";

  double scale = 1.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "scale",
                      .doc = "factor of the sum of U^2 in V^2 over muscles (U field times rest length) and of u^2 of "
                             "other controls",
                      .range = base::positive,
                      .need = base::Need::optional},
          self.scale);
  }
  friend bool operator==(const EffortObjective&, const EffortObjective&) = default;
};

struct RateObjective {
  static constexpr std::string_view name = "rate";
  static constexpr std::string_view doc =
      "squared changes from interval to interval of u over its bound, of fields of their squares over that of the "
      "bound";

  template <class Self, class Visit>
  static void describe(Self&, Visit&) {}
  friend bool operator==(const RateObjective&, const RateObjective&) = default;
};

struct FinalTimeObjective {
  static constexpr std::string_view name = "final_time";
  static constexpr std::string_view doc = "the duration, where it is free";

  template <class Self, class Visit>
  static void describe(Self&, Visit&) {}
  friend bool operator==(const FinalTimeObjective&, const FinalTimeObjective&) = default;
};

struct TrackingObjective {
  static constexpr std::string_view name = "tracking";
  static constexpr std::string_view doc = "squared distance from given motions, integrated over time";

  Named<JointTrajectory> joints = {};
  ByPoint<PointTrajectory> points = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(Field{.key = "joints", .doc = "wanted coordinates by joint: functions of time", .need = Need::optional},
          self.joints);
    visit(Field{.key = "points",
                .doc = "wanted places by `body.point`: three functions of time, ~ where free",
                .unit = dimension::length,
                .need = Need::optional},
          self.points);
  }
  friend bool operator==(const TrackingObjective&, const TrackingObjective&) = default;
};

struct TerminalObjective {
  static constexpr std::string_view name = "terminal";
  static constexpr std::string_view doc = "squared distance from a wanted pose at the end";

  Named<JointPosition> joints = {};
  ByPoint<PartialPoint> points = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(Field{.key = "joints", .doc = "wanted coordinates by joint, ~ where free", .need = Need::optional},
          self.joints);
    visit(Field{.key = "points",
                .doc = "wanted places by `body.point`, ~ where free",
                .unit = dimension::length,
                .need = Need::optional},
          self.points);
  }
  friend bool operator==(const TerminalObjective&, const TerminalObjective&) = default;
};

struct KineticEnergyObjective {
  static constexpr std::string_view name = "kinetic_energy";
  static constexpr std::string_view doc = "kinetic energy at the end";

  template <class Self, class Visit>
  static void describe(Self&, Visit&) {}
  friend bool operator==(const KineticEnergyObjective&, const KineticEnergyObjective&) = default;
};

struct PeakFieldObjective {
  static constexpr std::string_view name = "peak_field";
  static constexpr std::string_view doc = "the square of the largest field of all muscles and intervals";

  template <class Self, class Visit>
  static void describe(Self&, Visit&) {}
  friend bool operator==(const PeakFieldObjective&, const PeakFieldObjective&) = default;
};

using ObjectiveTypes = base::TypeList<FeasibilityObjective, EffortObjective, RateObjective, FinalTimeObjective,
                                      TrackingObjective, TerminalObjective, KineticEnergyObjective, PeakFieldObjective>;

/// An objective with its weight in the sum: in the input the weight alone, or {weight, options}.
template <class Type>
struct Weighted {
  double weight = 1.0;
  Type options = {};

  template <class Self, class Visit>
  static void visit_all(Self& self, Visit& visit) {
    visit(base::Field{.key = "weight",
                      .doc = "factor in the weighted sum",
                      .range = base::non_negative,
                      .need = base::Need::optional},
          self.weight);
    Type::describe(self.options, visit);
  }
  friend bool operator==(const Weighted&, const Weighted&) = default;
};

template <class List>
struct WeightedOf;
template <class... Types>
struct WeightedOf<base::TypeList<Types...>> {
  using Tuple = std::tuple<std::optional<Weighted<Types>>...>;
};

/// A weighted sum of objectives, {name: options}.
struct Objectives {
  WeightedOf<ObjectiveTypes>::Tuple terms = {};

  template <class Type>
  const std::optional<Weighted<Type>>& get() const {
    return std::get<std::optional<Weighted<Type>>>(terms);
  }
  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    base::for_each_type(ObjectiveTypes{}, [&]<class Type>(std::type_identity<Type>) {
      visit(base::Field{.key = Type::name, .doc = Type::doc, .need = base::Need::optional},
            std::get<std::optional<Weighted<Type>>>(self.terms));
    });
  }
  friend bool operator==(const Objectives&, const Objectives&) = default;
};

}  // namespace muldi::scene
