#include "control/limit_rows.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace muldi::control {
namespace {

std::vector<int> columns_of_muscle(const model::LimitedMuscle& muscle, const model::Chart& chart) {
  if (muscle.entry >= 0) return chart.columns_of(muscle.entry);
  std::set<int> columns;
  for (const model::LinearPoint& end : muscle.ends) {
    const std::vector<int> of_end = columns_of(end, chart);
    columns.insert(of_end.begin(), of_end.end());
  }
  return {columns.begin(), columns.end()};
}

}  // namespace

LimitRows::LimitRows(const Problem& problem, const Layout& layout, const model::Chart& chart, double length)
    : problem_(problem), n_steps_(layout.n_steps) {
  add_cut_rows(problem.limits, chart, length);
  for (const PointLimit& limit : problem.limits.points) {
    for (int n = 1; n <= n_steps_; ++n) {
      for (int k = 0; k < 3; ++k) {
        if (limit.lower[k] == -infinity && limit.upper[k] == infinity) continue;
        rows_.push_back({.name = "limits." + limit.name,
                         .lower = limit.lower[k] / length,
                         .upper = limit.upper[k] / length,
                         .node = n,
                         .point = limit.point,
                         .component = k,
                         .scale = 1.0 / length});
      }
    }
  }
  if (problem.limits.true_field || problem.limits.pull_in_margin) {
    for (const auto& term : problem.model.terms) term->list_limited(muscles_);
    for (const model::LimitedMuscle& muscle : muscles_) {
      int choice = -1;
      for (std::size_t c = 0; c < problem.controls.size(); ++c) {
        if (problem.controls[c].control == muscle.control) choice = static_cast<int>(c);
      }
      choice_of_muscle_.push_back(choice);
    }
    add_muscle_rows(problem.limits);
  }
  for (const LimitRow& row : rows_) {
    if (row.cut >= 0) {
      columns_.push_back(cut_[static_cast<std::size_t>(row.cut)].columns());
    } else if (row.muscle >= 0) {
      columns_.push_back(columns_of_muscle(muscles_[static_cast<std::size_t>(row.muscle)], chart));
    } else {
      columns_.push_back(columns_of(row.point, chart));
    }
  }
}

void LimitRows::add_cut_rows(const PathLimits& limits, const model::Chart& chart, double length) {
  for (const CoordinateLimit& limit : limits.coordinates) {
    if (!limit.cut) continue;
    // Angles are those within half a turn of the middle of the range, or of its one end.
    const bool both = std::isfinite(limit.lower) && std::isfinite(limit.upper);
    const double from = both                         ? 0.5 * (limit.lower + limit.upper)
                        : std::isfinite(limit.lower) ? limit.lower
                                                     : limit.upper;
    if (!std::isfinite(from)) continue;
    const double scale = limit.cut->is_angle() ? 1.0 : 1.0 / length;
    for (int n = 1; n <= n_steps_; ++n) {
      rows_.push_back({.name = "limits." + limit.name,
                       .lower = scale * (limit.lower - from),
                       .upper = scale * (limit.upper - from),
                       .node = n,
                       .cut = static_cast<int>(cut_.size()),
                       .from = from,
                       .scale = scale});
    }
    cut_.emplace_back(*limit.cut, chart);
  }
}

void LimitRows::add_muscle_rows(const PathLimits& limits) {
  for (int k = 0; k < n_steps_; ++k) {
    for (int end = 0; end < 2; ++end) {
      for (std::size_t m = 0; m < muscles_.size(); ++m) {
        LimitRow row{
            .name = {}, .node = k + end, .interval = k, .choice = choice_of_muscle_[m], .muscle = static_cast<int>(m)};
        if (limits.true_field) {
          row.name = "limits.true_field of " + muscles_[m].name;
          row.upper = 1.0;
          rows_.push_back(row);
        }
        if (limits.pull_in_margin) {
          row.name = "limits.pull_in_margin of " + muscles_[m].name;
          row.is_margin = true;
          row.lower = *limits.pull_in_margin;
          row.upper = infinity;
          rows_.push_back(row);
        }
      }
    }
  }
}

LimitRows::Length LimitRows::length(const model::LimitedMuscle& muscle, const Eigen::VectorXd& q) const {
  if (muscle.entry >= 0) return {q[muscle.entry], Eigen::Vector3d::UnitX()};
  const Eigen::Vector3d r = muscle.ends[0].value(q) - muscle.ends[1].value(q);
  const double z = r.norm();
  return {z, r / z};
}

LimitRows::Parts LimitRows::parts(const LimitRow& row, double z, const DiscreteDynamics& dynamics, double w) const {
  const model::LimitedMuscle& muscle = muscles_[static_cast<std::size_t>(row.muscle)];
  Parts out{};
  if (row.is_margin) {
    const auto stiffness = muscle.stiffness(z);
    out.alpha = stiffness.elastic;
    out.beta = stiffness.electric;
  } else {
    const double allowed = *problem_.limits.true_field;
    const double value = muscle.rest_length * muscle.rest_length / (z * z * allowed * allowed);
    out.beta = {value, -2.0 * value / z, 6.0 * value / (z * z)};
  }
  if (row.choice < 0) {
    double field = muscle.constant_field;
    if (muscle.control >= 0) {
      field = muscle.control_factor * dynamics.interval(row.interval).u[static_cast<std::size_t>(muscle.control)];
    }
    out.kappa = {field * field, 0.0, 0.0};
    return out;
  }
  const ControlChoice& choice = problem_.controls[static_cast<std::size_t>(row.choice)];
  const double largest = muscle.control_factor * choice.reference;
  const double square = largest * largest;
  if (choice.kind == ControlKind::squared) {
    out.kappa = {square * w, square, 0.0};
  } else {
    out.kappa = {square * w * w, 2.0 * square * w, 2.0 * square};
  }
  return out;
}

Eigen::RowVectorXd LimitRows::slope(const model::LimitedMuscle& muscle, const Length& at,
                                    const Eigen::MatrixXd& D) const {
  if (muscle.entry >= 0) return D.row(muscle.entry);
  Eigen::MatrixXd first(3, D.cols());
  Eigen::MatrixXd second(3, D.cols());
  project_point(muscle.ends[0], D, first);
  project_point(muscle.ends[1], D, second);
  return at.n.transpose() * (first - second);
}

double LimitRows::value(const LimitRow& row, const DiscreteDynamics& dynamics, double w) const {
  const model::ChartPoint& point = dynamics.node(row.node).point;
  const Eigen::VectorXd& q = point.q;
  if (row.cut >= 0) return row.scale * cut_[static_cast<std::size_t>(row.cut)].offset(point, row.from);
  if (row.muscle < 0) return row.scale * row.point.value(q)[row.component];
  const Parts p = parts(row, length(muscles_[static_cast<std::size_t>(row.muscle)], q).z, dynamics, w);
  return p.alpha[0] + p.kappa[0] * p.beta[0];
}

LimitDerivatives LimitRows::derivatives(const LimitRow& row, const DiscreteDynamics& dynamics, double w) const {
  const model::ChartPoint& point = dynamics.node(row.node).point;
  LimitDerivatives out;
  if (row.cut >= 0) {
    out.value = value(row, dynamics, w);
    out.by_theta = row.scale * cut_[static_cast<std::size_t>(row.cut)].gradient(point);
    return out;
  }
  if (row.muscle < 0) {
    Eigen::MatrixXd block(3, point.D.cols());
    project_point(row.point, point.D, block);
    out.value = row.scale * row.point.value(point.q)[row.component];
    out.by_theta = row.scale * block.row(row.component);
    return out;
  }
  const model::LimitedMuscle& muscle = muscles_[static_cast<std::size_t>(row.muscle)];
  const Length at = length(muscle, point.q);
  const Parts p = parts(row, at.z, dynamics, w);
  out.value = p.alpha[0] + p.kappa[0] * p.beta[0];
  out.by_theta = (p.alpha[1] + p.kappa[0] * p.beta[1]) * slope(muscle, at, point.D);
  out.by_w = p.kappa[1] * p.beta[0];
  return out;
}

void LimitRows::add_hessian(const LimitRow& row, double factor, const DiscreteDynamics& dynamics, double w,
                            DynamicsHessian& out) const {
  const auto n = static_cast<std::size_t>(row.node);
  const model::ChartPoint& point = dynamics.node(row.node).point;
  if (row.cut >= 0) {
    cut_[static_cast<std::size_t>(row.cut)].add_hessian(factor * row.scale, point, out.y[n], out.diagonal[n]);
    return;
  }
  if (row.muscle < 0) {
    row.point.add_transposed(factor * row.scale * Eigen::Vector3d::Unit(row.component), out.y[n]);
    return;
  }
  const model::LimitedMuscle& muscle = muscles_[static_cast<std::size_t>(row.muscle)];
  const Length at = length(muscle, point.q);
  const Parts p = parts(row, at.z, dynamics, w);
  const Eigen::RowVectorXd z_theta = slope(muscle, at, point.D);
  const double by_z = factor * (p.alpha[1] + p.kappa[0] * p.beta[1]);
  const double by_zz = factor * (p.alpha[2] + p.kappa[0] * p.beta[2]);
  out.diagonal[n].noalias() += by_zz * z_theta.transpose() * z_theta;
  if (muscle.entry >= 0) {
    out.y[n][muscle.entry] += by_z;
  } else {
    Eigen::MatrixXd first(3, point.D.cols());
    Eigen::MatrixXd second(3, point.D.cols());
    project_point(muscle.ends[0], point.D, first);
    project_point(muscle.ends[1], point.D, second);
    first -= second;
    out.diagonal[n].noalias() += by_z / at.z * (first.transpose() * first - z_theta.transpose() * z_theta);
    muscle.ends[0].add_transposed(by_z * at.n, out.y[n]);
    muscle.ends[1].add_transposed(-by_z * at.n, out.y[n]);
  }
  if (row.choice < 0) return;
  const auto k = static_cast<std::size_t>(row.interval);
  Eigen::MatrixXd& mixed = row.node == row.interval ? out.w_begin[k] : out.w_end[k];
  mixed.row(row.choice) += factor * p.kappa[1] * p.beta[1] * z_theta;
  out.ww[k](row.choice, row.choice) += factor * p.kappa[2] * p.beta[0];
}

}  // namespace muldi::control
