#include "control/turn_rows.hpp"

#include <algorithm>
#include <cmath>

namespace muldi::control {
namespace {

constexpr int body_size = 12;  // unknowns of q: position and directors

}  // namespace

TurnRows::TurnRows(const model::Model& model, const model::Chart& chart, const Eigen::VectorXd& pose, double longest)
    : longest_(longest) {
  if (!std::isfinite(longest)) return;
  constexpr double turn = 1e-3;
  const model::Manifold& manifold = *model.manifold;
  Eigen::VectorXd q0 = Eigen::VectorXd::Zero(model.n_q());
  manifold.configuration(pose, q0);
  Eigen::VectorXd q1 = q0;
  Eigen::VectorXd x = pose;
  for (int k = 0; k < manifold.n_v(); ++k) {
    if (!chart.is_coordinate(k)) continue;
    manifold.retract(pose, turn * Eigen::VectorXd::Unit(manifold.n_v(), k), x);
    manifold.configuration(x, q1);
    if (manifold.largest_rotation(q0, q1) > 0.5 * turn) rows_.push_back({.angle = k, .columns = {k}});
  }
  int first = 0;
  for (const int size : model.node_sizes) {
    const int directors = first + 3;
    first += size;
    if (size != body_size) continue;
    const std::vector<int>& columns = chart.columns_of(directors);
    const bool on_ball = std::any_of(columns.begin(), columns.end(), [&](int k) { return !chart.is_coordinate(k); });
    if (on_ball) rows_.push_back({.directors = directors, .columns = columns});
  }
}

double TurnRows::lower(int row) const { return at(row).angle >= 0 ? -longest_ : 1.0 + 2.0 * std::cos(longest_); }

double TurnRows::upper(int row) const { return at(row).angle >= 0 ? longest_ : infinity; }

double TurnRows::value(int row, int interval, const DiscreteDynamics& dynamics) const {
  const DynamicsNode& begin = dynamics.node(interval);
  const DynamicsNode& end = dynamics.node(interval + 1);
  const Row& r = at(row);
  if (r.angle >= 0) return end.theta[r.angle] - begin.theta[r.angle];
  return begin.point.q.segment<9>(r.directors).dot(end.point.q.segment<9>(r.directors));
}

void TurnRows::derivatives(int row, int interval, const DiscreteDynamics& dynamics, Eigen::VectorXd& by_begin,
                           Eigen::VectorXd& by_end) const {
  const model::ChartPoint& begin = dynamics.node(interval).point;
  const model::ChartPoint& end = dynamics.node(interval + 1).point;
  const Row& r = at(row);
  const auto n = static_cast<Eigen::Index>(r.columns.size());
  if (r.angle >= 0) {
    by_begin = Eigen::VectorXd::Constant(1, -1.0);
    by_end = Eigen::VectorXd::Constant(1, 1.0);
    return;
  }
  by_begin.resize(n);
  by_end.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int k = r.columns[static_cast<std::size_t>(i)];
    by_begin[i] = begin.D.col(k).segment<9>(r.directors).dot(end.q.segment<9>(r.directors));
    by_end[i] = end.D.col(k).segment<9>(r.directors).dot(begin.q.segment<9>(r.directors));
  }
}

void TurnRows::add_hessian(int row, int interval, double factor, const DiscreteDynamics& dynamics,
                           DynamicsHessian& out) const {
  const Row& r = at(row);
  if (r.angle >= 0) return;
  const auto n = static_cast<std::size_t>(interval);
  const model::ChartPoint& begin = dynamics.node(interval).point;
  const model::ChartPoint& end = dynamics.node(interval + 1).point;
  out.y[n].segment<9>(r.directors) += factor * end.q.segment<9>(r.directors);
  out.y[n + 1].segment<9>(r.directors) += factor * begin.q.segment<9>(r.directors);
  for (const int i : r.columns) {
    for (const int j : r.columns) {
      out.below[n](i, j) += factor * end.D.col(i).segment<9>(r.directors).dot(begin.D.col(j).segment<9>(r.directors));
    }
  }
}

}  // namespace muldi::control
