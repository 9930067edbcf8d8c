#pragma once
/// What is computed and recorded, and how.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/describe.hpp"
#include "scene/bodies.hpp"
#include "scene/entries.hpp"
#include "scene/probes.hpp"

namespace muldi::scene {

enum class Continuation { natural, arc_length };

inline std::span<const base::Word<Continuation>> words(Continuation) {
  static constexpr base::Word<Continuation> all[] = {
      {.word = "natural",
       .value = Continuation::natural,
       .doc = "steps of the control; stops where equilibrium is lost"},
      {.word = "arc_length", .value = Continuation::arc_length, .doc = "steps along the path, past limit points"},
  };
  return all;
}

/// Equilibria along a control from one value to another, or under the controls at t = 0 reached in steps.
struct Statics {
  std::optional<ControlName> control = {};  ///< none: all controls to their values at t = 0
  double from = 0.0;                        ///< these two: in the unit of the control
  std::optional<double> to = {};            ///< given with a control
  int steps = 1;
  Continuation continuation = Continuation::natural;
  base::Dimension unit = {};  ///< of `from` and `to`, from the control of this name

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(
        Field{.key = "control", .doc = "control that is varied; without it all controls as at t = 0", .need = optional},
        self.control);
    visit(Field{.key = "from", .doc = "first value of the control", .unit = self.unit, .need = optional}, self.from);
    visit(Field{.key = "to", .doc = "last value of the control", .unit = self.unit, .need = optional}, self.to);
    visit(Field{.key = "steps", .doc = "number of load steps", .range = {.min = 1.0, .max = 1e6}}, self.steps);
    visit(Field{.key = "continuation", .doc = "how the path is followed", .need = optional}, self.continuation);
  }
  friend bool operator==(const Statics&, const Statics&) = default;
};

enum class Integrator { midpoint, explicit_scheme };

inline std::span<const base::Word<Integrator>> words(Integrator) {
  static constexpr base::Word<Integrator> all[] = {
      {.word = "midpoint", .value = Integrator::midpoint, .doc = "implicit variational integrator of order 2"},
      {.word = "explicit",
       .value = Integrator::explicit_scheme,
       .doc = "explicit integrator of order 2 for solids of plain displacements without viscosity"},
  };
  return all;
}

/// Motion from t = 0.
struct Dynamics {
  double duration = 0.0;
  double step = 0.0;
  Integrator integrator = Integrator::midpoint;

  /// Number of steps; the reader has made sure that the duration is a multiple of the step.
  long n_steps() const;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(Field{.key = "duration",
                .doc = "simulated time, a multiple of the step",
                .unit = dimension::time,
                .range = positive},
          self.duration);
    visit(Field{.key = "step", .doc = "time step", .unit = dimension::time, .range = positive}, self.step);
    visit(Field{.key = "integrator", .doc = "time integrator", .need = Need::optional}, self.integrator);
  }
  friend bool operator==(const Dynamics&, const Dynamics&) = default;
};

/// A point of a body that is recorded, in the input `body.point`.
struct RecordedPoint {
  BodyName body = {};
  BodyPoint point = {};

  friend bool operator==(const RecordedPoint&, const RecordedPoint&) = default;
};

struct Record {
  int every = 1;
  std::vector<RecordedPoint> points = {};
  Named<RecordedFields> fields = {};  ///< by solid
  Named<Probe> probes = {};
  std::vector<ElectricQuantity> electric = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "every",
                .doc = "steps between records; the first and the last state are recorded always",
                .range = {.min = 1.0, .max = 1e9},
                .need = optional},
          self.every);
    visit(Field{.key = "points", .doc = "points of bodies, `body.point`", .need = optional}, self.points);
    visit(Field{.key = "fields",
                .doc = "fields by solid: a list, or {fields, every}; without it no field is recorded",
                .need = optional},
          self.fields);
    visit(Field{.key = "probes", .doc = "numbers and vectors over time by name", .need = optional}, self.probes);
    visit(Field{.key = "electric",
                .doc = "figures of all electrodes and driven muscles beside their charge; without it none is computed",
                .need = optional},
          self.electric);
  }
  friend bool operator==(const Record&, const Record&) = default;
};

enum class LinearSolver {
  automatic,
  dense,
  tree,
  bordered,
  direct,
  iterative,
  ldlt,
  cholmod,
  umfpack,
  cg,
  minres,
  gmres
};

/// True for solvers of solids, which systems of bodies do not know.
constexpr bool is_of_solids(LinearSolver linear) { return linear >= LinearSolver::iterative; }

inline std::span<const base::Word<LinearSolver>> words(LinearSolver) {
  static constexpr base::Word<LinearSolver> all[] = {
      {.word = "auto", .value = LinearSolver::automatic, .doc = "by the size and shape of the system"},
      {.word = "dense", .value = LinearSolver::dense, .doc = "dense matrices in joint coordinates"},
      {.word = "tree", .value = LinearSolver::tree, .doc = "elimination along the kinematic tree"},
      {.word = "bordered",
       .value = LinearSolver::bordered,
       .doc = "the tree with a dense border for loops and far couplings"},
      {.word = "direct", .value = LinearSolver::direct, .doc = "factorised matrices, of solids of any size too"},
      {.word = "iterative", .value = LinearSolver::iterative, .doc = "solids by iteration, whatever their size"},
      {.word = "ldlt", .value = LinearSolver::ldlt, .doc = "solids by a kept multifrontal factor L S L^T"},
      {.word = "cholmod",
       .value = LinearSolver::cholmod,
       .doc = "solids by SuiteSparse's L L^T, or L D L^T where the matrix is not definite"},
      {.word = "umfpack",
       .value = LinearSolver::umfpack,
       .doc = "solids by SuiteSparse's L U with pivoting, slow but hard to fail"},
      {.word = "cg", .value = LinearSolver::cg, .doc = "solids by conjugate gradients, where the matrix is definite"},
      {.word = "minres", .value = LinearSolver::minres, .doc = "solids by MINRES"},
      {.word = "gmres", .value = LinearSolver::gmres, .doc = "solids by flexible GMRES"},
  };
  return all;
}

struct Solver {
  double tolerance = 1e-10;
  int max_iterations = 30;
  LinearSolver linear = LinearSolver::automatic;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "tolerance",
                .doc = "largest Newton increment (rad, or fraction of the scene's size) whose result is accepted",
                .range = {.min = 1e-13, .max = 1e-3},
                .need = optional},
          self.tolerance);
    visit(Field{.key = "max_iterations",
                .doc = "largest number of Newton iterations a step",
                .range = {.min = 1.0, .max = 1e4},
                .need = optional},
          self.max_iterations);
    visit(Field{.key = "linear", .doc = "linear solver", .need = optional}, self.linear);
  }
  friend bool operator==(const Solver&, const Solver&) = default;
};

}  // namespace muldi::scene
