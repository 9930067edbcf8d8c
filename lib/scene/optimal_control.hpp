#pragma once
/// The `optimal_control:` section: horizon, bounds, conditions, guess, stages, replay.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/describe.hpp"
#include "base/time_function.hpp"
#include "scene/end_conditions.hpp"
#include "scene/entries.hpp"
#include "scene/muscles.hpp"
#include "scene/objectives.hpp"

namespace muldi::scene {

/// Length of the horizon. In the input a time, or {min, max} where it is free.
struct Horizon {
  double min = 0.0;
  double max = 0.0;

  bool is_free() const { return min < max; }

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(Field{.key = "min", .doc = "shortest duration", .unit = dimension::time, .range = positive}, self.min);
    visit(Field{.key = "max", .doc = "longest duration", .unit = dimension::time, .range = positive}, self.max);
  }
  friend bool operator==(const Horizon&, const Horizon&) = default;
};

/// Bounds of a control that is sought, in its unit; none where not given.
struct ControlBounds {
  std::optional<double> min = {};
  std::optional<double> max = {};
  base::Dimension unit = {};  ///< from the control of this name

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "min",
                .doc = "lowest value; 0 for fields and voltages of muscles",
                .unit = self.unit,
                .need = optional},
          self.min);
    visit(Field{.key = "max", .doc = "highest value", .unit = self.unit, .need = optional}, self.max);
  }
  friend bool operator==(const ControlBounds&, const ControlBounds&) = default;
};

/// What must hold at every node.
struct PathLimits {
  Named<JointRange> joints = {};
  ByPoint<PointBox> points = {};
  std::optional<double> true_field = {};
  std::optional<double> pull_in_margin = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "joints", .doc = "[low, high] of joint coordinates by joint", .need = optional}, self.joints);
    visit(Field{.key = "points",
                .doc = "boxes by `body.point`: lowest and highest corner, ~ where there is no bound",
                .unit = dimension::length,
                .need = optional},
          self.points);
    visit(Field{.key = "true_field",
                .doc = "largest field in the deformed muscles (breakdown)",
                .unit = dimension::field,
                .range = positive,
                .need = optional},
          self.true_field);
    visit(Field{.key = "pull_in_margin",
                .doc = "smallest axial stiffness of the charged muscles, as a fraction of that of the uncharged ones "
                       "at their reference length; pull-in is at 0",
                .range = {.min = 0.0, .max = 1.0, .max_open = true},
                .need = optional},
          self.pull_in_margin);
  }
  friend bool operator==(const PathLimits&, const PathLimits&) = default;
};

/// A function of time that a control follows in the simulation of a guess.
struct GuessedControl {
  base::TimeFunction value = {};
  base::Dimension unit = {};  ///< from the control of this name

  friend bool operator==(const GuessedControl&, const GuessedControl&) = default;
};

/// Motions under random admissible controls: the solution of lowest objective is taken.
struct RandomGuesses {
  int starts = 1;
  int seed = 1;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(Field{.key = "starts", .doc = "how many guesses", .range = {.min = 1.0, .max = 1e4}}, self.starts);
    visit(
        Field{.key = "seed", .doc = "of the random numbers", .range = {.min = 0.0, .max = 2e9}, .need = Need::optional},
        self.seed);
  }
  friend bool operator==(const RandomGuesses&, const RandomGuesses&) = default;
};

/// Where the first stage starts. In the input zero, scene, straight, {simulate: ...}, {from: earlier.h5} or {random:
/// ...}.
struct Guess {
  enum class Kind { zero, scene, straight, simulate, record, random };

  Kind kind = Kind::scene;
  Named<GuessedControl> simulate = {};
  std::string file = {};  ///< of a record, as written; path_of_file() finds it
  RandomGuesses random = {};
  Origin origin = {};

  friend bool operator==(const Guess&, const Guess&) = default;
};

/// One optimisation.
struct Stage {
  Objectives minimise = {};
  int max_iterations = 1000;
  double tolerance = 1e-8;
  Origin origin = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "minimise", .doc = "objectives by name: a weight, or {weight, options}"}, self.minimise);
    visit(Field{.key = "max_iterations",
                .doc = "iterations after which the stage ends unfinished",
                .range = {.min = 1.0, .max = 1e6},
                .need = optional},
          self.max_iterations);
    visit(Field{.key = "tolerance",
                .doc = "of the scaled optimality conditions",
                .range = {.min = 1e-13, .max = 1e-2},
                .need = optional},
          self.tolerance);
  }
  friend bool operator==(const Stage&, const Stage&) = default;
};

enum class ReplayInterpolation { steps, linear };

inline std::span<const base::Word<ReplayInterpolation>> words(ReplayInterpolation) {
  static constexpr base::Word<ReplayInterpolation> all[] = {
      {.word = "steps", .value = ReplayInterpolation::steps, .doc = "each value is held over its interval"},
      {.word = "linear",
       .value = ReplayInterpolation::linear,
       .doc = "straight lines between the values at the middles of the intervals"},
  };
  return all;
}

/// What follows after the horizon of a replay.
struct ReplayContinuation {
  double duration = 0.0;
  Named<HeldControl> controls = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    visit(Field{.key = "duration", .doc = "time beyond the horizon", .unit = dimension::time, .range = positive},
          self.duration);
    visit(Field{.key = "controls",
                .doc = "values at which the controls are held; those not named keep their last value",
                .need = Need::optional},
          self.controls);
  }
  friend bool operator==(const ReplayContinuation&, const ReplayContinuation&) = default;
};

/// The controls that were found, applied in a forward run.
struct Replay {
  std::optional<double> step = {};          ///< none: that of the optimal control
  std::optional<MuscleModel> muscles = {};  ///< none: as in the scene
  ReplayInterpolation interpolation = ReplayInterpolation::steps;
  std::optional<ReplayContinuation> then = {};

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "step",
                .doc = "time step, a whole fraction of that of the optimal control, which is the default",
                .unit = dimension::time,
                .range = positive,
                .need = optional},
          self.step);
    visit(Field{.key = "muscles", .doc = "model of all muscles; default as in the scene", .need = optional},
          self.muscles);
    visit(Field{.key = "interpolation", .doc = "controls between their values", .need = optional}, self.interpolation);
    visit(Field{.key = "then", .doc = "what follows after the horizon", .need = optional}, self.then);
  }
  friend bool operator==(const Replay&, const Replay&) = default;
};

/// Controls that move the system from one state to another.
struct OptimalControl {
  Horizon duration = {};
  std::optional<double> step = {};  ///< exactly one of step and steps; steps where the duration is free
  std::optional<int> steps = {};
  Named<ControlBounds> controls = {};
  EndCondition initial = {};
  FinalCondition final = {};
  PathLimits limits = {};
  Guess guess = {};
  std::vector<Stage> stages = {};
  std::optional<Replay> replay = {};
  Origin origin = {};

  /// Number of intervals; the reader has made sure that the duration is a multiple of the step.
  int n_steps() const;

  template <class Self, class Visit>
  static void describe(Self& self, Visit& visit) {
    using namespace base;
    constexpr auto optional = Need::optional;
    visit(Field{.key = "duration",
                .doc = "length of the horizon, a multiple of the step; {min, max} where it is free",
                .unit = dimension::time,
                .range = positive},
          self.duration);
    visit(Field{.key = "step", .doc = "time step", .unit = dimension::time, .range = positive, .need = optional},
          self.step);
    visit(Field{.key = "steps",
                .doc = "number of steps, instead of the step",
                .range = {.min = 1.0, .max = 1e6},
                .need = optional},
          self.steps);
    visit(Field{.key = "controls", .doc = "bounds {min, max} of the controls that are sought, by name"}, self.controls);
    visit(Field{.key = "initial", .doc = "what holds at t = 0"}, self.initial);
    visit(Field{.key = "final", .doc = "what holds at the end; default nothing", .need = optional}, self.final);
    visit(Field{.key = "limits", .doc = "what holds at every node", .need = optional}, self.limits);
    visit(Field{.key = "guess",
                .doc = "where the first stage starts: zero, scene, straight, {simulate: controls}, {from: earlier.h5} "
                       "or {random: "
                       "{starts, seed}}",
                .need = optional},
          self.guess);
    visit(Field{.key = "stages", .doc = "optimisations in turn, each from the one before"}, self.stages);
    visit(Field{.key = "replay", .doc = "forward run under the controls that were found", .need = optional},
          self.replay);
  }
  friend bool operator==(const OptimalControl&, const OptimalControl&) = default;
};

}  // namespace muldi::scene
