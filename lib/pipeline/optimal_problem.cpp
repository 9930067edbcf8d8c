#include "pipeline/optimal_problem.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "build/place_bodies.hpp"
#include "multibody/joint_coordinate.hpp"
#include "scene/optimal_control.hpp"

namespace muldi::pipeline {
namespace {

using multibody::body_direction;
using multibody::body_point;

/// Translates the parts of the section; collects what does not fit.
class ProblemBuilder {
 public:
  ProblemBuilder(const scene::Scene& scene, const build::BuiltModel& built, const Eigen::VectorXd& start)
      : scene_(scene), said_(*scene.optimal_control), built_(built), start_(start) {}

  OptimalProblem build() {
    OptimalProblem result{.problem = {.model = *built_.model}, .stages = {}};
    control::Problem& problem = result.problem;
    const int n = said_.n_steps();
    problem.horizon = {.n_steps = n, .shortest_step = said_.duration.min / n, .longest_step = said_.duration.max / n};
    if (said_.step) problem.horizon.shortest_step = problem.horizon.longest_step = *said_.step;
    for (const auto& entry : said_.controls) problem.controls.push_back(choice_of(entry));
    problem.initial = end_of(said_.initial);
    problem.final = end_of(said_.final.end);
    if (!said_.final.equilibrium.empty()) problem.final.equilibrium = held_controls(said_.final.equilibrium);
    problem.limits = limits();
    for (const scene::Stage& stage : said_.stages) result.stages.push_back(objectives_of(stage, problem.controls));
    if (!errors_.empty()) throw base::InputError(std::move(errors_));
    return result;
  }

 private:
  control::ControlChoice choice_of(const scene::Entry<scene::ControlBounds>& entry) const {
    control::ControlChoice choice{.control = scene_.controls.index(entry.name)};
    choice.kind = control::kind_of_control(*built_.model, choice.control);
    const bool squared = choice.kind == control::ControlKind::squared;
    choice.lower = entry.value.min.value_or(squared ? 0.0 : -control::infinity);
    choice.upper = entry.value.max.value_or(control::infinity);
    double reference = 0.0;
    if (std::isfinite(choice.upper)) reference = std::abs(choice.upper);
    if (std::isfinite(choice.lower)) reference = std::max(reference, std::abs(choice.lower));
    if (reference == 0.0) {
      const auto& function = built_.model->controls[static_cast<std::size_t>(choice.control)].function;
      const int n = said_.n_steps();
      for (int i = 0; i < n; ++i) {
        reference = std::max(reference, std::abs(function.at((i + 0.5) * said_.duration.max / n)));
      }
    }
    choice.reference = reference > 0.0 ? reference : 1.0;
    return choice;
  }

  /// Controls of the model where the scene's have these values; the others as at the end of the horizon.
  std::vector<double> held_controls(const scene::Named<scene::HeldControl>& held) const {
    std::vector<double> u(built_.model->controls.size());
    built_.model->evaluate_controls(said_.duration.max, u);
    for (const auto& entry : held) u[static_cast<std::size_t>(scene_.controls.index(entry.name))] = entry.value.value;
    return u;
  }

  /// A coordinate of a joint: of the tree its place in the minimal velocities, of a cut joint what computes it.
  struct Coordinate {
    int rate = -1;
    control::CutJoint cut = {};
  };

  /// The first minimal velocity of a joint whose rates or momenta are given, or -1 and an error.
  template <class T>
  int first_rate(const scene::Entry<T>& entry) {
    const auto index = static_cast<std::size_t>(scene_.joints.index(entry.name));
    const multibody::TreeLink* link = built_.link_of_joint(index);
    if (link != nullptr) return link->first_rate;
    errors_.push_back(scene::error_at(
        entry.origin, "this joint closes a loop; give the velocity or momentum of another joint of the loop"));
    return -1;
  }

  /// Calls use(motion, k) for all coordinates of the joint that have a value.
  template <class T, class Use>
  void for_each_given(const scene::Entry<T>& entry, Use use) {
    const auto index = static_cast<std::size_t>(scene_.joints.index(entry.name));
    std::size_t k = 0;
    for (const multibody::Motion& motion : built_.joint(index).pattern.motions) {
      for (int i = 0; i < motion.n_rates(); ++i, ++k) {
        if (entry.value.values[k]) use(motion, k);
      }
    }
  }

  /// Calls use(coordinate, value) for all coordinates of the joint that have a value.
  template <class T, class Use>
  void for_each_coordinate(const scene::Entry<T>& entry, Use use) {
    const auto index = static_cast<std::size_t>(scene_.joints.index(entry.name));
    const multibody::TreeLink* link = built_.link_of_joint(index);
    bool refused = false;
    for_each_given(entry, [&](const multibody::Motion& motion, std::size_t k) {
      Coordinate at;
      if (motion.kind == multibody::Motion::Kind::ball) {
        if (!refused) {
          errors_.push_back(scene::error_at(entry.origin,
                                            "a rotation vector is no coordinate of the optimisation; give points, "
                                            "or the orientation of the body"));
        }
        refused = true;
        return;
      }
      if (link != nullptr) {
        at.rate = link->first_rate + static_cast<int>(k);
      } else {
        at.cut = std::make_shared<multibody::JointCoordinate>(built_.joint(index), motion);
      }
      use(at, *entry.value.values[k]);
    });
  }

  static std::string label_of(const scene::RecordedPoint& point) { return point.body.name + "." + point.point.name; }

  model::LinearPoint map_of(const scene::RecordedPoint& point) const {
    return body_point(build::body_index(scene_, point.body.name), build::to_eigen(point.point.position));
  }

  control::OrientationTarget orientation_target(const std::string& body, const scene::Orientation& wanted) const {
    const int index = build::body_index(scene_, body);
    control::OrientationTarget target{.name = "orientations." + body, .directors = {}};
    for (int k = 0; k < 3; ++k) {
      target.directors[static_cast<std::size_t>(k)] = body_direction(index, Eigen::Vector3d::Unit(k));
      for (int row = 0; row < 3; ++row) {
        target.value(row, k) = wanted.matrix[static_cast<std::size_t>(row)][static_cast<std::size_t>(k)];
      }
    }
    return target;
  }

  control::EndCondition end_of(const scene::EndCondition& end) {
    control::EndCondition result;
    if (end.whole) result.x = start_;
    for (const auto& entry : end.pose.joints) {
      for_each_coordinate(entry, [&](const Coordinate& at, double value) {
        result.coordinates.push_back({.name = "joints." + entry.name, .rate = at.rate, .cut = at.cut, .value = value});
      });
    }
    for (const auto& entry : end.pose.bodies) {
      if (entry.value.position) {
        result.points.push_back({.name = "bodies." + entry.name,
                                 .point = body_point(build::body_index(scene_, entry.name), Eigen::Vector3d::Zero()),
                                 .value = *entry.value.position});
      }
      if (entry.value.orientation) {
        result.orientations.push_back(orientation_target(entry.name, *entry.value.orientation));
      }
    }
    for (const auto& item : end.pose.points.items) {
      result.points.push_back(
          {.name = "points." + label_of(item.point), .point = map_of(item.point), .value = item.value});
    }
    for (const auto& entry : end.pose.orientations) {
      result.orientations.push_back(orientation_target(entry.name, entry.value));
    }
    result.momentum = momentum_of(end);
    return result;
  }

  control::MomentumCondition momentum_of(const scene::EndCondition& end) {
    using Kind = control::MomentumCondition::Kind;
    control::MomentumCondition result{.kind = Kind::free};
    if (!end.velocity.empty()) {
      result = {.kind = Kind::rates, .values = Eigen::VectorXd::Zero(built_.manifold->n_v())};
      for (const auto& entry : end.velocity) {
        const int first = first_rate(entry);
        if (first < 0) continue;
        for_each_given(entry, [&](const multibody::Motion&, std::size_t k) {
          result.values[first + static_cast<int>(k)] = *entry.value.values[k];
        });
      }
    } else if (end.momentum && end.momentum->kind == scene::EndMomentum::Kind::rest) {
      result.kind = Kind::rest;
    } else if (end.momentum && end.momentum->kind == scene::EndMomentum::Kind::given) {
      result = {.kind = Kind::momenta, .values = Eigen::VectorXd::Zero(built_.manifold->n_v())};
      for (const auto& entry : end.momentum->joints) {
        const int first = first_rate(entry);
        if (first < 0) continue;
        for (std::size_t k = 0; k < entry.value.values.size(); ++k) {
          result.values[first + static_cast<int>(k)] = entry.value.values[k];
        }
      }
    }
    return result;
  }

  control::PathLimits limits() {
    control::PathLimits result{.true_field = said_.limits.true_field, .pull_in_margin = said_.limits.pull_in_margin};
    for (const auto& entry : said_.limits.joints) {
      for_each_coordinate(entry, [&](const Coordinate& at, const scene::Bounds& bounds) {
        result.coordinates.push_back({.name = "joints." + entry.name,
                                      .rate = at.rate,
                                      .cut = at.cut,
                                      .lower = bounds[0].value_or(-control::infinity),
                                      .upper = bounds[1].value_or(control::infinity)});
      });
    }
    for (const auto& item : said_.limits.points.items) {
      control::PointLimit limit{.name = "points." + label_of(item.point), .point = map_of(item.point)};
      for (std::size_t k = 0; k < 3; ++k) {
        limit.lower[static_cast<Eigen::Index>(k)] = item.value[0][k].value_or(-control::infinity);
        limit.upper[static_cast<Eigen::Index>(k)] = item.value[1][k].value_or(control::infinity);
      }
      result.points.push_back(std::move(limit));
    }
    return result;
  }

  /// Of each choice, the sum over the muscles that it drives of factor(muscle)^2; `other` where it drives none.
  template <class Factor>
  std::vector<double> squares_of(const std::vector<control::ControlChoice>& choices, double other,
                                 Factor factor) const {
    std::vector<double> sums;
    for (const control::ControlChoice& choice : choices) {
      double sum = 0.0;
      bool any = false;
      for (const build::DrivenMuscle& muscle : built_.driven_muscles) {
        if (muscle.control != choice.control) continue;
        sum += factor(muscle) * factor(muscle);
        any = true;
      }
      sums.push_back(any ? sum : other);
    }
    return sums;
  }

  control::Effort built_objective(const scene::EffortObjective& said,
                                  const std::vector<control::ControlChoice>& choices) {
    const double volt = scene_.units.si(base::dimension::voltage);  // one unit of voltage in V
    std::vector<double> factors = squares_of(choices, 1.0, [&](const build::DrivenMuscle& muscle) {
      return muscle.field_factor * muscle.rest_length * volt;
    });
    for (double& factor : factors) factor *= said.scale;
    return {.factors = std::move(factors)};
  }
  control::PeakField built_objective(const scene::PeakFieldObjective&,
                                     const std::vector<control::ControlChoice>& choices) {
    const double kilovolt_per_mm = scene_.units.si(base::dimension::field) * 1e-6;
    std::vector<double> factors;
    for (const control::ControlChoice& choice : choices) {
      double largest = 0.0;
      for (const build::DrivenMuscle& muscle : built_.driven_muscles) {
        if (muscle.control == choice.control) largest = std::max(largest, std::abs(muscle.field_factor));
      }
      factors.push_back(std::pow(largest * kilovolt_per_mm, 2));
    }
    return {.factors = std::move(factors)};
  }
  control::Tracking built_objective(const scene::TrackingObjective& said, const std::vector<control::ControlChoice>&) {
    control::Tracking result;
    for (const auto& entry : said.joints) {
      for_each_coordinate(entry, [&](const Coordinate& at, const base::TimeFunction& wanted) {
        result.coordinates.push_back({.rate = at.rate, .cut = at.cut, .wanted = wanted});
      });
    }
    for (const auto& item : said.points.items) {
      result.points.push_back({.point = map_of(item.point), .wanted = item.value});
    }
    return result;
  }
  control::Terminal built_objective(const scene::TerminalObjective& said, const std::vector<control::ControlChoice>&) {
    control::Terminal result;
    for (const auto& entry : said.joints) {
      for_each_coordinate(entry, [&](const Coordinate& at, double wanted) {
        result.coordinates.push_back({.rate = at.rate, .cut = at.cut, .wanted = wanted});
      });
    }
    for (const auto& item : said.points.items) {
      result.points.push_back({.point = map_of(item.point), .wanted = item.value});
    }
    return result;
  }
  using Choices = std::vector<control::ControlChoice>;
  static control::Feasibility built_objective(const scene::FeasibilityObjective&, const Choices&) { return {}; }
  static control::Rate built_objective(const scene::RateObjective&, const Choices&) { return {}; }
  static control::FinalTime built_objective(const scene::FinalTimeObjective&, const Choices&) { return {}; }
  static control::KineticEnergy built_objective(const scene::KineticEnergyObjective&, const Choices&) { return {}; }

  std::vector<control::WeightedObjective> objectives_of(const scene::Stage& stage,
                                                        const std::vector<control::ControlChoice>& choices) {
    std::vector<control::WeightedObjective> sum;
    base::for_each_type(scene::ObjectiveTypes{}, [&]<class Type>(std::type_identity<Type>) {
      const auto& said = stage.minimise.get<Type>();
      if (said) sum.push_back({.weight = said->weight, .objective = built_objective(said->options, choices)});
    });
    return sum;
  }

  const scene::Scene& scene_;
  const scene::OptimalControl& said_;
  const build::BuiltModel& built_;
  const Eigen::VectorXd& start_;
  std::vector<base::Diagnostic> errors_;
};

/// Where an entry below the section was written: the deepest that is known, else the section.
scene::Origin origin_of(const scene::Scene& scene, const std::string& below) {
  const scene::OptimalControl& said = *scene.optimal_control;
  const std::string path = below.empty() ? "optimal_control" : "optimal_control." + below;
  scene::Origin best = said.origin;
  std::size_t longest = 0;
  const auto consider = [&](const scene::Origin& origin) {
    if (path.rfind(origin.path, 0) != 0 || origin.path.size() <= longest) return;
    longest = origin.path.size();
    best = origin;
  };
  const auto consider_all = [&](const auto& section) {
    for (const auto& entry : section) consider(entry.origin);
  };
  consider_all(said.controls);
  consider_all(said.limits.joints);
  consider_all(said.limits.points.items);
  consider_all(said.final.equilibrium);
  for (const scene::EndCondition* end : {&said.initial, &said.final.end}) {
    consider_all(end->pose.joints);
    consider_all(end->pose.bodies);
    consider_all(end->pose.orientations);
    consider_all(end->pose.points.items);
    consider_all(end->velocity);
  }
  best.path = path;
  return best;
}

}  // namespace

OptimalProblem build_optimal_problem(const scene::Scene& scene, const build::BuiltModel& built,
                                     const Eigen::VectorXd& start) {
  return ProblemBuilder(scene, built, start).build();
}

void refuse_faults(const scene::Scene& scene, const std::vector<control::Fault>& faults) {
  if (faults.empty()) return;
  std::vector<base::Diagnostic> errors;
  errors.reserve(faults.size());
  for (const control::Fault& fault : faults) errors.push_back(error_at(origin_of(scene, fault.where), fault.why));
  throw base::InputError(std::move(errors));
}

std::vector<std::vector<double>> scheduled_controls(const control::Problem& problem, double step) {
  const auto n = static_cast<std::size_t>(problem.horizon.n_steps);
  std::vector<std::vector<double>> u(n, std::vector<double>(problem.model.controls.size()));
  for (std::size_t i = 0; i < n; ++i) problem.model.evaluate_controls((static_cast<double>(i) + 0.5) * step, u[i]);
  return u;
}

double sum_of_squared_fields(const scene::Scene& scene, const build::BuiltModel& built,
                             const control::Trajectory& trajectory) {
  const double kilovolt_per_mm = scene.units.si(base::dimension::field) * 1e-6;
  double sum = 0.0;
  for (const std::vector<double>& u : trajectory.u) {
    for (const build::DrivenMuscle& muscle : built.driven_muscles) {
      const double field = muscle.field_factor * u[static_cast<std::size_t>(muscle.control)] * kilovolt_per_mm;
      sum += field * field;
    }
  }
  return sum;
}

}  // namespace muldi::pipeline
