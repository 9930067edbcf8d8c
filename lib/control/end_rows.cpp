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
    if (target.cut) continue;
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
    linear_.push_back({point, component, target, scale});
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
  for (const CoordinateTarget& target : setup_.condition.coordinates) {
    if (!target.cut) continue;
    names_.push_back(setup_.where + "." + target.name);
    condition_of_.push_back(names_.size() - 1);
    cut_.push_back({.coordinate = {*target.cut, *chart_},
                    .target = target.value,
                    .scale = target.cut->is_angle() ? 1.0 : 1.0 / setup_.sizes.length});
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

Eigen::VectorXd EndRows::raw_values() {
  Eigen::VectorXd R(static_cast<Eigen::Index>(condition_of_.size()));
  if (n_loop_ > 0) {
    Eigen::VectorXd g(setup_.Z.rows());
    model_.manifold->constraints(point_.q, g);
    R.head(n_loop_) = setup_.Z.transpose() * g;
  }
  Eigen::Index at = n_loop_;
  for (const LinearRow& row : linear_) R[at++] = row.scale * (row.point.value(point_.q)[row.component] - row.target);
  for (const CutRow& row : cut_) R[at++] = row.scale * row.coordinate.offset(point_, row.target);
  if (has_equilibrium()) {
    R.tail(n_v_) = force_scale_.cwiseProduct(point_.D.transpose() * bracket_ + forces_.on_rates);
  }
  return R;
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
  // An equilibrium may be far away: the solver looks for it where coordinates are left.
  if (least > pose_tolerance && (all_fixed() || !has_equilibrium())) blame(raw_values());
}

double EndRows::scale_of(Eigen::Index raw_row) const {
  auto at = static_cast<std::size_t>(raw_row - n_loop_);
  if (raw_row < n_loop_) return 0.0;
  if (at < linear_.size()) return linear_[at].scale;
  at -= linear_.size();
  return at < cut_.size() ? cut_[at].scale : 0.0;
}

void EndRows::blame(const Eigen::VectorXd& residual) {
  std::vector<std::string> conditions;
  for (const auto& name : names_) {
    if (name != "closed loops") conditions.push_back(name);
  }
  Eigen::Index worst = 0;
  residual.cwiseAbs().maxCoeff(&worst);
  const std::string& name = names_[condition_of_[static_cast<std::size_t>(worst)]];
  std::string why = "cannot be fulfilled";
  if (const double scale = scale_of(worst); scale > 0.0) {
    why = "cannot be reached: the nearest pose that was found misses it by " +
          base::number_text(std::abs(residual[worst]) / scale, 4);
    if (name.find("orientations") != std::string::npos) why += " in a direction cosine";
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

}  // namespace muldi::control
