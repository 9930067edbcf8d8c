#include "pipeline/run.hpp"

#include "base/error.hpp"
#include "base/memory.hpp"
#include "base/text.hpp"
#include "build/stable_step.hpp"
#include "pipeline/checkpoint.hpp"
#include "pipeline/initial_state.hpp"
#include "pipeline/loop_sentence.hpp"
#include "pipeline/node_rows.hpp"
#include "pipeline/provenance.hpp"
#include "pipeline/run_statics.hpp"
#include "pipeline/step_options.hpp"
#include "scene/read_scene.hpp"
#include "variational/time_loop.hpp"

namespace muldi::pipeline {
namespace {

/// A midpoint step that turns a body by a has the momentum J sin(a) / dt: beyond 1 rad a step there is no solution.
constexpr double longest_turn = 1.0;

variational::LoopOptions loop_options(const scene::Scene& scene, const build::BuiltModel& built) {
  variational::LoopOptions options;
  options.dt = scene.dynamics->step;
  options.steps = scene.dynamics->n_steps();
  options.record_every = scene.record.every;
  options.step = step_options(scene, built);
  if (scene.dynamics->integrator == scene::Integrator::explicit_scheme) {
    options.integrator = variational::Integrator::explicit_scheme;
  }
  return options;
}

/// The dynamics of a run, with what is restored from and put into checkpoints.
class DynamicsRun {
 public:
  DynamicsRun(const scene::Scene& scene, const build::BuiltModel& built, results::Recorder& recorder)
      : scene_(scene),
        built_(built),
        recorder_(recorder),
        options_(loop_options(scene, built)),
        rows_(recorder, scene, built, NodeRows::Kind::dynamics,
              static_cast<std::size_t>(options_.steps / options_.record_every + 2)),
        checkpoints_(*built.model, rows_.observed().size()) {
    recorder.declare_checkpoint(checkpoints_.first());
  }

  Outcome prepare(const std::optional<results::Checkpoint>& earlier) {
    const Outcome outcome = initial_state(scene_, built_, earlier, state_);
    if (outcome.completed()) prepare_loop(scene_.statics.has_value());
    return outcome;
  }

  void resume(const results::Checkpoint& checkpoint) {
    state_ = state_of(checkpoint, scene_, *built_.model);
    state_.t = static_cast<double>(state_.step) * options_.dt;
    restore_memory(checkpoint, *built_.model);
    restore(checkpoint, ledger_, last_, rows_.observed());
    prepare_loop(false);
  }

  Outcome run(RunContext& context) {
    if (!loop_) loop_.emplace(*built_.model, options_);
    variational::LoopCallbacks callbacks;
    callbacks.record = [&](const variational::NodeRecord& node) {
      rows_.write(node);
      advise(node, context);
      check_step(node, context);
      if (context.progress) context.progress(node.step, options_.steps, node.t);
    };
    callbacks.checkpoint = [&](const variational::State& state, const variational::Ledger& ledger,
                               const variational::StepReport& last) {
      recorder_.write_checkpoint(checkpoints_.write(state, ledger, last, rows_.observed()));
    };
    callbacks.interrupted = context.interrupted;
    callbacks.warn = [&](const variational::StepReport& report, double t) {
      if (context.warn) context.warn(warning_of(report, t));
    };
    const variational::LoopResult result = loop_->run(state_, ledger_, last_, callbacks);
    if (result.status == variational::Status::no_convergence) return failure(result);
    return {.status = result.status, .sentence = loop_sentence(result, scene_), .time = result.t};
  }

 private:
  /// Makes the solvers before a record is begun, so that nothing is left of a run that does not fit into this machine.
  /// Where statics come first, whose solvers take as much, only the sizes are asked for.
  void prepare_loop(bool later) {
    if (!later) {
      loop_.emplace(*built_.model, options_);
      return;
    }
    for (const auto& part : built_.model->substructures) {
      const model::SolverSize size = part->solver_size(model::Linearisation::step, options_.step.substructures);
      base::require_memory(size.factor_bytes, "the factorised matrix of a solid", "take fewer cells");
    }
  }

  /// Newton's iteration ends nowhere where the motion is too fast for the step: that can be said.
  Outcome failure(const variational::LoopResult& result) const {
    const model::Turn part = built_.manifold->largest_turn(state_.q, ahead());
    const double turn = part.angle / small_part;
    if (turn <= longest_turn) return {.status = result.status, .sentence = result.sentence, .time = result.t};
    return {.status = variational::Status::step_too_large,
            .sentence = base::format("{} turns by {:.3g} rad in one step (limit {:g}): use a smaller step",
                                     built_.model->body_at(part.node), turn, longest_turn),
            .time = result.t};
  }

  static constexpr double small_part = 1.0 / 16.0;  // of the next step: angles beyond a half turn look small

  /// The configuration a part of the next step ahead, at the present speed.
  Eigen::VectorXd ahead() const {
    Eigen::VectorXd x = state_.x;
    Eigen::VectorXd q = state_.q;
    built_.manifold->retract(state_.x, small_part * state_.increment, x);
    built_.manifold->configuration(x, q);
    return q;
  }

  std::string warning_of(const variational::StepReport& report, double t) const {
    const std::string at = base::format("at t = {:.6g} {}: ", t, scene_.units.time());
    if (report.rotation > options_.step.warn_rotation) {
      return at +
             base::format("{} turns by {:.3g} rad in one step; results lose accuracy: take a smaller dynamics.step",
                          built_.model->body_at(report.turning), report.rotation);
    }
    return at + base::format(
                    "the loops come near a change point (regularity {:.3g} of that at the start), where the mechanism "
                    "may go on in two ways: check the motion with half the dynamics.step",
                    report.loop_regularity);
  }

  /// Says once what the terms find remarkable.
  void advise(const variational::NodeRecord& node, const RunContext& context) {
    if (advised_ || !context.warn) return;
    const std::span<const double> x(node.state.x.data(), static_cast<std::size_t>(node.state.x.size()));
    const std::string sentence = built_.model->advice({.x = x, .q = node.state.q, .v = node.values.v, .u = node.u});
    if (sentence.empty()) return;
    advised_ = true;
    context.warn(base::format("at t = {:.6g} {}: {}", node.t, scene_.units.time(), sentence));
  }

  /// Says once that the step is longer than the stable one of cells of constant volume. The explicit integrator knows
  /// its own bound.
  void check_step(const variational::NodeRecord& node, const RunContext& context) {
    const bool looks = rows_seen_++ % rows_between_looks == 0;
    if (!looks || step_told_ || node.last || !context.warn || built_.solids.empty() ||
        options_.integrator == variational::Integrator::explicit_scheme) {
      return;
    }
    const build::StableStep stable = build::exceeded_step(built_, node.state.q, node.y_after, options_.dt);
    if (stable.name.empty()) return;
    step_told_ = true;
    const std::string& unit = scene_.units.time();
    context.warn(base::format(
        "at t = {:.6g} {}: the step of {:.6g} {} is longer than about {:.3g} {}, the stable one of {}: {:.3g} {} times "
        "the root of density by the stress {:.3g}): errors that alternate from step to step grow; take a smaller "
        "dynamics.step, or formulation: displacement",
        node.t, unit, options_.dt, unit, stable.step, unit, stable.name, stable.length, scene_.units.length(),
        stable.stress));
  }

  static constexpr long rows_between_looks = 8;

  bool advised_ = false;
  bool step_told_ = false;
  long rows_seen_ = 0;
  const scene::Scene& scene_;
  const build::BuiltModel& built_;
  results::Recorder& recorder_;
  variational::LoopOptions options_;
  NodeRows rows_;
  CheckpointWriter checkpoints_;
  std::optional<variational::TimeLoop> loop_;
  variational::State state_;
  variational::Ledger ledger_;
  variational::StepReport last_;
};

Outcome run_parts(std::optional<StaticsRun>& statics, std::optional<DynamicsRun>& dynamics, bool resumed,
                  RunContext& context) {
  Outcome outcome;
  if (statics && !resumed) {
    const base::Phases::Scope scope(context.phases, "statics");
    outcome = statics->run(context);
    statics.reset();  // and its solvers
  }
  if (dynamics && outcome.completed()) {
    const base::Phases::Scope scope(context.phases, "dynamics");
    outcome = dynamics->run(context);
  }
  return outcome;
}

}  // namespace

Outcome run(const scene::Scene& scene, const build::BuiltModel& built, results::Recorder& recorder, RunContext& context,
            const std::optional<results::Checkpoint>& earlier) {
  const std::optional<results::Checkpoint> point = recorder.resume_point();
  const bool resumed = point && in_dynamics(*point);
  std::optional<StaticsRun> statics;
  std::optional<DynamicsRun> dynamics;
  Outcome outcome;
  {
    const base::Phases::Scope scope(context.phases, "prepare");
    if (scene.statics) statics.emplace(scene, built, recorder);
    if (scene.dynamics) dynamics.emplace(scene, built, recorder);
    set_provenance(recorder, scene, context);
    if (statics && !resumed) statics->prepare();
    if (dynamics) {
      if (resumed) {
        dynamics->resume(*point);
      } else {
        outcome = dynamics->prepare(earlier);
      }
    }
    recorder.start();
    // The duration may have grown.
    if (resumed) recorder.set_attribute("", "scene", scene::resolved_text(scene));
  }
  if (outcome.completed()) outcome = run_parts(statics, dynamics, resumed, context);
  set_wall_times(recorder, context.phases);
  recorder.close({.status = variational::name_of(outcome.status), .where = outcome.sentence, .time = outcome.time});
  return outcome;
}

}  // namespace muldi::pipeline
