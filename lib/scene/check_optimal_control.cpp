#include "scene/check_optimal_control.hpp"

#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "scene/multiples.hpp"

namespace muldi::scene {
namespace {

constexpr std::string_view section = "optimal_control";
constexpr double most_steps = 2e9;

bool drives_muscles(ControlQuantity quantity) {
  return quantity == ControlQuantity::field || quantity == ControlQuantity::layer_voltage ||
         quantity == ControlQuantity::total_voltage;
}

std::string shown(double value) { return base::number_text(value, 12); }

bool within(double value, const Bounds& bounds) {
  return (!bounds[0] || value >= *bounds[0]) && (!bounds[1] || value <= *bounds[1]);
}

std::string range_of(const Bounds& bounds) {
  return "[" + (bounds[0] ? shown(*bounds[0]) : "~") + ", " + (bounds[1] ? shown(*bounds[1]) : "~") + "]";
}

}  // namespace

void OptimalControlCheck::error(Keys keys, std::string message) {
  const std::string path = std::string(section) + "." + base::joined(keys, ".");
  if (context_.failed(path)) return;
  const Node* node = check_.root_.find(section);
  for (const std::string_view key : keys) {
    const Node* next = node->find(key);
    if (next == nullptr) break;
    node = next;
  }
  Origin origin = context_.origin(node->mark);
  origin.path = path;
  context_.add(error_at(origin, std::move(message)));
}

bool OptimalControlCheck::failed(const std::string& below) const {
  return context_.failed(std::string(section) + "." + below);
}

void OptimalControlCheck::all() {
  if (!check_.find({section})->is_map()) return;
  parts();
  horizon();
  controls();
  end("initial", problem_.initial);
  end("final", problem_.final.end);
  equilibrium();
  limits();
  guess();
  stages();
  replay();
}

void OptimalControlCheck::parts() {
  if (!scene_.solids.empty()) {
    context_.add(error_at(check_.origin_of({section}),
                          "takes bodies, joints, muscles and forces; solids have too many unknowns: model them as "
                          "muscles, or leave out solid '" +
                              scene_.solids[0].name + "'"));
  }
}

void OptimalControlCheck::horizon() {
  const Horizon& duration = problem_.duration;
  if (failed("duration") || failed("step") || failed("steps")) return;
  if (duration.min > duration.max) {
    error({"duration"}, "needs min <= max, got " + shown(duration.min) + " and " + shown(duration.max));
  } else if (problem_.step && problem_.steps) {
    error({"steps"}, "give either step or steps, not both");
  } else if (duration.is_free() && !problem_.steps) {
    error(problem_.step ? Keys{"step"} : Keys{"duration"},
          "the duration is free, so that its step is: give the number of steps (`steps`)" +
              std::string(problem_.step ? " instead of a step" : ""));
  } else if (!problem_.step && !problem_.steps) {
    error({"step"}, "missing: give the time step (or `steps`, their number)");
  } else if (problem_.step) {
    std::string why = why_no_multiple(duration.max, *problem_.step, "the step", scene_.units.time());
    const double steps = duration.max / *problem_.step;
    if (steps > most_steps) {
      error({"step"}, "gives " + base::number_text(steps, 3) + " steps, at most 2e9 are sought");
    } else if (!why.empty()) {
      error({"duration"}, std::move(why));
    }
  }
}

void OptimalControlCheck::controls() {
  const Node* node = check_.find({section, "controls"});
  if (node != nullptr && problem_.controls.empty()) {
    error({"controls"}, "no controls: name at least one with its bounds, as in {" +
                            (scene_.controls.empty() ? std::string("name") : scene_.controls[0].name) +
                            ": {min: 0, max: 1}}");
  }
  for (const Entry<ControlBounds>& entry : problem_.controls) {
    const Entry<Control>* control = scene_.controls.find(entry.name);
    if (control == nullptr || failed("controls." + entry.name)) continue;
    const ControlBounds& bounds = entry.value;
    if (bounds.min && bounds.max && *bounds.min > *bounds.max) {
      error({"controls", entry.name, "max"},
            "the bounds cross: max " + shown(*bounds.max) + " is below min " + shown(*bounds.min));
    }
    if (drives_muscles(control->value.quantity) && bounds.min && *bounds.min < 0.0) {
      error({"controls", entry.name, "min"},
            "must be >= 0: a muscle feels the square of its field, got " + shown(*bounds.min));
    }
  }
}

template <class T>
void OptimalControlCheck::resolve(ByPoint<T>& points) {
  for (auto& item : points.items) {
    if (item.point.body.name == ground) {
      context_.add(error_at(item.origin, "the ground does not move"));
    } else if (!context_.failed(item.origin.path)) {
      check_.resolve(item.point.body.name, item.point.point);
    }
  }
}

void OptimalControlCheck::end(std::string_view which, EndCondition& end) {
  if (check_.find({section, which}) == nullptr) return;
  resolve(end.pose.points);
  poses(which, end);
  if (end.momentum && !end.velocity.empty()) {
    error({which, "velocity"}, "give either momentum or velocity, not both");
  } else if (!end.momentum && end.velocity.empty()) {
    error({which, "momentum"}, "missing: rest, free, {joint: momentum}; or give `velocity`");
  }
}

void OptimalControlCheck::poses(std::string_view which, const EndCondition& end) {
  const Pose& pose = end.pose;
  if (end.whole && !pose.empty()) {
    error({which, "pose"}, "gives the pose of all bodies already: leave out `" +
                               std::string(!pose.joints.empty()   ? "joints"
                                           : !pose.bodies.empty() ? "bodies"
                                           : !pose.points.empty() ? "points"
                                                                  : "orientations") +
                               "`, or leave out `pose`");
  }
  for (const Entry<Orientation>& entry : pose.orientations) {
    const Entry<BodyPose>* body = pose.bodies.find(entry.name);
    if (body == nullptr || !body->value.orientation || body->value.orientation == entry.value) continue;
    error({which, "orientations", entry.name}, "contradicts the orientation under `bodies`");
  }
  against_limits(which, pose);
}

void OptimalControlCheck::against_limits(std::string_view which, const Pose& pose) {
  for (const Entry<JointPosition>& entry : pose.joints) {
    const Entry<JointRange>* range = problem_.limits.joints.find(entry.name);
    if (range == nullptr || failed("limits.joints." + entry.name)) continue;
    for (std::size_t k = 0; k < std::min(entry.value.values.size(), range->value.values.size()); ++k) {
      const auto& value = entry.value.values[k];
      const auto& bounds = range->value.values[k];
      if (!value || !bounds || within(*value, *bounds)) continue;
      error({which, "joints", entry.name},
            "contradicts limits.joints." + entry.name + ": " + shown(*value) + " is outside " + range_of(*bounds));
    }
  }
  for (const auto& item : pose.points.items) {
    for (const auto& box : problem_.limits.points.items) {
      if (box.point.body != item.point.body || box.point.point.name != item.point.point.name) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        const Bounds bounds{box.value[0][k], box.value[1][k]};
        if (!item.value[k] || within(*item.value[k], bounds)) continue;
        context_.add(error_at(item.origin, "contradicts its box under `limits`: " + shown(*item.value[k]) +
                                               " is outside " + range_of(bounds)));
      }
    }
  }
}

void OptimalControlCheck::need_all_controls(std::string_view what, const Origin& at,
                                            const std::vector<std::string>& given) {
  std::vector<std::string> missing;
  for (const Entry<ControlBounds>& entry : problem_.controls) {
    const bool found = std::find(given.begin(), given.end(), entry.name) != given.end();
    if (!found && scene_.controls.find(entry.name) != nullptr) missing.push_back(entry.name);
  }
  if (missing.empty()) return;
  context_.add(error_at(
      at, std::string(what) + " needs a value of every control that is sought; missing: " + base::joined(missing)));
}

void OptimalControlCheck::equilibrium() {
  const Named<HeldControl>& held = problem_.final.equilibrium;
  if (held.empty() || failed("final.equilibrium")) return;
  need_all_controls("the equilibrium", check_.origin_of({section, "final", "equilibrium"}), held.names());
}

bool OptimalControlCheck::has_driven_muscle() const {
  return std::any_of(scene_.muscles.begin(), scene_.muscles.end(),
                     [](const Entry<Muscle>& muscle) { return muscle.value.control.has_value(); });
}

void OptimalControlCheck::limits() {
  resolve(problem_.limits.points);
  for (const auto& item : problem_.limits.points.items) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Bounds bounds{item.value[0][k], item.value[1][k]};
      if (!bounds[0] || !bounds[1] || *bounds[0] <= *bounds[1]) continue;
      context_.add(error_at(item.origin, "the bounds cross: lowest corner " + shown(*bounds[0]) +
                                             " is above highest corner " + shown(*bounds[1])));
    }
  }
  if (has_driven_muscle()) return;
  if (problem_.limits.true_field) error({"limits", "true_field"}, "no muscle of the scene has a field");
  if (problem_.limits.pull_in_margin) error({"limits", "pull_in_margin"}, "no muscle of the scene has a field");
}

void OptimalControlCheck::guess() {
  const Guess& guess = problem_.guess;
  if (failed("guess")) return;
  if (guess.kind == Guess::Kind::simulate) {
    need_all_controls("the simulation", guess.origin, guess.simulate.names());
  }
  if (guess.kind != Guess::Kind::random) return;
  for (const Entry<ControlBounds>& entry : problem_.controls) {
    const auto* control = scene_.controls.find(entry.name);
    if (control == nullptr) continue;
    const bool low = entry.value.min || drives_muscles(control->value.quantity);
    if (!low || !entry.value.max) error({"guess"}, "random guesses need both bounds of control '" + entry.name + "'");
  }
}

void OptimalControlCheck::stages() {
  if (check_.find({section, "stages"}) != nullptr && problem_.stages.empty()) {
    error({"stages"}, "no stages: give at least one, as in [{minimise: {effort: 1}}]");
  }
  for (Stage& one : problem_.stages) {
    if (auto& tracking = std::get<std::optional<Weighted<TrackingObjective>>>(one.minimise.terms)) {
      resolve(tracking->options.points);
    }
    if (auto& terminal = std::get<std::optional<Weighted<TerminalObjective>>>(one.minimise.terms)) {
      resolve(terminal->options.points);
    }
    if (!context_.failed(one.origin.path)) stage(one);
  }
}

void OptimalControlCheck::stage(const Stage& stage) {
  const auto refuse = [&](std::string_view objective, std::string message) {
    Origin origin = stage.origin;
    origin.path += ".minimise";
    if (!objective.empty()) origin.path += "." + std::string(objective);
    context_.add(error_at(origin, std::move(message)));
  };
  if (stage.minimise == Objectives{}) refuse({}, "names no objective: give one, as in {effort: 1}");
  if (stage.minimise.get<FinalTimeObjective>() && !problem_.duration.is_free() && !failed("duration")) {
    refuse(FinalTimeObjective::name, "the duration is fixed: give `duration: {min, max}`");
  }
  if (stage.minimise.get<PeakFieldObjective>() && !has_driven_muscle()) {
    refuse(PeakFieldObjective::name, "no muscle of the scene has a field");
  }
  if (const auto& tracking = stage.minimise.get<TrackingObjective>();
      tracking && tracking->options.joints.empty() && tracking->options.points.empty()) {
    refuse(TrackingObjective::name, "give joints or points, or both");
  } else if (tracking && problem_.duration.is_free()) {
    refuse(TrackingObjective::name,
           "follows functions of time, in which a free duration moves the nodes: fix the duration, or leave it out");
  }
  if (const auto& terminal = stage.minimise.get<TerminalObjective>();
      terminal && terminal->options.joints.empty() && terminal->options.points.empty()) {
    refuse(TerminalObjective::name, "give joints or points, or both");
  }
}

void OptimalControlCheck::replay() {
  if (!problem_.replay || failed("replay")) return;
  const Replay& replay = *problem_.replay;
  const std::string unit = scene_.units.time();
  const bool fixed = problem_.step && !failed("step");
  if (replay.step && fixed) {
    const double parts = *problem_.step / *replay.step;
    if (!why_no_multiple(*problem_.step, *replay.step, {}, {}).empty()) {
      const double most = *problem_.step / std::ceil(parts);
      const std::string least = parts > 1.0 ? " or " + shown(*problem_.step / std::floor(parts)) + " " + unit : "";
      error({"replay", "step"}, "is no whole fraction of the step of the optimal control " + shown(*problem_.step) +
                                    " " + unit + ": take " + shown(most) + " " + unit + least + ", got " +
                                    shown(*replay.step) + " " + unit);
    }
  }
  if (replay.then && fixed) {
    const double step = replay.step.value_or(*problem_.step);
    std::string why = why_no_multiple(replay.then->duration, step, "the step of the replay", unit);
    if (!why.empty()) error({"replay", "then", "duration"}, std::move(why));
  }
}

}  // namespace muldi::scene
