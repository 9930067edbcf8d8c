#include "variational/time_loop.hpp"

#include <algorithm>

#include "variational/explicit_stepper.hpp"

namespace muldi::variational {

namespace {

constexpr long first_look = -(1L << 40);

std::unique_ptr<StepMethod> make_method(const model::Model& model, const LoopOptions& options) {
  if (options.integrator == Integrator::midpoint) return std::make_unique<Stepper>(model, options.dt, options.step);
  return std::make_unique<ExplicitStepper>(model, options.dt);
}

void count(const StepReport& report, LoopStatistics& statistics) {
  ++statistics.steps;
  statistics.iterations += report.iterations;
  statistics.factorisations += report.factorisations;
  statistics.largest_residual = std::max(statistics.largest_residual, report.residual);
  statistics.largest_rotation = std::max(statistics.largest_rotation, report.rotation);
}

}  // namespace

TimeLoop::TimeLoop(const model::Model& model, LoopOptions options)
    : model_(model),
      options_(std::move(options)),
      stepper_(make_method(model, options_)),
      nodes_(model, options_.step.linear, options_.step.substructures),
      control_rates_(model, options_.dt),
      supply_(model),
      looks_(first_look),
      u_before_(model.controls.size()),
      u_(model.controls.size()) {
  values_.v = Eigen::VectorXd::Zero(model.n_q());
}

void TimeLoop::controls_of(const State& state) {
  const double middle = 0.5 * options_.dt;
  const double t = static_cast<double>(state.step) * options_.dt;
  model_.evaluate_controls(t + middle, u_);
  if (state.step == 0) {
    u_before_ = u_;
  } else {
    model_.evaluate_controls(t - middle, u_before_);
  }
}

LoopResult TimeLoop::run(State& state, Ledger& ledger, StepReport& last, const LoopCallbacks& callbacks) {
  LoopResult result;
  bool warned_rotation = false;
  bool warned_loop = false;
  while (state.step < options_.steps && result.status == Status::completed) {
    if (callbacks.interrupted && callbacks.interrupted()) {
      result.status = Status::interrupted;
      result.sentence = "interrupted by the user";
      break;
    }
    controls_of(state);
    const bool recorded = state.step % options_.record_every == 0;
    if (recorded && callbacks.checkpoint) callbacks.checkpoint(state, ledger, last);
    if (recorded || state.step == 0) {
      const Side side = state.step == 0 ? Side::after : Side::both;
      if (!nodes_.evaluate(state, u_before_, u_, values_, rates_at(state, side))) {
        result.status = Status::no_convergence;
        result.sentence = "the mass matrix is singular on the free motions: a body without mass or inertia moves";
        break;
      }
      if (state.step == 0) ledger.initial_total = values_.total.kinetic + values_.total.potential();
    }
    double jump = 0.0;
    if (u_ != u_before_) jump = nodes_.electric(state, u_) - nodes_.electric(state, u_before_);
    if (supply_.is_kept()) book_supply(state, ledger);
    before_ = state;
    if (state.step == 0 && refuses(state, u_before_, result)) break;
    const StepReport report = stepper_->advance(state, u_);
    if (report.status != Status::running) {
      result.status = report.status;
      result.sentence = report.sentence;
      break;
    }
    if (refuses(state, u_, result)) {
      state = before_;
      break;
    }
    // Prescribed motions do work over both intervals beside a node with the force there: R_n . (q_n+1 - q_n-1)/2.
    if (nodes_.moves() && before_.step > 0) ledger.external += half_work(stepper_->constraint_force(), before_);
    if (recorded) record(callbacks, before_, ledger, last, {stepper_->constraint_force(), state.multipliers, state.y});
    last = report;
    ledger.dissipated += report.work.dissipated;
    ledger.external += report.work.external;
    if (nodes_.moves()) ledger.external += half_work(stepper_->constraint_force(), state);
    ledger.source += jump;
    if (supply_.is_kept()) ledger.supply = supply_after_;
    count(report, result.statistics);
    if (callbacks.warn && !warned_rotation && report.rotation > options_.step.warn_rotation) {
      warned_rotation = true;
      callbacks.warn(report, state.t);
    }
    if (callbacks.warn && !warned_loop && report.loop_regularity < options_.step.loop_warning) {
      warned_loop = true;
      callbacks.warn(report, state.t);
    }
  }
  record_end(callbacks, state, ledger, last);
  result.t = state.t;
  return result;
}

void TimeLoop::book_supply(const State& state, Ledger& ledger) {
  if (state.step == 0) supply_.open(look(state, u_before_), ledger.supply);
  supply_after_ = ledger.supply;
  if (u_ == u_before_) return;
  supply_.stand(look(state, u_before_));
  supply_.change(look(state, u_), supply_after_);
}

std::span<const double> TimeLoop::rates_at(const State& state, Side side) {
  return nodes_.moves() ? control_rates_.at(state.t, side) : std::span<const double>();
}

double TimeLoop::half_work(const Eigen::VectorXd& force, const State& state) const {
  double work = 0.0;
  for (const auto& part : model_.substructures) work += 0.5 * part->work_of_prescribed(force, state.advance);
  return work;
}

model::NodeView TimeLoop::look(const State& state, const std::vector<double>& u) {
  return {.serial = looks_--,
          .t = state.t,
          .x = state.x,
          .rate = values_.rate,
          .q = state.q,
          .v = values_.v,
          .constraint_force = values_.v,
          .multipliers = state.multipliers,
          .y = state.y,
          .u = u};
}

bool TimeLoop::refuses(const State& state, const std::vector<double>& u, LoopResult& result) {
  if (model_.guards.empty()) return false;
  result.sentence = model_.breach(look(state, u));
  if (result.sentence.empty()) return false;
  result.status = Status::breakdown;
  result.t_of_breach = state.t;
  return true;
}

void TimeLoop::record(const LoopCallbacks& callbacks, const State& state, const Ledger& ledger, const StepReport& last,
                      const Reactions& reactions) {
  if (!callbacks.record) return;
  callbacks.record({.step = state.step,
                    .t = state.t,
                    .state = state,
                    .values = values_,
                    .ledger = ledger,
                    .constraint_force = reactions.force,
                    .multipliers = reactions.multipliers,
                    .y_after = reactions.stage,
                    .u = u_before_,
                    .report = last,
                    .last = reactions.last});
}

model::NodeView view_of(const NodeRecord& node) {
  return {.serial = node.step,
          .t = node.t,
          .x = node.state.x,
          .rate = node.values.rate,
          .q = node.state.q,
          .v = node.values.v,
          .constraint_force = node.constraint_force,
          .multipliers = node.multipliers,
          .y = node.state.y,
          .u = node.u,
          .y_after = &node.y_after,
          .accounts = node.ledger.supply};
}

void TimeLoop::record_end(const LoopCallbacks& callbacks, const State& state, Ledger& ledger, const StepReport& last) {
  // At the last node there is no following step. The reactions are those that make its momentum consistent with the
  // constraints: p_N - (dt/2) G^T lambda_N = M v_N.
  controls_of(state);
  // Before the evaluation, which may leave traces in the memory of the substructures.
  if (callbacks.checkpoint) callbacks.checkpoint(state, ledger, last);
  const Side side = state.step == 0 ? Side::after : Side::before;
  if (!nodes_.evaluate(state, u_before_, u_, values_, rates_at(state, side))) return;
  if (state.step == 0) ledger.initial_total = values_.total.kinetic + values_.total.potential();
  if (state.step == 0 && supply_.is_kept()) book_supply(state, ledger);
  const double half = 0.5 * options_.dt;
  end_force_ = values_.momentum - state.p;
  for (const auto& part : model_.substructures) {
    part->add_multiplier_impulse(state.q, nodes_.stage_impulse(), end_force_);
  }
  for (const auto& part : model_.substructures) part->gather(end_force_);
  end_force_ /= half;
  end_multipliers_ = nodes_.loop_impulse() / half;
  end_stage_ = nodes_.stage_impulse() / half;
  // A run that goes on from here books the work of this node with the force that it finds.
  Ledger complete = ledger;
  if (nodes_.moves() && state.step > 0) complete.external += half_work(end_force_, state);
  record(callbacks, state, complete, last, {end_force_, end_multipliers_, end_stage_, true});
}

}  // namespace muldi::variational
