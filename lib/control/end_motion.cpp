#include "control/end_motion.hpp"

namespace muldi::control {
namespace {

void scatter(const Eigen::MatrixXd& block, const std::vector<int>& columns, Eigen::MatrixXd& out) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    for (std::size_t r = 0; r < columns.size(); ++r) {
      out(columns[r], columns[c]) += block(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c));
    }
  }
}

/// J^T (pi_xi J + pi_v V) and J^T pi_v J over the pieces.
class MomentumSink final : public model::ExpansionSink {
 public:
  MomentumSink(const PieceList& list, const model::ChartPoint& moving, Eigen::MatrixXd& by_theta,
               Eigen::MatrixXd& by_rates)
      : list_(list), moving_(moving), by_theta_(by_theta), by_rates_(by_rates) {}

  void add(const model::LocalForms&, const model::LocalExpansion& expansion) override {
    const Piece& piece = list_.pieces[at_++];
    if (!piece.is_linear()) return;
    const Eigen::Index m = piece.size;
    Eigen::MatrixXd J;
    Eigen::MatrixXd V;
    piece.project(moving_.D, J);
    piece.project(moving_.A, V);
    const Eigen::MatrixXd p_x = expansion.tangent.block(m, 0, m, m);
    const Eigen::MatrixXd p_v = expansion.tangent.block(m, m, m, m);
    scatter(J.transpose() * (p_x * J + p_v * V), piece.columns, by_theta_);
    scatter(J.transpose() * p_v * J, piece.columns, by_rates_);
  }

 private:
  const PieceList& list_;
  const model::ChartPoint& moving_;
  Eigen::MatrixXd& by_theta_;
  Eigen::MatrixXd& by_rates_;
  std::size_t at_ = 0;
};

/// Second derivatives of a . pi(q, v), a = D nu, v = D omega, before the charts.
class MomentumHessianSink final : public model::ExpansionSink {
 public:
  MomentumHessianSink(const PieceList& list, const model::ChartPoint& moving, const model::ChartPoint& adjoint)
      : list_(list), moving_(moving), adjoint_(adjoint) {}

  void add(const model::LocalForms&, const model::LocalExpansion& expansion) override {
    const Piece& piece = list_.pieces[at_++];
    if (!piece.is_linear()) return;
    const Eigen::Index m = piece.size;
    Eigen::MatrixXd J;
    Eigen::MatrixXd V;
    Eigen::MatrixXd A;
    piece.project(moving_.D, J);
    piece.project(moving_.A, V);
    piece.project(adjoint_.A, A);
    const Eigen::MatrixXd p_x = expansion.tangent.block(m, 0, m, m);
    const Eigen::MatrixXd p_v = expansion.tangent.block(m, m, m, m);
    const Eigen::MatrixXd& H = *expansion.hessian;
    const Eigen::MatrixXd H_xv = H.block(0, m, m, m);
    const Eigen::MatrixXd mixed = J.transpose() * H_xv * V + A.transpose() * (p_x * J + p_v * V);
    scatter(J.transpose() * H.topLeftCorner(m, m) * J + mixed + mixed.transpose(), piece.columns, by_theta);
    scatter(J.transpose() * (H_xv.transpose() * J + p_v.transpose() * A), piece.columns, rates_theta);
    Eigen::VectorXd a(m);
    piece.apply(adjoint_.a, a);
    piece.add_transposed(p_x.transpose() * a, on_q);
    piece.add_transposed(p_v.transpose() * a, on_v);
  }

  Eigen::MatrixXd by_theta;
  Eigen::MatrixXd rates_theta;
  Eigen::VectorXd on_q;
  Eigen::VectorXd on_v;

 private:
  const PieceList& list_;
  const model::ChartPoint& moving_;
  const model::ChartPoint& adjoint_;
  std::size_t at_ = 0;
};

}  // namespace

EndMotionRows::EndMotionRows(const Problem& problem, const DiscreteDynamics& dynamics, int node, bool with_loops)
    : problem_(problem),
      dynamics_(dynamics),
      node_(node),
      n_v_(problem.model.manifold->n_v()),
      n_loop_(with_loops ? problem.model.manifold->n_c() : 0),
      along_rates_(problem.model.manifold->make_chart()),
      along_nu_(problem.model.manifold->make_chart()),
      no_controls_(problem.model.controls.size(), 0.0) {
  // The node's chart is measured from the guess, and so are these: x is that of the guess until the first move.
  along_rates_->set_reference(dynamics.node(node).x);
  along_nu_->set_reference(dynamics.node(node).x);
  forces_.force = forces_.momentum = Eigen::VectorXd::Zero(problem.model.n_q());
  forces_.on_rates = Eigen::VectorXd::Zero(n_v_);
}

model::IntervalPoint EndMotionRows::point() const {
  return {.q0 = moving_.q,
          .q1 = moving_.q,
          .q = moving_.q,
          .v = moving_.a,
          .u = no_controls_,
          .x0 = {x_.data(), static_cast<std::size_t>(x_.size())},
          .x1 = {x_.data(), static_cast<std::size_t>(x_.size())}};
}

void EndMotionRows::move_to(const Eigen::VectorXd& rates, const Eigen::VectorXd& momenta) {
  theta_ = dynamics_.node(node_).theta;
  x_ = dynamics_.node(node_).x;
  momenta_ = momenta;
  along_rates_->evaluate_along(theta_, rates, moving_);
  problem_.model.forces(point(), forces_);
}

Eigen::VectorXd EndMotionRows::values() {
  Eigen::VectorXd out(n_rows());
  out.head(n_v_) = moving_.D.transpose() * forces_.momentum - momenta_;
  if (n_loop_ == 0) return out;
  const auto& rows = problem_.model.manifold->loop_rows();
  Eigen::VectorXd rate(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) rate[static_cast<Eigen::Index>(i)] = rows[i].rate(moving_.q, moving_.a);
  out.tail(n_loop_) = dynamics_.node(node_).Z.transpose() * rate;
  return out;
}

void EndMotionRows::tangents(Eigen::MatrixXd& by_theta, Eigen::MatrixXd& by_rates) {
  const PieceList& list = dynamics_.pieces();
  Eigen::MatrixXd product(moving_.D.rows(), n_v_);
  list.multiply_mass(moving_.A, product);
  by_theta = moving_.D.transpose() * product;
  list.multiply_mass(moving_.D, product);
  by_rates = moving_.D.transpose() * product;
  MomentumSink sink(list, moving_, by_theta, by_rates);
  for (const auto& term : problem_.model.terms) term->expand(point(), {.squared = no_controls_}, sink);
  along_rates_->add_curvature_along(forces_.momentum, Eigen::VectorXd::Zero(forces_.momentum.size()), by_theta);
}

void EndMotionRows::jacobian(Eigen::MatrixXd& by_theta, Eigen::MatrixXd& by_rates) {
  tangents(by_theta, by_rates);
  if (n_loop_ == 0) return;
  const auto& rows = problem_.model.manifold->loop_rows();
  const auto n = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixXd on_theta(n, n_v_);
  Eigen::MatrixXd on_rates(n, n_v_);
  Eigen::VectorXd gradient(moving_.q.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    gradient.setZero();
    rows[i].add_gradient(moving_.q, 1.0, gradient);
    on_rates.row(row) = gradient.transpose() * moving_.D;
    on_theta.row(row) = gradient.transpose() * moving_.A;
    gradient.setZero();
    rows[i].add_hessian_times(moving_.a, 1.0, gradient);
    on_theta.row(row) += gradient.transpose() * moving_.D;
  }
  const Eigen::MatrixXd Z_T = dynamics_.node(node_).Z.transpose();
  by_theta.conservativeResize(n_rows(), n_v_);
  by_rates.conservativeResize(n_rows(), n_v_);
  by_theta.bottomRows(n_loop_) = Z_T * on_theta;
  by_rates.bottomRows(n_loop_) = Z_T * on_rates;
}

void EndMotionRows::add_hessian(const Eigen::VectorXd& nu, Eigen::MatrixXd& by_theta, Eigen::MatrixXd& rates_theta) {
  along_nu_->evaluate_along(theta_, nu.head(n_v_), adjoint_);
  const PieceList& list = dynamics_.pieces();
  MomentumHessianSink sink(list, moving_, adjoint_);
  Eigen::MatrixXd product(moving_.D.rows(), n_v_);
  list.multiply_mass(adjoint_.A, product);
  const Eigen::MatrixXd mixed = moving_.A.transpose() * product;
  sink.by_theta = mixed + mixed.transpose();
  sink.rates_theta = moving_.D.transpose() * product;
  sink.on_q = Eigen::VectorXd::Zero(moving_.q.size());
  sink.on_v = sink.on_q;
  list.multiply_mass(adjoint_.a, sink.on_v);
  const Eigen::VectorXd zero = sink.on_q;
  for (const auto& term : problem_.model.terms) {
    term->expand(point(), {.squared = no_controls_, .a = &zero, .b = &adjoint_.a}, sink);
  }
  const auto& rows = problem_.model.manifold->loop_rows();
  const Eigen::VectorXd weights =
      n_loop_ > 0 ? Eigen::VectorXd(dynamics_.node(node_).Z * nu.tail(n_loop_)) : Eigen::VectorXd();
  Eigen::VectorXd column(moving_.q.size());
  for (std::size_t i = 0; i < rows.size() && n_loop_ > 0; ++i) {
    const double weight = weights[static_cast<Eigen::Index>(i)];
    rows[i].add_gradient(moving_.q, weight, sink.on_v);
    rows[i].add_hessian_times(moving_.a, weight, sink.on_q);
    for (Eigen::Index k = 0; k < n_v_; ++k) {
      column.setZero();
      rows[i].add_hessian_times(moving_.D.col(k), weight, column);
      const Eigen::VectorXd by_v = moving_.A.transpose() * column;
      sink.by_theta.col(k) += by_v;
      sink.by_theta.row(k) += by_v.transpose();
      sink.rates_theta.col(k) += moving_.D.transpose() * column;
    }
  }
  along_rates_->add_curvature_along(sink.on_q, sink.on_v, sink.by_theta);
  along_rates_->add_curvature_along(sink.on_v, zero, sink.rates_theta);
  along_nu_->add_curvature_along(zero, forces_.momentum, sink.by_theta);
  by_theta += sink.by_theta;
  rates_theta = sink.rates_theta;
}

}  // namespace muldi::control
