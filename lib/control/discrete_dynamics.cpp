#include "control/discrete_dynamics.hpp"

#include <algorithm>
#include <cmath>

#include "control/end_pieces.hpp"
#include "control/interval_blocks.hpp"

namespace muldi::control {
namespace {

void zero(Matrices& blocks) {
  for (Eigen::MatrixXd& block : blocks) block.setZero();
}
void zero(Vectors& blocks) {
  for (Eigen::VectorXd& block : blocks) block.setZero();
}
Matrices zeros(int count, Eigen::Index rows, Eigen::Index columns) {
  return Matrices(static_cast<std::size_t>(count), Eigen::MatrixXd::Zero(rows, columns));
}
Vectors zeros(int count, Eigen::Index size) {
  return Vectors(static_cast<std::size_t>(count), Eigen::VectorXd::Zero(size));
}

std::span<const double> view(const Eigen::VectorXd& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }

/// out += factor a^T b, for few columns without the set-up of a blocked product.
void add_product(double factor, const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, Eigen::MatrixXd& out) {
  constexpr Eigen::Index few = 16;
  if (out.cols() <= few) {
    out += factor * a.transpose().lazyProduct(b);
  } else {
    out.noalias() += factor * a.transpose() * b;
  }
}

/// out += factor (A^T M D + D^T M A).
void add_both(double factor, const DynamicsNode& node, Eigen::MatrixXd& out) {
  Eigen::MatrixXd half = Eigen::MatrixXd::Zero(out.rows(), out.cols());
  add_product(factor, node.point.A, node.MD, half);
  out += half + half.transpose();
}

/// D^T (d2g/dq2) D2 of one bilinear row.
void add_bilinear(const model::Bilinear& row, double factor, const Eigen::MatrixXd& D, const Eigen::MatrixXd& D2,
                  Eigen::MatrixXd& out) {
  Eigen::MatrixXd a(3, D.cols());
  Eigen::MatrixXd b(3, D.cols());
  project_point(row.a, D, a);
  project_point(row.b, D2, b);
  out.noalias() += factor * row.scale * a.transpose() * b;
  project_point(row.b, D, b);
  project_point(row.a, D2, a);
  out.noalias() += factor * row.scale * b.transpose() * a;
}

}  // namespace

void DynamicsJacobian::resize(const Layout& layout) {
  const int n = layout.n_steps + 1;
  previous = diagonal = next = zeros(n, layout.n_v, layout.n_v);
  by_w_before = by_w_after = zeros(n, layout.n_v, layout.n_u);
  by_step = zeros(n, layout.n_v);
  by_lambda = zeros(n, layout.n_v, layout.n_c);
  closing = zeros(n, layout.n_c, layout.n_v);
}

void DynamicsJacobian::set_zero() {
  for (Matrices* blocks : {&previous, &diagonal, &next, &by_w_before, &by_w_after, &by_lambda, &closing}) zero(*blocks);
  zero(by_step);
}

void DynamicsHessian::resize(const Layout& layout, Eigen::Index n_q) {
  const int n = layout.n_steps + 1;
  diagonal = zeros(n, layout.n_v, layout.n_v);
  below = zeros(n - 1, layout.n_v, layout.n_v);
  w_begin = w_end = zeros(n - 1, layout.n_u, layout.n_v);
  ww = zeros(n - 1, layout.n_u, layout.n_u);
  lambda = zeros(n, layout.n_c, layout.n_v);
  step_theta = zeros(n, layout.n_v);
  step_w = zeros(n - 1, layout.n_u);
  y = zeros(n, n_q);
}

void DynamicsHessian::set_zero() {
  for (Matrices* blocks : {&diagonal, &below, &w_begin, &w_end, &ww, &lambda}) zero(*blocks);
  for (Vectors* blocks : {&step_theta, &step_w, &y}) zero(*blocks);
  step_step = 0.0;
}

DiscreteDynamics::DiscreteDynamics(const Problem& problem, const Layout& layout, const Trajectory& guess)
    : problem_(problem),
      model_(problem.model),
      layout_(layout),
      squared_(problem.model.controls.size(), 0.0),
      choice_of_control_(problem.model.controls.size(), -1),
      nodes_(static_cast<std::size_t>(layout.n_steps + 1)),
      intervals_(static_cast<std::size_t>(layout.n_steps)) {
  for (std::size_t c = 0; c < problem.controls.size(); ++c) {
    const ControlChoice& choice = problem.controls[c];
    choice_of_control_[static_cast<std::size_t>(choice.control)] = static_cast<int>(c);
    if (choice.kind == ControlKind::squared) squared_[static_cast<std::size_t>(choice.control)] = choice.reference;
  }
  const model::Manifold& manifold = *model_.manifold;
  const auto frame = manifold.make_frame();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(model_.n_q());
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    DynamicsNode& node = nodes_[n];
    node.chart = manifold.make_chart();
    node.chart->set_reference(guess.x[n]);
    node.theta = Eigen::VectorXd::Zero(layout.n_v);
    node.x = guess.x[n];
    node.bracket = Eigen::VectorXd::Zero(model_.n_q());
    node.MD = node.MA = Eigen::MatrixXd::Zero(model_.n_q(), layout.n_v);
    node.lambda = Eigen::VectorXd::Zero(manifold.n_loop_rows());
    if (layout.n_c == 0) continue;
    manifold.configuration(guess.x[n], q);
    manifold.update(guess.x[n], q, *frame);
    manifold.choose_loop_rows(*frame);
    node.Z = manifold.loop_basis(*frame);
  }
  a_mid_ = a_rate_ = M_rate_ = Eigen::VectorXd::Zero(model_.n_q());
  for (DynamicsInterval& interval : intervals_) {
    interval.q = interval.v = Eigen::VectorXd::Zero(model_.n_q());
    interval.u.assign(model_.controls.size(), 0.0);
    interval.forces.force = interval.forces.momentum = Eigen::VectorXd::Zero(model_.n_q());
    interval.forces.on_rates = Eigen::VectorXd::Zero(layout.n_v);
    if (model_.acts_at_ends()) interval.forces.begin = interval.forces.end = interval.q;
  }
  manifold.configuration(guess.x[0], q);
  model_.evaluate_controls(0.0, intervals_[0].u);
  const model::IntervalPoint at{.q0 = q,
                                .q1 = q,
                                .q = q,
                                .v = a_mid_,
                                .u = intervals_[0].u,
                                .dt = 1.0,
                                .x0 = view(guess.x[0]),
                                .x1 = view(guess.x[0])};
  pieces_ = list_pieces(model_, *nodes_[0].chart, at, squared_);
  for (DynamicsNode& node : nodes_) node.J = node.A = Matrices(pieces_.pieces.size());
}

double DiscreteDynamics::control_value(int choice, double w) const {
  const ControlChoice& c = problem_.controls[static_cast<std::size_t>(choice)];
  return c.reference * (c.kind == ControlKind::squared ? std::sqrt(std::max(w, 0.0)) : w);
}

double DiscreteDynamics::control_unknown(int choice, double u) const {
  const ControlChoice& c = problem_.controls[static_cast<std::size_t>(choice)];
  const double relative = u / c.reference;
  return c.kind == ControlKind::squared ? relative * relative : relative;
}

model::IntervalPoint DiscreteDynamics::point_of(int k) const {
  const DynamicsInterval& at = interval(k);
  return {.q0 = node(k).point.q,
          .q1 = node(k + 1).point.q,
          .q = at.q,
          .v = at.v,
          .u = at.u,
          .dt = h_,
          .x0 = view(node(k).x),
          .x1 = view(node(k + 1).x),
          .first = k == 0};
}

bool DiscreteDynamics::move_to(const Eigen::VectorXd& unknowns) {
  has_pieces_ = false;
  h_ = layout_.step >= 0 ? unknowns[layout_.step] : problem_.horizon.shortest_step;
  for (int n = 0; n <= layout_.n_steps; ++n) {
    DynamicsNode& at = node(n);
    at.theta = unknowns.segment(layout_.theta(n, 0), layout_.n_v);
    if (!at.theta.allFinite()) return false;
    at.chart->stored(at.theta, at.x);
    at.chart->evaluate(at.theta, at.point);
    at.bracket.setZero();
    if (layout_.lambda(n, 0) < 0) continue;
    at.lambda.noalias() = at.Z * unknowns.segment(layout_.lambda(n, 0), layout_.n_c);
    model_.manifold->add_constraint_forces(at.point.q, -1.0, at.lambda, at.bracket);
  }
  for (int k = 0; k < layout_.n_steps; ++k) {
    DynamicsInterval& at = intervals_[static_cast<std::size_t>(k)];
    at.q = 0.5 * (node(k).point.q + node(k + 1).point.q);
    at.v = (node(k + 1).point.q - node(k).point.q) / h_;
    model_.evaluate_controls((k + 0.5) * h_, at.u);
    for (int c = 0; c < layout_.n_u; ++c) {
      const auto control = static_cast<std::size_t>(problem_.controls[static_cast<std::size_t>(c)].control);
      at.u[control] = control_value(c, unknowns[layout_.w(k, c)]);
    }
    if (!model_.inadmissible(at.q).empty()) return false;
    model_.forces(point_of(k), at.forces);
    node(k).bracket += 0.5 * h_ * at.forces.force - at.forces.momentum;
    node(k + 1).bracket += 0.5 * h_ * at.forces.force + at.forces.momentum;
    if (at.forces.begin.size() > 0) {
      node(k).bracket += at.forces.begin;
      node(k + 1).bracket += at.forces.end;
    }
    if (!at.forces.force.allFinite()) return false;
  }
  return true;
}

void DiscreteDynamics::balance(int n, Eigen::VectorXd& out) const {
  out.noalias() = node(n).point.D.transpose() * node(n).bracket;
  if (n > 0) out += 0.5 * h_ * interval(n - 1).forces.on_rates;
  if (n < layout_.n_steps) out += 0.5 * h_ * interval(n).forces.on_rates;
}

void DiscreteDynamics::closing(int n, Eigen::VectorXd& out) const {
  Eigen::VectorXd g(node(n).lambda.size());
  model_.manifold->constraints(node(n).point.q, g);
  out.noalias() = node(n).Z.transpose() * g;
}

void DiscreteDynamics::update_pieces(DynamicsNode& at, bool along) const {
  if (!has_pieces_) pieces_.multiply_mass_of_chart(at.point.D, at.MD);
  if (along) pieces_.multiply_mass_of_chart(at.point.A, at.MA);
  for (std::size_t p = 0; p < pieces_.pieces.size(); ++p) {
    const Piece& piece = pieces_.pieces[p];
    if (piece.coordinate != nullptr) {
      const EndPiece at_node(piece, at.point, along);
      at.J[p] = at_node.J();
      if (along) at.A[p] = at_node.A();
      continue;
    }
    if (!has_pieces_) piece.project(at.point.D, at.J[p]);
    if (!along) continue;
    if (piece.rate >= 0) {
      at.A[p].setZero(1, 1);
    } else {
      piece.project(at.point.A, at.A[p]);
    }
  }
}

void DiscreteDynamics::add_constant_blocks(int k, DynamicsJacobian& out) const {
  const auto at = static_cast<std::size_t>(k);
  const Eigen::MatrixXd& D_0 = node(k).point.D;
  const Eigen::MatrixXd& D_1 = node(k + 1).point.D;
  add_product(-1.0 / h_, D_0, node(k + 1).MD, out.next[at]);
  add_product(-1.0 / h_, node(k + 1).MD, D_0, out.previous[at + 1]);
  // Both intervals of a node have the same share on it.
  if (k == 0) add_product(1.0 / h_, D_0, node(0).MD, out.diagonal[0]);
  add_product(k + 1 < layout_.n_steps ? 2.0 / h_ : 1.0 / h_, D_1, node(k + 1).MD, out.diagonal[at + 1]);
  if (layout_.step < 0) return;
  // d/dh of h/2 F and of M (q_1 - q_0)/h.
  Eigen::VectorXd M_rate(model_.n_q());
  pieces_.multiply_mass(interval(k).v, M_rate);
  const Eigen::VectorXd& F = interval(k).forces.force;
  const Eigen::VectorXd& Q = interval(k).forces.on_rates;
  out.by_step[at] += D_0.transpose() * (0.5 * F + M_rate / h_) + 0.5 * Q;
  out.by_step[at + 1] += D_1.transpose() * (0.5 * F - M_rate / h_) + 0.5 * Q;
}

void DiscreteDynamics::add_loop_blocks(int n, DynamicsJacobian& out) const {
  const auto at = static_cast<std::size_t>(n);
  const std::vector<model::Bilinear>& rows = model_.manifold->loop_rows();
  Eigen::MatrixXd GD(static_cast<Eigen::Index>(rows.size()), layout_.n_v);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(model_.n_q());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    gradient.setZero();
    rows[i].add_gradient(node(n).point.q, 1.0, gradient);
    GD.row(static_cast<Eigen::Index>(i)).noalias() = gradient.transpose() * node(n).point.D;
    if (layout_.lambda(n, 0) < 0) continue;
    add_bilinear(rows[i], -node(n).lambda[static_cast<Eigen::Index>(i)], node(n).point.D, node(n).point.D,
                 out.diagonal[at]);
  }
  out.closing[at].noalias() = node(n).Z.transpose() * GD;
  out.by_lambda[at] = -out.closing[at].transpose();
}

void DiscreteDynamics::jacobian(DynamicsJacobian& out) {
  out.set_zero();
  std::vector<double> slopes;
  for (const ControlChoice& choice : problem_.controls) {
    slopes.push_back(choice.kind == ControlKind::squared ? choice.reference * choice.reference : choice.reference);
  }
  for (int n = 0; n <= layout_.n_steps; ++n) update_pieces(node(n), false);
  has_pieces_ = true;
  for (int k = 0; k < layout_.n_steps; ++k) {
    add_constant_blocks(k, out);
    const IntervalFrame frame{pieces_, layout_, node(k), node(k + 1), interval(k).v, choice_of_control_, slopes, h_, k};
    JacobianSink sink(frame, out);
    for (const auto& term : model_.terms) term->expand(point_of(k), {.squared = squared_}, sink);
  }
  for (int n = 0; n <= layout_.n_steps; ++n) {
    node(n).chart->add_curvature(node(n).bracket, out.diagonal[static_cast<std::size_t>(n)]);
    if (layout_.n_c > 0) add_loop_blocks(n, out);
  }
}

void DiscreteDynamics::add_constant_blocks(int k, DynamicsHessian& out) {
  const auto at = static_cast<std::size_t>(k);
  DynamicsNode& begin = node(k);
  DynamicsNode& end = node(k + 1);
  const double share = k + 1 < layout_.n_steps ? 2.0 / h_ : 1.0 / h_;
  if (k == 0) add_both(1.0 / h_, begin, out.diagonal[0]);
  add_both(share, end, out.diagonal[at + 1]);
  add_product(-1.0 / h_, end.point.A, begin.MD, out.below[at]);
  add_product(-1.0 / h_, end.point.D, begin.MA, out.below[at]);
  pieces_.multiply_mass(a_rate_, M_rate_);
  out.y[at] -= M_rate_;
  out.y[at + 1] += M_rate_;
  if (layout_.step < 0) return;
  const Eigen::VectorXd by_q = M_rate_ / h_;
  out.step_step += 2.0 * M_rate_.dot(interval(k).v) / h_;
  pieces_.multiply_mass(interval(k).v, M_rate_);
  const Eigen::VectorXd& F = interval(k).forces.force;
  out.step_theta[at] += begin.point.D.transpose() * by_q + begin.point.A.transpose() * (0.5 * F + M_rate_ / h_);
  out.step_theta[at + 1] += end.point.A.transpose() * (0.5 * F - M_rate_ / h_) - end.point.D.transpose() * by_q;
}

void DiscreteDynamics::add_loop_blocks(int n, const Eigen::VectorXd& nu, DynamicsHessian& out) const {
  const auto at = static_cast<std::size_t>(n);
  const model::ChartPoint& point = node(n).point;
  const std::vector<model::Bilinear>& rows = model_.manifold->loop_rows();
  const Eigen::VectorXd weights = node(n).Z * nu;
  const bool balanced = layout_.lambda(n, 0) >= 0;
  Eigen::MatrixXd by_lambda(static_cast<Eigen::Index>(rows.size()), layout_.n_v);
  Eigen::VectorXd gradient(model_.n_q());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    rows[i].add_gradient(point.q, weights[row], out.y[at]);
    add_bilinear(rows[i], weights[row], point.D, point.D, out.diagonal[at]);
    if (!balanced) continue;
    // -lambda a . grad g.
    const double factor = -node(n).lambda[row];
    rows[i].add_hessian_times(point.a, factor, out.y[at]);
    add_bilinear(rows[i], factor, point.A, point.D, out.diagonal[at]);
    add_bilinear(rows[i], factor, point.D, point.A, out.diagonal[at]);
    gradient.setZero();
    rows[i].add_gradient(point.q, -1.0, gradient);
    by_lambda.row(row).noalias() = gradient.transpose() * point.A;
    gradient.setZero();
    rows[i].add_hessian_times(point.a, -1.0, gradient);
    by_lambda.row(row).noalias() += gradient.transpose() * point.D;
  }
  if (balanced) out.lambda[at].noalias() += node(n).Z.transpose() * by_lambda;
}

void DiscreteDynamics::hessian(const Vectors& m, const Vectors& nu, DynamicsHessian& out) {
  out.set_zero();
  std::vector<double> slopes;
  for (const ControlChoice& choice : problem_.controls) {
    slopes.push_back(choice.kind == ControlKind::squared ? choice.reference * choice.reference : choice.reference);
  }
  for (int n = 0; n <= layout_.n_steps; ++n) {
    DynamicsNode& at = node(n);
    at.chart->evaluate_along(at.theta, m[static_cast<std::size_t>(n)], at.point);
    update_pieces(at, true);
  }
  has_pieces_ = true;
  for (int k = 0; k < layout_.n_steps; ++k) {
    const auto at = static_cast<std::size_t>(k);
    a_mid_ = 0.5 * (node(k).point.a + node(k + 1).point.a);
    a_rate_ = (node(k + 1).point.a - node(k).point.a) / h_;
    add_constant_blocks(k, out);
    const IntervalFrame frame{pieces_, layout_, node(k), node(k + 1), interval(k).v, choice_of_control_, slopes, h_, k};
    const AdjointFrame adjoint{m[at], m[at + 1], a_mid_, a_rate_};
    HessianSink sink(frame, adjoint, out);
    for (const auto& term : model_.terms) {
      term->expand(point_of(k), {.squared = squared_, .a = &a_mid_, .b = &a_rate_}, sink);
    }
  }
  for (int n = 0; n <= layout_.n_steps && layout_.n_c > 0; ++n)
    add_loop_blocks(n, nu[static_cast<std::size_t>(n)], out);
}

void DiscreteDynamics::finish(DynamicsHessian& out) {
  for (int n = 0; n <= layout_.n_steps; ++n) {
    const auto at = static_cast<std::size_t>(n);
    node(n).chart->add_curvature_along(out.y[at], node(n).bracket, out.diagonal[at]);
  }
}

}  // namespace muldi::control
