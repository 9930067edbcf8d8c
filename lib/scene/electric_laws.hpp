#pragma once
/// Electric laws of materials. All numbers in the scene's units.
#include <optional>
#include <string_view>

#include "base/describe.hpp"

namespace muldi::scene {

/// -1/2 eps0 eps_r J E.C^-1.E (numerics.md 1.2 `ideal`).
struct IdealDielectric {
  static constexpr std::string_view name = "ideal_dielectric";
  static constexpr std::string_view doc = "constant permittivity in the deformed material";

  double relative_permittivity = 1.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Field{.key = "relative_permittivity",
                      .doc = "permittivity as a multiple of that of vacuum",
                      .range = {.min = 1.0}},
          self.relative_permittivity);
  }
  friend bool operator==(const IdealDielectric&, const IdealDielectric&) = default;
};

/// c1 E.E + c2 E.C.E - 1/2 eps0 J E.C^-1.E: the law of thesis chapters 4 and 5 (numerics.md 1.2 `vu`).
struct Vu {
  static constexpr std::string_view name = "vu";
  static constexpr std::string_view doc =
      "law of earlier work, kept to reproduce it: energy c1 E.E + c2 E.C.E - eps0/2 J E.C^-1.E";

  double c1 = 0.0;
  double c2 = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(Field{.key = "c1", .doc = "factor of E.E", .unit = dimension::permittivity}, self.c1);
    visit(Field{.key = "c2", .doc = "factor of E.C.E", .unit = dimension::permittivity}, self.c2);
  }
  friend bool operator==(const Vu&, const Vu&) = default;
};

/// c1 I3 + c2 I4 + c3 I5 - 1/2 eps0 J I4 with I3 = E.E, I4 = E.C^-1.E, I5 = E.C^-2.E: permittivity that depends on the
/// stretch (thesis 7.1.2, numerics.md 1.2 `I-law` and 1.10).
struct Invariants {
  static constexpr std::string_view name = "invariants";
  static constexpr std::string_view doc =
      "stretch-dependent permittivity: energy c1 E.E + c2 E.C^-1.E + c3 E.C^-2.E - eps0/2 J E.C^-1.E";

  double c1 = 0.0;
  double c2 = 0.0;
  double c3 = 0.0;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(Field{.key = "c1", .doc = "factor of E.E (-eps0/2 times the fit's c1)", .unit = dimension::permittivity},
          self.c1);
    visit(Field{.key = "c2", .doc = "factor of E.C^-1.E (-eps0/2 times the fit's c2)", .unit = dimension::permittivity},
          self.c2);
    visit(Field{.key = "c3", .doc = "factor of E.C^-2.E (+eps0/2 times the fit's c3)", .unit = dimension::permittivity},
          self.c3);
  }
  friend bool operator==(const Invariants&, const Invariants&) = default;
};

using ElectricLaws = base::TypeList<IdealDielectric, Vu, Invariants>;

struct Electric {
  base::VariantOf<ElectricLaws> law = {};
  std::optional<double> breakdown_field = {};  ///< none: nothing is checked

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    visit(base::Choice{.key = "model", .doc = "electric law"}, self.law);
    visit(
        base::Field{.key = "breakdown_field",
                    .doc = "dielectric strength: a run ends with `breakdown` where the field in the deformed material "
                           "(that of lumped muscles, at every Gauss point of finite elements) exceeds it; without it "
                           "nothing is checked",
                    .unit = base::dimension::field,
                    .range = base::positive,
                    .need = base::Need::optional},
        self.breakdown_field);
  }
  friend bool operator==(const Electric&, const Electric&) = default;
};

}  // namespace muldi::scene
