#include "pipeline/run_statics.hpp"

#include <limits>

#include "base/error.hpp"
#include "base/text.hpp"
#include "pipeline/initial_state.hpp"

namespace muldi::pipeline {

StaticLoads static_loads(const scene::Scene& scene, const build::BuiltModel& built) {
  const scene::Statics& said = *scene.statics;
  StaticLoads loads;
  loads.fixed.resize(built.model->controls.size());
  built.model->evaluate_controls(0.0, loads.fixed);
  loads.direction.assign(loads.fixed.size(), 0.0);
  loads.options.steps = said.steps;
  if (said.control) {
    const auto swept = static_cast<std::size_t>(scene.controls.index(said.control->name));
    loads.fixed[swept] = 0.0;
    loads.direction[swept] = 1.0;
    loads.options.from = said.from;
    loads.options.to = *said.to;
  } else {
    std::swap(loads.fixed, loads.direction);
  }
  loads.options.continuation = said.continuation == scene::Continuation::natural ? statics::Continuation::natural
                                                                                 : statics::Continuation::arc_length;
  loads.options.equilibrium = {.tolerance = scene.solver.tolerance, .substructures = built.solid_linear};
  return loads;
}

EquilibriumRows::EquilibriumRows(results::Recorder& recorder, const scene::Scene& scene, const build::BuiltModel& built)
    : built_(built),
      last_load_(scene.statics->control ? *scene.statics->to : 1.0),
      rows_(recorder, scene, built, NodeRows::Kind::statics, static_cast<std::size_t>(scene.statics->steps) + 1),
      parts_(built.model->parts().size()),
      supply_(*built.model),
      zero_q_(Eigen::VectorXd::Zero(built.model->n_q())),
      zero_v_(Eigen::VectorXd::Zero(built.manifold->n_v())),
      constraint_force_(zero_q_) {}

void EquilibriumRows::look_at(const statics::SweepPoint& point) {
  last_.load = point.load;
  last_.x = point.state.x;
  last_.q = point.q;
  last_.multipliers = point.state.multipliers;
  last_.y = point.y;
  last_.u.assign(point.u.begin(), point.u.end());
}

std::string EquilibriumRows::breach(const statics::SweepPoint& point) {
  if (built_.model->guards.empty()) return {};
  look_at(point);
  model::NodeView look = last_view();
  look.serial = looks_--;
  return built_.model->breach(look);
}

void EquilibriumRows::write(const statics::SweepPoint& point) {
  look_at(point);
  const std::span<const double> x(last_.x.data(), static_cast<std::size_t>(last_.x.size()));
  built_.model->energies({.x = x, .q = last_.q, .v = zero_q_, .u = last_.u}, parts_);
  constraint_force_ = -point.force;
  for (const auto& part : built_.model->substructures) part->gather(constraint_force_);
  if (supply_.is_kept()) {
    model::NodeView look = last_view();
    look.serial = looks_--;  // below those of the records
    if (accounts_.empty()) {
      supply_.open(look, accounts_);
    } else {
      supply_.change(look, accounts_);
    }
  }
  rows_.write({.load = point.load,
               .stable = point.report.stability == statics::Stability::stable,
               .iterations = point.report.iterations,
               .residual = point.report.residual,
               .violation = built_.manifold->violation(point.q),
               .parts = parts_,
               .last = point.load == last_load_},
              last_view());
}

model::NodeView EquilibriumRows::last_view() const {
  return {.t = last_.load,
          .x = last_.x,
          .rate = zero_v_,
          .q = last_.q,
          .v = zero_q_,
          .constraint_force = constraint_force_,
          .multipliers = last_.multipliers,
          .y = last_.y,
          .u = last_.u,
          .accounts = accounts_};
}

EquilibriumRows::Stretched EquilibriumRows::least_stretched() {
  Stretched least;
  model::NodeView view = last_view();
  view.serial = looks_--;
  for (const model::Observable& observable : built_.model->observables) {
    if (!observable.path.starts_with("muscles/") || !observable.path.ends_with("/stretch")) continue;
    double stretch = 0.0;
    observable.evaluate(view, {&stretch, 1});
    if (!least.where.empty() && stretch >= least.stretch) continue;
    constexpr std::size_t around = 16;  // of the name: the folder and the quantity
    least = {.where = "muscle '" + observable.path.substr(8, observable.path.size() - around) + "'",
             .stretch = stretch};
  }
  if (!least.where.empty()) return least;
  const build::SqueezedCell cell = most_squeezed();
  return {.where = cell.name, .stretch = cell.stretch};
}

build::SqueezedCell EquilibriumRows::most_squeezed() const { return build::squeezed_cell(built_, last_.q); }

StaticsRun::StaticsRun(const scene::Scene& scene, const build::BuiltModel& built, results::Recorder& recorder)
    : scene_(scene), built_(built), recorder_(recorder), rows_(recorder, scene, built) {}

void StaticsRun::prepare() {
  state_ = starting_point(scene_, built_);
  StaticLoads loads = static_loads(scene_, built_);
  sweep_.emplace(*built_.model, std::move(loads.fixed), std::move(loads.direction), loads.options);
}

std::string StaticsRun::load_text(const std::string& numbers) const {
  if (!scene_.statics->control) return numbers;
  const auto index = static_cast<std::size_t>(scene_.controls.index(scene_.statics->control->name));
  return base::format("{} {} of '{}'", numbers, scene_.units.unit_name(built_.model->controls[index].unit),
                      scene_.statics->control->name);
}

void StaticsRun::report_critical(const std::vector<statics::CriticalPoint>& points, const RunContext& context) {
  using Kind = statics::CriticalPoint::Kind;
  for (const Kind kind : {Kind::limit, Kind::branch}) {
    int number = 0;
    for (const statics::CriticalPoint& point : points) {
      if (point.kind != kind) continue;
      const std::string name = kind == Kind::limit ? "limit_load" : "branch_load";
      recorder_.set_attribute("statics", ++number == 1 ? name : name + "_" + std::to_string(number), point.load);
      if (!context.warn) continue;
      const std::string load = load_text(base::format("{:.10g}", point.load));
      context.warn(
          kind == Kind::limit
              ? "statics: the load turns at the limit point " + load +
                    ": loaded beyond it, the system jumps (pull-in, snap-through); dynamics shows where to, and "
                    "statics/stable marks the rows of this curve that are stable"
              : "statics: the stability changes at the load " + load +
                    ", where another branch crosses (buckling): a small force or offset to one side in the scene "
                    "leads onto it, as every real system has one");
    }
  }
}

void StaticsRun::report_changes(const std::vector<statics::BranchChange>& changes, const RunContext& context) {
  int number = 0;
  for (const statics::BranchChange& change : changes) {
    const std::string count = ++number == 1 ? "" : "_" + std::to_string(number);
    recorder_.set_attribute("statics", "jump_load_before" + count, change.before);
    recorder_.set_attribute("statics", "jump_load_after" + count, change.after);
    if (!context.warn) continue;
    context.warn(base::format(
        "statics: between the loads {} the equilibrium {}; continuation: arc_length "
        "follows the branch that it leaves",
        load_text(base::format("{:.10g} and {:.10g}", change.before, change.after)),
        change.jumps ? "jumps to another branch (snap-through)" : "goes over to another branch (buckling)"));
  }
}

std::string StaticsRun::sentence_of(const statics::SweepResult& result) {
  using End = statics::SweepResult::End;
  if (result.end == End::loss_of_equilibrium && result.last_good != result.first_bad) return loss_sentence(result);
  if (result.end != End::no_convergence) return result.sentence;
  const build::SqueezedCell cell = rows_.most_squeezed();
  if (cell.name.empty()) return result.sentence;
  return base::format("{}; there {} is at stretch {:.4g}", result.sentence, cell.name, cell.stretch);
}

std::string StaticsRun::loss_sentence(const statics::SweepResult& result) {
  std::string text = result.sentence;
  if (scene_.statics->control) {
    const auto index = static_cast<std::size_t>(scene_.controls.index(scene_.statics->control->name));
    text = base::format("the equilibrium is lost with control '{}' between {:.10g} and {:.10g} {}",
                        scene_.statics->control->name, result.last_good, result.first_bad,
                        scene_.units.unit_name(built_.model->controls[index].unit));
  }
  const EquilibriumRows::Stretched least = rows_.least_stretched();
  if (!least.where.empty()) text += base::format("; there {} is at stretch {:.4g}", least.where, least.stretch);
  return text;
}

std::string StaticsRun::breach_sentence(const Breach& breach) const {
  const double first = breach.before.value_or(breach.at);
  const std::string loads =
      first == breach.at ? base::format("{:.10g}", first) : base::format("{:.10g} to {:.10g}", first, breach.at);
  if (!scene_.statics->control) return base::format("at the load {} {}", loads, breach.sentence);
  const auto index = static_cast<std::size_t>(scene_.controls.index(scene_.statics->control->name));
  return base::format("with control '{}' at {} {} {}", scene_.statics->control->name, loads,
                      scene_.units.unit_name(built_.model->controls[index].unit), breach.sentence);
}

Outcome StaticsRun::run(RunContext& context) {
  const scene::Statics& said = *scene_.statics;
  long row = 0;
  Breach breach;
  statics::SweepCallbacks callbacks;
  callbacks.record = [&](const statics::SweepPoint& point) {
    if (!breach.sentence.empty()) return;
    breach.at = point.load;
    breach.sentence = rows_.breach(point);
    if (!breach.sentence.empty()) return;
    breach.before = point.load;
    rows_.write(point);
    if (context.progress) context.progress(row++, said.steps, point.load);
  };
  callbacks.interrupted = [&] { return !breach.sentence.empty() || (context.interrupted && context.interrupted()); };
  const statics::SweepResult result = sweep_->run(state_, callbacks);
  if (!breach.sentence.empty()) {
    return {.status = variational::Status::breakdown,
            .sentence = breach_sentence(breach),
            .time = std::numeric_limits<double>::quiet_NaN()};
  }
  using End = statics::SweepResult::End;
  if (result.end == End::loss_of_equilibrium) {
    recorder_.set_attribute("statics", "critical_load_above", result.last_good);
    recorder_.set_attribute("statics", "critical_load_below", result.first_bad);
  }
  report_critical(result.critical, context);
  report_changes(result.changes, context);
  // A curve may end before its range does, of itself.
  if (result.end == End::completed && !result.sentence.empty() && context.warn) {
    context.warn("statics: " + result.sentence);
  }
  const auto status = result.end == End::completed             ? variational::Status::completed
                      : result.end == End::interrupted         ? variational::Status::interrupted
                      : result.end == End::loss_of_equilibrium ? variational::Status::loss_of_equilibrium
                                                               : variational::Status::no_convergence;
  return {.status = status, .sentence = sentence_of(result), .time = std::numeric_limits<double>::quiet_NaN()};
}

}  // namespace muldi::pipeline
