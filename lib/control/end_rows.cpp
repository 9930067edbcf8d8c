#include "control/end_rows.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <numbers>

#include "base/text.hpp"

namespace muldi::control {
namespace {

/// Singular values below this part of the largest are zero.
constexpr double rank_tolerance = 1e-7;
/// Dimensionless residual of a pose that fulfils its conditions.
constexpr double pose_tolerance = 1e-9;
constexpr int max_searches = 12;

std::span<const double> view(const Eigen::VectorXd& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }

/// Stiffness -dF/dq of the pieces in the chart, and its derivative along a direction.
class StaticSink final : public model::ExpansionSink {
 public:
  StaticSink(const PieceList& list, const model::ChartPoint& point, const Eigen::VectorXd& a, bool second)
      : list_(list), point_(point), a_(a), second_(second) {}

  void add(const model::LocalForms&, const model::LocalExpansion& expansion) override {
    const Piece& piece = list_.pieces[at_++];
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

EndRows::EndRows(EndSetup setup)
    : setup_(std::move(setup)),
      model_(setup_.problem.model),
      chart_(model_.manifold->make_chart()),
      n_v_(model_.manifold->n_v()),
      n_loop_(setup_.Z.cols()),
      fixed_(static_cast<std::size_t>(n_v_)),
      force_scale_(Eigen::VectorXd::Ones(n_v_)),
      no_squares_(model_.controls.size(), 0.0) {
  chart_->set_reference(setup_.x);
  zero_q_ = Eigen::VectorXd::Zero(model_.n_q());
  zero_v_ = Eigen::VectorXd::Zero(n_v_);
  forces_.force = forces_.momentum = bracket_ = zero_q_;
  forces_.on_rates = zero_v_;
  lambda_ = Eigen::VectorXd::Zero(n_loop_);
  fix_coordinates();
  list_rows();
  Eigen::VectorXd theta(n_v_);
  chart_->coordinates(setup_.x, theta);
  for (Eigen::Index k = 0; k < n_v_; ++k) theta[k] = fixed_[static_cast<std::size_t>(k)].value_or(theta[k]);
  move_to(theta, lambda_);
  if (has_equilibrium()) scale_forces();
  pose_ = theta;
  pose_lambda_ = lambda_;
  find_pose();
  choose_rows();
}

bool EndRows::all_fixed() const {
  for (const auto& value : fixed_) {
    if (!value) return false;
  }
  return true;
}

const std::string& EndRows::name(int row) const { return names_[condition_of_row_[static_cast<std::size_t>(row)]]; }

void EndRows::fix_coordinates() {
  const EndCondition& condition = setup_.condition;
  if (condition.x) {
    Eigen::VectorXd theta(n_v_);
    chart_->coordinates(*condition.x, theta);
    for (Eigen::Index k = 0; k < n_v_; ++k) fixed_[static_cast<std::size_t>(k)] = theta[k];
  }
  for (const CoordinateTarget& target : condition.coordinates) {
    auto& value = fixed_[static_cast<std::size_t>(target.rate)];
    const double size = setup_.sizes.theta[target.rate];
    if (value && std::abs(*value - target.value) > 1e-9 * size) {
      faults_.push_back({setup_.where + "." + target.name, "contradicts another condition on the same coordinate"});
    }
    value = target.value;
  }
}

void EndRows::list_rows() {
  if (n_loop_ > 0) {
    names_.push_back("closed loops");
    condition_of_.assign(static_cast<std::size_t>(n_loop_), 0);
  }
  const auto add = [&](const model::LinearPoint& point, int component, double target, double scale) {
    linear_.push_back({point, component, target, scale, names_.size() - 1});
    condition_of_.push_back(names_.size() - 1);
  };
  for (const PointTarget& target : setup_.condition.points) {
    names_.push_back(setup_.where + "." + target.name);
    for (int k = 0; k < 3; ++k) {
      const auto& value = target.value[static_cast<std::size_t>(k)];
      if (value) add(target.point, k, *value, 1.0 / setup_.sizes.length);
    }
  }
  for (const OrientationTarget& target : setup_.condition.orientations) {
    names_.push_back(setup_.where + "." + target.name);
    for (int d = 0; d < 3; ++d) {
      for (int k = 0; k < 3; ++k) add(target.directors[static_cast<std::size_t>(d)], k, target.value(k, d), 1.0);
    }
  }
  if (!has_equilibrium()) return;
  names_.push_back(setup_.where + ".equilibrium");
  condition_of_.insert(condition_of_.end(), static_cast<std::size_t>(n_v_), names_.size() - 1);
}

void EndRows::scale_forces() {
  const Eigen::MatrixXd K = stiffness();
  const NaturalSizes& sizes = setup_.sizes;
  for (Eigen::Index k = 0; k < n_v_; ++k) {
    // Where nothing is stiff, what the system's inertia resists over the horizon.
    const double inertial = 1e-3 * sizes.mass[k] / (sizes.duration * sizes.duration);
    force_scale_[k] = 1.0 / (sizes.theta[k] * std::max(std::abs(K(k, k)), inertial));
  }
}

void EndRows::move_to(const Eigen::VectorXd& theta, const Eigen::VectorXd& lambda) {
  theta_ = theta;
  lambda_ = lambda;
  chart_->stored(theta_, x_);
  chart_->evaluate(theta_, point_);
  if (has_equilibrium()) evaluate_forces();
}

void EndRows::evaluate_forces() {
  model_.forces({.q0 = point_.q,
                 .q1 = point_.q,
                 .q = point_.q,
                 .v = zero_q_,
                 .u = *setup_.condition.equilibrium,
                 .x0 = view(x_),
                 .x1 = view(x_)},
                forces_);
  bracket_ = forces_.force;
  if (n_loop_ > 0) model_.manifold->add_constraint_forces(point_.q, -1.0, setup_.Z * lambda_, bracket_);
}

Eigen::MatrixXd EndRows::stiffness() {
  StaticSink sink(setup_.pieces, point_, zero_q_, false);
  sink.out = Eigen::MatrixXd::Zero(n_v_, n_v_);
  const model::IntervalPoint at{.q0 = point_.q,
                                .q1 = point_.q,
                                .q = point_.q,
                                .v = zero_q_,
                                .u = *setup_.condition.equilibrium,
                                .x0 = view(x_),
                                .x1 = view(x_)};
  for (const auto& term : model_.terms) term->expand(at, {.squared = no_squares_}, sink);
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

Eigen::VectorXd EndRows::raw_values() {
  Eigen::VectorXd R(static_cast<Eigen::Index>(condition_of_.size()));
  if (n_loop_ > 0) {
    Eigen::VectorXd g(setup_.Z.rows());
    model_.manifold->constraints(point_.q, g);
    R.head(n_loop_) = setup_.Z.transpose() * g;
  }
  Eigen::Index at = n_loop_;
  for (const LinearRow& row : linear_) R[at++] = row.scale * (row.point.value(point_.q)[row.component] - row.target);
  if (has_equilibrium()) {
    R.tail(n_v_) = force_scale_.cwiseProduct(point_.D.transpose() * bracket_ + forces_.on_rates);
  }
  return R;
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

double EndRows::search(Eigen::VectorXd& theta, Eigen::VectorXd& lambda) {
  move_to(theta, lambda);
  Eigen::VectorXd R = raw_values();
  for (int iteration = 0; iteration < 60 && R.norm() > 1e-14; ++iteration) {
    Eigen::MatrixXd by_lambda;
    raw_jacobian(by_lambda);
    const double size = by_lambda.size() > 0 ? by_lambda.cwiseAbs().maxCoeff() : 1.0;
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(1e-9);
    solver.compute(free_jacobian());
    Eigen::VectorXd step = -solver.solve(R);
    const double largest = step.head(n_v_).lpNorm<Eigen::Infinity>();
    if (largest > 0.5) step *= 0.5 / largest;
    bool better = false;
    for (int halving = 0; halving < 12 && !better; ++halving) {
      const Eigen::VectorXd next = theta + step.head(n_v_).cwiseProduct(setup_.sizes.theta);
      Eigen::VectorXd next_lambda = lambda;
      if (step.size() > n_v_) next_lambda += step.tail(n_loop_) / (size > 0.0 ? size : 1.0);
      move_to(next, next_lambda);
      const Eigen::VectorXd trial = raw_values();
      if (trial.norm() < R.norm()) {
        better = true;
        theta = next;
        lambda = next_lambda;
        R = trial;
      } else {
        step *= 0.5;
      }
    }
    if (!better) break;
  }
  move_to(theta, lambda);
  return R.lpNorm<Eigen::Infinity>();
}

void EndRows::find_pose() {
  if (condition_of_.empty()) return;
  const Eigen::VectorXd begin = pose_;
  Eigen::VectorXd best = pose_;
  Eigen::VectorXd best_lambda = pose_lambda_;
  double least = infinity;
  for (int attempt = 0; attempt < max_searches && least > pose_tolerance; ++attempt) {
    Eigen::VectorXd theta = begin;
    Eigen::VectorXd lambda = Eigen::VectorXd::Zero(n_loop_);
    for (Eigen::Index k = 0; k < n_v_; ++k) {
      if (fixed_[static_cast<std::size_t>(k)]) continue;
      // Later attempts start elsewhere: stretched arms are where points stop moving.
      theta[k] += 0.15 * attempt * std::sin(1.7 * attempt + 2.3 * static_cast<double>(k)) * setup_.sizes.theta[k];
    }
    const double residual = search(theta, lambda);
    if (residual < least) {
      least = residual;
      best = theta;
      best_lambda = lambda;
    }
  }
  pose_ = best;
  pose_lambda_ = best_lambda;
  move_to(pose_, pose_lambda_);
  if (least > pose_tolerance) blame(raw_values());
}

void EndRows::blame(const Eigen::VectorXd& residual) {
  std::vector<std::string> conditions;
  for (const auto& name : names_) {
    if (name != "closed loops") conditions.push_back(name);
  }
  Eigen::Index worst = 0;
  residual.cwiseAbs().maxCoeff(&worst);
  const std::string& name = names_[condition_of_[static_cast<std::size_t>(worst)]];
  const bool linear = worst >= n_loop_ && worst < n_loop_ + static_cast<Eigen::Index>(linear_.size());
  std::string why = "cannot be fulfilled";
  if (linear) {
    const LinearRow& row = linear_[static_cast<std::size_t>(worst - n_loop_)];
    why = "cannot be reached: the nearest pose that was found misses it by " +
          base::number_text(std::abs(residual[worst]) / row.scale, 4);
    if (row.scale == 1.0) why += " in a direction cosine";
  } else if (has_equilibrium() && worst >= residual.size() - n_v_) {
    const auto coordinate = worst - (residual.size() - n_v_);
    why = "is at odds with the other conditions of this end: there the joints would have to move on by about " +
          base::number_text(std::abs(residual[worst]) * setup_.sizes.theta[coordinate], 4);
  }
  faults_.push_back({name == "closed loops" && !conditions.empty() ? conditions.front() : name, why});
}

void EndRows::choose_rows() {
  const auto n_raw = static_cast<Eigen::Index>(condition_of_.size());
  U_.resize(n_raw, 0);
  if (n_raw == 0) return;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(free_jacobian(), Eigen::ComputeThinU);
  const Eigen::VectorXd& values = svd.singularValues();
  Eigen::Index rank = 0;
  while (rank < values.size() && values[rank] > rank_tolerance * std::max(values[0], 1e-12)) ++rank;
  // Where nothing is redundant the rows stay what they are.
  U_ = rank == n_raw ? Eigen::MatrixXd(Eigen::MatrixXd::Identity(n_raw, n_raw))
                     : Eigen::MatrixXd(svd.matrixU().leftCols(rank));
  for (Eigen::Index k = 0; k < rank; ++k) {
    Eigen::Index largest = 0;
    U_.col(k).cwiseAbs().maxCoeff(&largest);
    condition_of_row_.push_back(condition_of_[static_cast<std::size_t>(largest)]);
  }
}

Eigen::VectorXd EndRows::values() { return U_.transpose() * raw_values(); }

Eigen::MatrixXd EndRows::jacobian(Eigen::MatrixXd& by_lambda) {
  const Eigen::MatrixXd J = raw_jacobian(by_lambda);
  by_lambda = (U_.transpose() * by_lambda).eval();
  return U_.transpose() * J;
}

void EndRows::add_hessian(const Eigen::VectorXd& nu, Eigen::MatrixXd& H, Eigen::MatrixXd& H_lambda) {
  const Eigen::VectorXd raw = U_ * nu;
  Eigen::VectorXd direction = zero_v_;
  if (has_equilibrium()) direction = force_scale_.cwiseProduct(raw.tail(n_v_));
  chart_->evaluate_along(theta_, direction, point_);
  StaticSink sink(setup_.pieces, point_, point_.a, true);
  sink.out = Eigen::MatrixXd::Zero(n_v_, n_v_);
  sink.y = zero_q_;
  Eigen::Index at = n_loop_;
  for (const LinearRow& row : linear_) {
    sink.y += [&] {
      Eigen::VectorXd f = zero_q_;
      row.point.add_transposed(row.scale * raw[at] * Eigen::Vector3d::Unit(row.component), f);
      return f;
    }();
    ++at;
  }
  if (has_equilibrium()) {
    const model::IntervalPoint here{.q0 = point_.q,
                                    .q1 = point_.q,
                                    .q = point_.q,
                                    .v = zero_q_,
                                    .u = *setup_.condition.equilibrium,
                                    .x0 = view(x_),
                                    .x1 = view(x_)};
    for (const auto& term : model_.terms) {
      term->expand(here, {.squared = no_squares_, .a = &point_.a, .b = &zero_q_}, sink);
    }
  }
  const auto& rows = model_.manifold->loop_rows();
  const Eigen::VectorXd on_rows = n_loop_ > 0 ? Eigen::VectorXd(setup_.Z * raw.head(n_loop_)) : Eigen::VectorXd();
  const Eigen::VectorXd forces = n_loop_ > 0 ? Eigen::VectorXd(-(setup_.Z * lambda_)) : Eigen::VectorXd();
  Eigen::MatrixXd by_lambda = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), n_v_);
  Eigen::VectorXd column(model_.n_q());
  for (std::size_t i = 0; i < rows.size() && n_loop_ > 0; ++i) {
    const auto r = static_cast<Eigen::Index>(i);
    rows[i].add_gradient(point_.q, on_rows[r], sink.y);
    for (Eigen::Index k = 0; k < n_v_; ++k) {
      column.setZero();
      rows[i].add_hessian_times(point_.D.col(k), on_rows[r], column);
      if (has_equilibrium()) rows[i].add_hessian_times(point_.A.col(k), forces[r], column);
      sink.out.col(k) += point_.D.transpose() * column;
      if (!has_equilibrium()) continue;
      column.setZero();
      rows[i].add_hessian_times(point_.D.col(k), forces[r], column);
      sink.out.col(k) += point_.A.transpose() * column;
    }
    if (!has_equilibrium()) continue;
    rows[i].add_hessian_times(point_.a, forces[r], sink.y);
    column.setZero();
    rows[i].add_gradient(point_.q, -1.0, column);
    by_lambda.row(r) = column.transpose() * point_.A;
    column.setZero();
    rows[i].add_hessian_times(point_.a, -1.0, column);
    by_lambda.row(r) += column.transpose() * point_.D;
  }
  chart_->add_curvature_along(sink.y, has_equilibrium() ? bracket_ : zero_q_, sink.out);
  H += sink.out;
  if (n_loop_ > 0) H_lambda += setup_.Z.transpose() * by_lambda;
}

}  // namespace muldi::control
