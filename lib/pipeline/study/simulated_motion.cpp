#include "pipeline/study/simulated_motion.hpp"

#include <Eigen/LU>
#include <Eigen/QR>

#include "base/error.hpp"
#include "base/text.hpp"
#include "control/discrete_dynamics.hpp"
#include "pipeline/initial_state.hpp"
#include "pipeline/joint_momenta.hpp"
#include "pipeline/node_rows.hpp"
#include "pipeline/study/simulated_equilibria.hpp"
#include "pipeline/trajectory_rows.hpp"
#include "results/memory_recorder.hpp"
#include "variational/time_loop.hpp"

namespace muldi::pipeline {
namespace {

using control::DiscreteDynamics;

int n_steps_of(const Motion& motion) { return static_cast<int>(motion.path.u.size()); }

control::Layout layout_of(const build::BuiltModel& built, int n_steps) {
  control::Layout layout{.n_steps = n_steps, .n_v = built.manifold->n_v(), .n_u = 0, .n_c = built.manifold->n_c()};
  layout.balance_at_end = {true, false};
  layout.place_nodes();
  return layout;
}

/// The discrete equations of a model at a motion that need not be its own.
class Equations {
 public:
  Equations(const build::BuiltModel& built, const Motion& motion)
      : problem_{.model = *built.model,
                 .horizon = {.n_steps = n_steps_of(motion),
                             .shortest_step = motion.path.step,
                             .longest_step = motion.path.step}},
        layout_(layout_of(built, n_steps_of(motion))),
        dynamics_(problem_, layout_, motion.path) {
    Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(layout_.n);
    Eigen::VectorXd theta(layout_.n_v);
    for (int n = 0; n <= layout_.n_steps; ++n) {
      const control::DynamicsNode& node = dynamics_.node(n);
      node.chart->coordinates(motion.path.x[static_cast<std::size_t>(n)], theta);
      unknowns.segment(layout_.theta(n, 0), layout_.n_v) = theta;
      if (layout_.lambda(n, 0) < 0) continue;
      unknowns.segment(layout_.lambda(n, 0), layout_.n_c) =
          node.Z.transpose() * motion.lambda[static_cast<std::size_t>(n)];
    }
    admissible_ = dynamics_.move_to(unknowns);
  }
  // The dynamics refer to the problem here.
  Equations(const Equations&) = delete;
  Equations& operator=(const Equations&) = delete;

  DiscreteDynamics& dynamics() { return dynamics_; }
  const control::Layout& layout() const { return layout_; }
  bool admissible() const { return admissible_; }

  /// r_n of all nodes with a balance, one column each.
  Eigen::MatrixXd balances() const {
    Eigen::MatrixXd all(layout_.n_v, layout_.n_steps);
    Eigen::VectorXd r(layout_.n_v);
    for (int n = 0; n < layout_.n_steps; ++n) {
      dynamics_.balance(n, r);
      all.col(n) = r;
    }
    return all;
  }
  /// g of all nodes, one column each.
  Eigen::MatrixXd gaps() const {
    const model::Manifold& manifold = *problem_.model.manifold;
    Eigen::MatrixXd all(manifold.n_loop_rows(), layout_.n_steps + 1);
    Eigen::VectorXd g(manifold.n_loop_rows());
    for (int n = 0; n <= layout_.n_steps; ++n) {
      manifold.constraints(dynamics_.node(n).point.q, g);
      all.col(n) = g;
    }
    return all;
  }

 private:
  control::Problem problem_;
  control::Layout layout_;
  DiscreteDynamics dynamics_;
  bool admissible_ = false;
};

bool starts_moving(const scene::Scene& scene) {
  bool any = !scene.initial.bodies.empty() || !scene.initial.momentum.empty();
  for (const auto& entry : scene.initial.joints) any |= !entry.value.velocity.empty();
  return any;
}

/// D^T p_0 of the initial motion of a scene at these coordinates.
Eigen::VectorXd initial_momentum(const scene::Scene& scene, const build::BuiltModel& built,
                                 const Eigen::VectorXd& reference, const Eigen::VectorXd& theta) {
  const auto chart = built.manifold->make_chart();
  chart->set_reference(reference);
  model::ChartPoint point;
  Eigen::VectorXd x = reference;
  chart->stored(theta, x);
  chart->evaluate(theta, point);
  Eigen::VectorXd rates = initial_rates(scene, built, x);
  if (!scene.initial.momentum.empty()) rates += rates_of_momentum(built, x, wanted_momenta(scene, built));
  const auto frame = built.manifold->make_frame();
  built.manifold->update(x, point.q, *frame);
  Eigen::VectorXd v = Eigen::VectorXd::Zero(built.model->n_q());
  built.manifold->lift(*frame, rates, v);
  std::vector<double> u(built.model->controls.size());
  built.model->evaluate_controls(0.5 * scene.dynamics->step, u);
  Eigen::VectorXd p;
  variational::NodeEvaluator(*built.model, "auto").momentum_of(point.q, v, u, p);
  return point.D.transpose() * p;
}

/// The linearised motion: one factor a step for all parameters.
class Linearised {
 public:
  Linearised(const scene::Scene& scene, const build::BuiltModel& built, const Motion& motion)
      : scene_(scene), built_(built), motion_(motion), equations_(built, motion) {
    const control::Layout& layout = equations_.layout();
    jacobian_.resize(layout);
    equations_.dynamics().jacobian(jacobian_);
    const Eigen::Index n_v = layout.n_v;
    const Eigen::Index n_c = layout.n_c;
    factors_.reserve(static_cast<std::size_t>(layout.n_steps));
    for (std::size_t n = 0; n < static_cast<std::size_t>(layout.n_steps); ++n) {
      Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n_v + n_c, n_v + n_c);
      A.topLeftCorner(n_v, n_v) = jacobian_.next[n];
      if (n_c > 0) {
        A.topRightCorner(n_v, n_c) = jacobian_.by_lambda[n];
        A.bottomLeftCorner(n_c, n_v) = jacobian_.closing[n + 1];
      }
      factors_.emplace_back(A);
    }
  }

  /// dtheta_n/dp of all nodes (n_v, nodes).
  Eigen::MatrixXd motion_of(std::span<const Variant> variants) {
    const control::Layout& layout = equations_.layout();
    const Eigen::Index n_v = layout.n_v;
    const Eigen::Index n_c = layout.n_c;
    std::vector<Eigen::MatrixXd> gaps;
    Eigen::MatrixXd by_parameter = derivative(variants, [&](const Variant& variant, std::size_t) {
      const Equations moved(variant.built, motion_);
      if (n_c > 0) gaps.push_back(moved.gaps());
      return moved.balances();
    });
    Eigen::MatrixXd s = Eigen::MatrixXd::Zero(n_v, layout.n_steps + 1);
    s.col(0) = start_of(variants);
    if (starts_moving(scene_)) by_parameter.col(0) += momentum_of(variants, s.col(0));
    Eigen::MatrixXd open;
    if (n_c > 0)
      open = derivative(variants, [&](const Variant&, std::size_t i) -> Eigen::MatrixXd& { return gaps[i]; });
    Eigen::VectorXd rhs(n_v + n_c);
    for (Eigen::Index n = 0; n < layout.n_steps; ++n) {
      const auto at = static_cast<std::size_t>(n);
      rhs.head(n_v) = -by_parameter.col(n) - jacobian_.diagonal[at] * s.col(n);
      if (n > 0) rhs.head(n_v) -= jacobian_.previous[at] * s.col(n - 1);
      if (n_c > 0) {
        const Eigen::MatrixXd& Z = equations_.dynamics().node(static_cast<int>(n) + 1).Z;
        rhs.tail(n_c) = -Z.transpose() * open.col(n + 1);
      }
      s.col(n + 1) = factors_[at].solve(rhs).head(n_v);
    }
    return s;
  }

  /// The motion theta + offset s.
  control::Trajectory moved(const Eigen::MatrixXd& s, double offset, const build::BuiltModel& variant) {
    control::Trajectory path = motion_.path;
    const control::Layout& layout = equations_.layout();
    for (int n = 0; n <= layout.n_steps; ++n) {
      const control::DynamicsNode& node = equations_.dynamics().node(n);
      node.chart->stored(node.theta + offset * s.col(n), path.x[static_cast<std::size_t>(n)]);
    }
    for (std::size_t k = 0; k < path.u.size(); ++k) {
      variant.model->evaluate_controls((static_cast<double>(k) + 0.5) * path.step, path.u[k]);
    }
    return path;
  }

 private:
  const control::DynamicsNode& first() { return equations_.dynamics().node(0); }

  /// dtheta_0/dp: of the given pose, or of the equilibrium.
  Eigen::VectorXd start_of(std::span<const Variant> variants) {
    if (scene_.initial.from.kind == scene::InitialFrom::Kind::static_equilibrium) {
      const Eigen::VectorXd w = equilibrium_sensitivity(scene_, built_, motion_.path.x.front(), variants);
      const auto frame = built_.manifold->make_frame();
      built_.manifold->update(motion_.path.x.front(), first().point.q, *frame);
      Eigen::VectorXd dq = Eigen::VectorXd::Zero(built_.manifold->n_q());
      built_.manifold->lift(*frame, w, dq);
      return first().point.D.topRows(dq.size()).colPivHouseholderQr().solve(dq);
    }
    Eigen::VectorXd theta(built_.manifold->n_v());
    return derivative(variants, [&](const Variant& variant, std::size_t) -> Eigen::VectorXd& {
      first().chart->coordinates(initial_coordinates(variant.scene, variant.built), theta);
      return theta;
    });
  }

  Eigen::VectorXd momentum_of(std::span<const Variant> variants, const Eigen::VectorXd& s) {
    return derivative(variants, [&](const Variant& variant, std::size_t) {
      return initial_momentum(variant.scene, variant.built, motion_.path.x.front(), first().theta + variant.offset * s);
    });
  }

  const scene::Scene& scene_;
  const build::BuiltModel& built_;
  const Motion& motion_;
  Equations equations_;
  control::DynamicsJacobian jacobian_;
  std::vector<Eigen::PartialPivLU<Eigen::MatrixXd>> factors_;
};

}  // namespace

Outcome simulate(const scene::Scene& scene, const build::BuiltModel& built, Motion& motion) {
  variational::State state;
  Outcome outcome = initial_state(scene, built, {}, state);
  if (!outcome.completed()) return outcome;
  variational::LoopOptions options{.dt = scene.dynamics->step, .steps = scene.dynamics->n_steps()};
  options.step.tolerance = scene.solver.tolerance;
  options.step.max_iterations = scene.solver.max_iterations;
  options.step.linear = built.linear;
  motion = {};
  motion.path.step = options.dt;
  variational::LoopCallbacks callbacks;
  callbacks.record = [&](const variational::NodeRecord& node) {
    motion.path.x.push_back(node.state.x);
    motion.lambda.push_back((node.step == 0 ? 0.5 * options.dt : options.dt) * node.multipliers);
  };
  variational::Ledger ledger;
  variational::StepReport last;
  const variational::LoopResult result =
      variational::TimeLoop(*built.model, options).run(state, ledger, last, callbacks);
  motion.path.u.resize(static_cast<std::size_t>(options.steps), std::vector<double>(built.model->controls.size()));
  for (std::size_t k = 0; k < motion.path.u.size(); ++k) {
    built.model->evaluate_controls((static_cast<double>(k) + 0.5) * options.dt, motion.path.u[k]);
  }
  return {.status = result.status, .sentence = result.sentence, .time = result.t};
}

Eigen::MatrixXd observe(const scene::Scene& scene, const build::BuiltModel& built, const control::Trajectory& path,
                        const std::vector<RecordedColumn>& columns) {
  results::MemoryRecorder recorder;
  NodeRows rows(recorder, scene, built, NodeRows::Kind::dynamics, path.x.size());
  recorder.start();
  TrajectoryRows(built, path).write(rows);
  recorder.close({.status = "completed", .where = {}, .time = 0.0});
  const auto n = static_cast<Eigen::Index>(path.x.size());
  Eigen::MatrixXd out(n, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const std::span<const double> all = recorder.reals(columns[c].path);
    const std::size_t width = all.size() / path.x.size();
    for (Eigen::Index i = 0; i < n; ++i) {
      out(i, static_cast<Eigen::Index>(c)) = all[static_cast<std::size_t>(i) * width + columns[c].component];
    }
  }
  return out;
}

std::vector<Eigen::MatrixXd> sensitivities(const scene::Scene& scene, const build::BuiltModel& built,
                                           const Motion& motion, const std::vector<std::vector<Variant>>& variants,
                                           const std::vector<RecordedColumn>& columns) {
  Linearised linearised(scene, built, motion);
  std::vector<Eigen::MatrixXd> all;
  for (const std::vector<Variant>& of_parameter : variants) {
    const Eigen::MatrixXd s = linearised.motion_of(of_parameter);
    all.push_back(derivative(std::span<const Variant>(of_parameter), [&](const Variant& variant, std::size_t) {
      return observe(variant.scene, variant.built, linearised.moved(s, variant.offset, variant.built), columns);
    }));
  }
  return all;
}

std::string why_not_differentiable(const scene::Scene& scene, const build::BuiltModel& built) {
  if (!built.model->substructures.empty()) {
    return "finite elements have no sensitivities: fit the muscles of `model: lumped`, with the finite elements as the "
           "reference";
  }
  if (!scene.dynamics) return {};
  if (scene.dynamics->integrator == scene::Integrator::explicit_scheme) {
    return "the explicit integrator has no sensitivities: take integrator: midpoint";
  }
  if (scene.initial.from.kind == scene::InitialFrom::Kind::record) {
    return "a start from an earlier record has no sensitivities";
  }
  const auto chart = built.manifold->make_chart();
  const Eigen::VectorXd x = built.manifold->reference();
  chart->set_reference(x);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(built.model->n_q());
  built.manifold->configuration(x, q);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(built.model->n_q());
  std::vector<double> u(built.model->controls.size());
  built.model->evaluate_controls(0.0, u);
  const std::span<const double> view(x.data(), static_cast<std::size_t>(x.size()));
  const std::vector<double> squared(u.size(), 0.0);
  const model::IntervalPoint at{.q0 = q, .q1 = q, .q = q, .v = zero, .u = u, .dt = 1.0, .x0 = view, .x1 = view};
  const control::PieceList pieces = control::list_pieces(*built.model, *chart, at, squared);
  if (pieces.refused.empty()) return {};
  return "no sensitivities of " + base::joined(pieces.refused);
}

}  // namespace muldi::pipeline
