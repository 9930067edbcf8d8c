#include "pipeline/study/simulated_equilibria.hpp"

#include <Eigen/LU>

#include "pipeline/initial_state.hpp"
#include "pipeline/run_statics.hpp"
#include "pipeline/study/simulated_motion.hpp"
#include "results/memory_recorder.hpp"

namespace muldi::pipeline {
namespace {

using statics::EquilibriumSolver;
using statics::StaticState;

std::vector<double> controls_at(const StaticLoads& loads, double load) {
  std::vector<double> u = loads.fixed;
  for (std::size_t c = 0; c < u.size(); ++c) u[c] += load * loads.direction[c];
  return u;
}

/// Motion of an equilibrium with a parameter. `controls(variant)`: those of the variant.
template <class Controls>
statics::StaticMotion motion_of(const build::BuiltModel& built, const StaticState& state, std::span<const double> u,
                                std::span<const Variant> variants, const Controls& controls) {
  EquilibriumSolver solver(*built.model, {});
  solver.linearise(state, u);
  const Eigen::Index n_v = built.manifold->n_v();
  const Eigen::Index n_c = built.manifold->n_c();
  Eigen::VectorXd rows(n_v + built.manifold->n_loop_rows());
  const Eigen::VectorXd by_parameter =
      derivative(variants, [&](const Variant& variant, std::size_t) -> Eigen::VectorXd& {
        EquilibriumSolver moved(*variant.built.model, {});
        moved.linearise(state, controls(variant));
        Eigen::VectorXd gaps(built.manifold->n_loop_rows());
        variant.built.manifold->constraints(moved.configuration(), gaps);
        rows << moved.residual(), gaps;
        return rows;
      });
  const Eigen::VectorXd scale = solver.scale();
  Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(n_v + n_c, n_v + n_c);
  const Eigen::MatrixXd B = solver.loop_rows() * scale.asDiagonal();
  kkt.topLeftCorner(n_v, n_v) = scale.asDiagonal() * solver.tangent() * scale.asDiagonal();
  kkt.topRightCorner(n_v, n_c) = B.transpose();
  kkt.bottomLeftCorner(n_c, n_v) = B;
  Eigen::VectorXd rhs(n_v + n_c);
  rhs.head(n_v) = scale.cwiseProduct(by_parameter.head(n_v));
  rhs.tail(n_c) = -solver.loop_basis().transpose() * by_parameter.tail(built.manifold->n_loop_rows());
  const Eigen::VectorXd solution = kkt.partialPivLu().solve(rhs);
  return {.w = scale.cwiseProduct(solution.head(n_v)), .multipliers = solver.loop_basis() * solution.tail(n_c)};
}

/// Observed rows, `moved(i)` the state of the i-th.
template <class State>
Eigen::MatrixXd rows_at(const scene::Scene& scene, const build::BuiltModel& built,
                        const std::vector<EquilibriumPoint>& points, const std::vector<RecordedColumn>& columns,
                        const State& moved) {
  results::MemoryRecorder recorder;
  EquilibriumRows rows(recorder, scene, built);
  recorder.start();
  const StaticLoads loads = static_loads(scene, built);
  EquilibriumSolver solver(*built.model, {});
  statics::EquilibriumReport report;
  report.converged = true;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const StaticState state = moved(i);
    const std::vector<double> u = controls_at(loads, points[i].load);
    solver.linearise(state, u);
    rows.write({.load = points[i].load,
                .state = state,
                .q = solver.configuration(),
                .y = solver.stage(),
                .force = solver.force(),
                .u = u,
                .report = report});
  }
  recorder.close({.status = "completed", .where = {}, .time = 0.0});
  Eigen::MatrixXd out(static_cast<Eigen::Index>(points.size()), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const std::span<const double> all = recorder.reals(columns[c].path);
    const std::size_t width = all.size() / points.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
      out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) = all[i * width + columns[c].component];
    }
  }
  return out;
}

StaticState moved_along(const build::BuiltModel& built, const StaticState& state, const statics::StaticMotion& motion,
                        double offset) {
  StaticState out = state;
  built.manifold->retract(state.x, offset * motion.w, out.x);
  out.multipliers = state.multipliers + offset * motion.multipliers;
  return out;
}

}  // namespace

Outcome find_equilibria(const scene::Scene& scene, const build::BuiltModel& built,
                        std::vector<EquilibriumPoint>& points) {
  StaticState state = starting_point(scene, built);
  StaticLoads loads = static_loads(scene, built);
  statics::Sweep sweep(*built.model, std::move(loads.fixed), std::move(loads.direction), loads.options);
  points.clear();
  const statics::SweepResult result = sweep.run(state, {.record = [&](const statics::SweepPoint& point) {
                                                  points.push_back({point.load, point.state});
                                                }});
  using End = statics::SweepResult::End;
  if (result.end == End::completed) return {};
  return {.status = result.end == End::loss_of_equilibrium ? variational::Status::loss_of_equilibrium
                                                           : variational::Status::no_convergence,
          .sentence = result.sentence};
}

Eigen::MatrixXd observe_equilibria(const scene::Scene& scene, const build::BuiltModel& built,
                                   const std::vector<EquilibriumPoint>& points,
                                   const std::vector<RecordedColumn>& columns) {
  return rows_at(scene, built, points, columns, [&](std::size_t i) { return points[i].state; });
}

std::vector<Eigen::MatrixXd> equilibrium_sensitivities(const scene::Scene& scene, const build::BuiltModel& built,
                                                       const std::vector<EquilibriumPoint>& points,
                                                       const std::vector<std::vector<Variant>>& variants,
                                                       const std::vector<RecordedColumn>& columns) {
  std::vector<Eigen::MatrixXd> all;
  const StaticLoads loads = static_loads(scene, built);
  for (const std::vector<Variant>& of_parameter : variants) {
    std::vector<statics::StaticMotion> motions;
    motions.reserve(points.size());
    for (const EquilibriumPoint& point : points) {
      motions.push_back(motion_of(
          built, point.state, controls_at(loads, point.load), of_parameter,
          [&](const Variant& variant) { return controls_at(static_loads(variant.scene, variant.built), point.load); }));
    }
    all.push_back(derivative(std::span<const Variant>(of_parameter), [&](const Variant& variant, std::size_t) {
      return rows_at(variant.scene, variant.built, points, columns,
                     [&](std::size_t i) { return moved_along(built, points[i].state, motions[i], variant.offset); });
    }));
  }
  return all;
}

Eigen::VectorXd equilibrium_sensitivity(const scene::Scene&, const build::BuiltModel& built, const Eigen::VectorXd& x,
                                        std::span<const Variant> variants) {
  const auto controls = [](const build::BuiltModel& of) {
    std::vector<double> u(of.model->controls.size());
    of.model->evaluate_controls(0.0, u);
    return u;
  };
  // The multipliers of the loops follow from the equilibrium itself.
  StaticState state{.x = x, .multipliers = Eigen::VectorXd::Zero(built.manifold->n_loop_rows())};
  EquilibriumSolver(*built.model, {}).solve(state, controls(built));
  return motion_of(built, state, controls(built), variants,
                   [&](const Variant& variant) { return controls(variant.built); })
      .w;
}

}  // namespace muldi::pipeline
