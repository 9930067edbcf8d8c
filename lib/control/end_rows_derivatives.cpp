/// Forces and derivatives of the conditions at an end.
#include "control/end_pieces.hpp"
#include "control/end_rows.hpp"

namespace muldi::control {
namespace {

std::span<const double> view(const Eigen::VectorXd& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }

/// Stiffness -dF/dq of the pieces in the chart, and its derivative along a direction.
class StaticSink final : public model::ExpansionSink {
 public:
  StaticSink(const PieceList& list, const model::ChartPoint& point, const Eigen::VectorXd& a, bool second)
      : list_(list), point_(point), a_(a), second_(second) {}

  void add(const model::LocalForms&, const model::LocalExpansion& expansion) override {
    const Piece& piece = list_.pieces[at_++];
    if (piece.coordinate != nullptr) {
      add_end_piece(piece, expansion);
      return;
    }
    const Eigen::Index m = piece.size;
    Eigen::MatrixXd J;
    piece.project(point_.D, J);
    const auto F_x = expansion.tangent.topLeftCorner(m, m);
    if (!second_) {
      scatter(J.transpose() * F_x * J, piece, out);
      return;
    }
    if (piece.rate >= 0) return;
    Eigen::MatrixXd A;
    piece.project(point_.A, A);
    const Eigen::MatrixXd mixed = A.transpose() * F_x * J;
    scatter(J.transpose() * expansion.hessian->topLeftCorner(m, m) * J + mixed + mixed.transpose(), piece, out);
    Eigen::VectorXd a(m);
    piece.apply(a_, a);
    piece.add_transposed(F_x.transpose() * a, y);
  }

  Eigen::MatrixXd out;
  Eigen::VectorXd y;

 private:
  void add_end_piece(const Piece& piece, const model::LocalExpansion& expansion) {
    const EndPiece at(piece, point_, second_);
    const double slope = expansion.tangent(0, 0);
    const Eigen::MatrixXd J = at.J();
    if (!second_) {
      scatter(slope * J.transpose() * J, piece, out);
      at.add_curvature(expansion.force, out);
      return;
    }
    const Eigen::MatrixXd mixed = slope * at.A().transpose() * J;
    scatter(mixed + mixed.transpose(), piece, out);
    at.add_curvature_along(slope * at.along(), expansion.force, y, out);
  }

  static void scatter(const Eigen::MatrixXd& block, const Piece& piece, Eigen::MatrixXd& to) {
    for (std::size_t c = 0; c < piece.columns.size(); ++c) {
      for (std::size_t r = 0; r < piece.columns.size(); ++r) {
        to(piece.columns[r], piece.columns[c]) += block(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c));
      }
    }
  }

  const PieceList& list_;
  const model::ChartPoint& point_;
  const Eigen::VectorXd& a_;
  bool second_;
  std::size_t at_ = 0;
};

}  // namespace

model::IntervalPoint EndRows::point_at_rest() const {
  return {.q0 = point_.q,
          .q1 = point_.q,
          .q = point_.q,
          .v = zero_q_,
          .u = *setup_.condition.equilibrium,
          .x0 = view(x_),
          .x1 = view(x_)};
}

void EndRows::evaluate_forces() {
  model_.forces(point_at_rest(), forces_);
  bracket_ = forces_.force;
  if (n_loop_ > 0) model_.manifold->add_constraint_forces(point_.q, -1.0, setup_.Z * lambda_, bracket_);
}

Eigen::MatrixXd EndRows::stiffness() {
  StaticSink sink(setup_.pieces, point_, zero_q_, false);
  sink.out = Eigen::MatrixXd::Zero(n_v_, n_v_);
  for (const auto& term : model_.terms) term->expand(point_at_rest(), {.squared = no_squares_}, sink);
  chart_->add_curvature(bracket_, sink.out);
  const auto& rows = model_.manifold->loop_rows();
  const Eigen::VectorXd weights = setup_.Z * lambda_;
  Eigen::VectorXd column(model_.n_q());
  for (Eigen::Index k = 0; k < n_v_ && n_loop_ > 0; ++k) {
    column.setZero();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i].add_hessian_times(point_.D.col(k), -weights[static_cast<Eigen::Index>(i)], column);
    }
    sink.out.col(k) += point_.D.transpose() * column;
  }
  return sink.out;
}

Eigen::MatrixXd EndRows::raw_jacobian(Eigen::MatrixXd& by_lambda) {
  const auto n_raw = static_cast<Eigen::Index>(condition_of_.size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n_raw, n_v_);
  by_lambda = Eigen::MatrixXd::Zero(n_raw, n_loop_);
  const auto& rows = model_.manifold->loop_rows();
  if (n_loop_ > 0) {
    Eigen::MatrixXd GD(static_cast<Eigen::Index>(rows.size()), n_v_);
    Eigen::VectorXd gradient(model_.n_q());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      gradient.setZero();
      rows[i].add_gradient(point_.q, 1.0, gradient);
      GD.row(static_cast<Eigen::Index>(i)) = gradient.transpose() * point_.D;
    }
    out.topRows(n_loop_) = setup_.Z.transpose() * GD;
  }
  Eigen::Index at = n_loop_;
  Eigen::MatrixXd block(3, n_v_);
  for (const LinearRow& row : linear_) {
    project_point(row.point, point_.D, block);
    out.row(at++) = row.scale * block.row(row.component);
  }
  for (const CutRow& row : cut_) out.row(at++) = row.scale * row.coordinate.gradient(point_);
  if (has_equilibrium()) {
    out.bottomRows(n_v_) = force_scale_.asDiagonal() * stiffness();
    if (n_loop_ > 0) by_lambda.bottomRows(n_v_) = -(force_scale_.asDiagonal() * out.topRows(n_loop_).transpose());
  }
  return out;
}

Eigen::MatrixXd EndRows::free_jacobian() {
  Eigen::MatrixXd by_lambda;
  const Eigen::MatrixXd J = raw_jacobian(by_lambda);
  const Eigen::Index n_lambda = has_equilibrium() ? n_loop_ : 0;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(J.rows(), n_v_ + n_lambda);
  for (Eigen::Index k = 0; k < n_v_; ++k) {
    if (!fixed_[static_cast<std::size_t>(k)]) out.col(k) = J.col(k) * setup_.sizes.theta[k];
  }
  if (n_lambda > 0) {
    const double size = by_lambda.cwiseAbs().maxCoeff();
    out.rightCols(n_lambda) = by_lambda / (size > 0.0 ? size : 1.0);
  }
  return out;
}

void EndRows::add_pose_hessian(const Eigen::VectorXd& raw, Eigen::VectorXd& y, Eigen::MatrixXd& H) const {
  Eigen::Index at = n_loop_;
  for (const LinearRow& row : linear_) {
    row.point.add_transposed(row.scale * raw[at++] * Eigen::Vector3d::Unit(row.component), y);
  }
  for (const CutRow& row : cut_) row.coordinate.add_hessian(row.scale * raw[at++], point_, y, H);
}

void EndRows::add_loop_hessian(const Eigen::VectorXd& on_rows, Eigen::VectorXd& y, Eigen::MatrixXd& H,
                               Eigen::MatrixXd& H_lambda) {
  const auto& rows = model_.manifold->loop_rows();
  const Eigen::VectorXd weights = setup_.Z * on_rows;
  const Eigen::VectorXd forces = has_equilibrium() ? Eigen::VectorXd(-(setup_.Z * lambda_)) : Eigen::VectorXd();
  Eigen::MatrixXd by_lambda = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), n_v_);
  Eigen::VectorXd column(model_.n_q());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto r = static_cast<Eigen::Index>(i);
    rows[i].add_gradient(point_.q, weights[r], y);
    for (Eigen::Index k = 0; k < n_v_; ++k) {
      column.setZero();
      rows[i].add_hessian_times(point_.D.col(k), weights[r], column);
      if (has_equilibrium()) rows[i].add_hessian_times(point_.A.col(k), forces[r], column);
      H.col(k) += point_.D.transpose() * column;
      if (!has_equilibrium()) continue;
      column.setZero();
      rows[i].add_hessian_times(point_.D.col(k), forces[r], column);
      H.col(k) += point_.A.transpose() * column;
    }
    if (!has_equilibrium()) continue;
    rows[i].add_hessian_times(point_.a, forces[r], y);
    column.setZero();
    rows[i].add_gradient(point_.q, -1.0, column);
    by_lambda.row(r) = column.transpose() * point_.A;
    column.setZero();
    rows[i].add_hessian_times(point_.a, -1.0, column);
    by_lambda.row(r) += column.transpose() * point_.D;
  }
  H_lambda += setup_.Z.transpose() * by_lambda;
}

void EndRows::add_hessian(const Eigen::VectorXd& nu, Eigen::MatrixXd& H, Eigen::MatrixXd& H_lambda) {
  const Eigen::VectorXd raw = U_ * nu;
  Eigen::VectorXd direction = zero_v_;
  if (has_equilibrium()) direction = force_scale_.cwiseProduct(raw.tail(n_v_));
  chart_->evaluate_along(theta_, direction, point_);
  StaticSink sink(setup_.pieces, point_, point_.a, true);
  sink.out = Eigen::MatrixXd::Zero(n_v_, n_v_);
  sink.y = zero_q_;
  add_pose_hessian(raw, sink.y, sink.out);
  if (has_equilibrium()) {
    for (const auto& term : model_.terms) {
      term->expand(point_at_rest(), {.squared = no_squares_, .a = &point_.a, .b = &zero_q_}, sink);
    }
  }
  if (n_loop_ > 0) add_loop_hessian(raw.head(n_loop_), sink.y, sink.out, H_lambda);
  chart_->add_curvature_along(sink.y, has_equilibrium() ? bracket_ : zero_q_, sink.out);
  H += sink.out;
}

}  // namespace muldi::control
