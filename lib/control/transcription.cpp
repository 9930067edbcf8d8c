#include "control/transcription.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/text.hpp"

namespace muldi::control {
namespace {

bool has_motion_unknowns(const MomentumCondition& momentum, bool pose_fixed) {
  return momentum.kind == MomentumCondition::Kind::rates && !pose_fixed;
}

}  // namespace

Transcription::Transcription(const Problem& problem, std::span<const WeightedObjective> objectives,
                             const Trajectory& guess)
    : problem_(problem), objectives_(problem, objectives) {
  layout_.n_steps = problem.horizon.n_steps;
  layout_.n_v = problem.model.manifold->n_v();
  layout_.n_u = static_cast<int>(problem.controls.size());
  layout_.n_c = problem.model.manifold->n_c();
  using Kind = MomentumCondition::Kind;
  layout_.balance_at_end = {problem.initial.momentum.kind != Kind::free,
                            problem.final.momentum.kind != Kind::free || objectives_.has_kinetic_energy()};
  layout_.place_nodes();
  if (problem.horizon.is_free()) layout_.step = layout_.append(1);
  find_sizes(guess);
  dynamics_ = std::make_unique<DiscreteDynamics>(problem, layout_, guess);
  for (const std::string& term : dynamics_->pieces().refused) {
    faults_.push_back({"", "forces on " + term + " have no second derivatives for optimal control"});
  }
  if (!faults_.empty()) return;
  make_ends(guess);
  place_unknowns();
  limits_ = std::make_unique<LimitRows>(problem, layout_, *dynamics_->node(0).chart, sizes_.length);
  turns_ =
      std::make_unique<TurnRows>(problem.model, *dynamics_->node(0).chart, guess.x[0], problem.limits.longest_turn);
  count_rows();
  set_bounds(guess);
  set_scales();
  if (!faults_.empty()) return;
  set_end_momenta();
  check_counts();
  find_patterns();
  jacobian_.resize(layout_);
  hessian_.resize(layout_, problem.model.n_q());
  m_.assign(static_cast<std::size_t>(layout_.n_steps + 1), Eigen::VectorXd::Zero(layout_.n_v));
  nu_.assign(static_cast<std::size_t>(layout_.n_steps + 1), Eigen::VectorXd::Zero(layout_.n_c));
  for (std::size_t end = 0; end < 2; ++end) {
    end_jacobian_[end] = Eigen::MatrixXd::Zero(ends_[end]->n_rows(), layout_.n_v);
    end_by_lambda_[end] = Eigen::MatrixXd::Zero(ends_[end]->n_rows(), layout_.n_c);
  }
  equilibrium_lambda_ = Eigen::MatrixXd::Zero(layout_.n_c, layout_.n_v);
  write_jacobian();
  write_hessian();
  scale_objective(guess);
}

void Transcription::find_sizes(const Trajectory& guess) {
  const model::Model& model = problem_.model;
  const model::Manifold& manifold = *model.manifold;
  sizes_.theta = manifold.rate_scale();
  sizes_.length = std::max(sizes_.theta.maxCoeff(), 1e-12);
  if (sizes_.theta.size() == 0) sizes_.length = 1.0;
  sizes_.duration = layout_.n_steps * 0.5 * (problem_.horizon.shortest_step + problem_.horizon.longest_step);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(model.n_q());
  const Eigen::VectorXd zero = q;
  manifold.configuration(guess.x[0], q);
  const auto frame = manifold.make_frame();
  manifold.update(guess.x[0], q, *frame);
  std::vector<double> u;
  model.evaluate_controls(0.0, u);
  math::BlockMatrix M(*model.pattern);
  model.tangent({.q0 = q, .q1 = q, .q = q, .v = zero, .u = u}, model::TangentWeights::mass(), M);
  Eigen::MatrixXd projected = Eigen::MatrixXd::Zero(layout_.n_v, layout_.n_v);
  manifold.project_tangent(*frame, *frame, M, projected);
  sizes_.mass = projected.diagonal();
  const double least = 1e-9 * std::max(sizes_.mass.size() > 0 ? sizes_.mass.maxCoeff() : 1.0, 1e-30);
  sizes_.mass = sizes_.mass.cwiseMax(least);
}

void Transcription::make_ends(const Trajectory& guess) {
  for (std::size_t end = 0; end < 2; ++end) {
    const int node = end == 0 ? 0 : layout_.n_steps;
    Eigen::MatrixXd Z = dynamics_->node(node).Z;
    ends_[end] = std::make_unique<EndRows>(EndSetup{.problem = problem_,
                                                    .condition = end == 0 ? problem_.initial : problem_.final,
                                                    .pieces = dynamics_->pieces(),
                                                    .x = guess.x[static_cast<std::size_t>(node)],
                                                    .Z = Z,
                                                    .sizes = sizes_,
                                                    .where = end == 0 ? "initial" : "final"});
    const auto& found = ends_[end]->faults();
    faults_.insert(faults_.end(), found.begin(), found.end());
  }
}

void Transcription::place_unknowns() {
  if (ends_[1]->has_equilibrium() && layout_.n_c > 0) layout_.equilibrium_lambda = layout_.append(layout_.n_c);
  for (std::size_t end = 0; end < 2; ++end) {
    const EndCondition& condition = end == 0 ? problem_.initial : problem_.final;
    const bool energy = end == 1 && objectives_.has_kinetic_energy();
    if (!energy && !has_motion_unknowns(condition.momentum, ends_[end]->all_fixed())) continue;
    const bool free_rates = condition.momentum.kind != MomentumCondition::Kind::rates;
    layout_.motion[end].rates = layout_.append(layout_.n_v);
    layout_.motion[end].momenta = layout_.append(layout_.n_v);
    motions_[end] = std::make_unique<EndMotionRows>(problem_, *dynamics_, end == 0 ? 0 : layout_.n_steps,
                                                    free_rates && layout_.n_c > 0);
  }
  if (objectives_.has_peak()) layout_.peak = layout_.append(1);
}

void Transcription::count_rows() {
  n_rows_ = 0;
  const auto take = [&](int count) {
    const int first = n_rows_;
    n_rows_ += count;
    return first;
  };
  end_row_[0] = take(ends_[0]->n_rows());
  for (int n = 0; n <= layout_.n_steps; ++n) {
    balance_row_.push_back(layout_.has_balance(n) ? take(layout_.n_v) : -1);
    const bool inner = n > 0 && n < layout_.n_steps;
    closing_row_.push_back(layout_.n_c > 0 && inner ? take(layout_.n_c) : -1);
  }
  end_row_[1] = take(ends_[1]->n_rows());
  for (std::size_t end = 0; end < 2; ++end) {
    if (motions_[end]) motion_row_[end] = take(motions_[end]->n_rows());
  }
  limit_row_ = take(static_cast<int>(limits_->rows().size()));
  turn_row_ = take(turns_->n_rows() * layout_.n_steps);
  int peaks = 0;
  for (const double factor : objectives_.peak_factors()) peaks += factor != 0.0 ? layout_.n_steps : 0;
  peak_row_ = take(objectives_.has_peak() ? peaks : 0);
}

void Transcription::bound_theta(int node, const std::vector<std::optional<double>>& fixed) {
  for (int k = 0; k < layout_.n_v; ++k) {
    const int at = layout_.theta(node, k);
    if (!fixed[static_cast<std::size_t>(k)]) continue;
    const double value = *fixed[static_cast<std::size_t>(k)];
    const double slack = 1e-9 * sizes_.theta[k];
    if (node > 0 && (value < bounds_.x_lower[at] - slack || value > bounds_.x_upper[at] + slack)) {
      faults_.push_back({"final", "the pose at the end is outside the limits of a joint coordinate"});
    }
    bounds_.x_lower[at] = bounds_.x_upper[at] = value;
  }
}

void Transcription::set_bounds(const Trajectory&) {
  bounds_.x_lower = Eigen::VectorXd::Constant(layout_.n, -infinity);
  bounds_.x_upper = Eigen::VectorXd::Constant(layout_.n, infinity);
  bounds_.c_lower = bounds_.c_upper = Eigen::VectorXd::Zero(n_rows_);
  for (int n = 1; n <= layout_.n_steps; ++n) {
    for (const CoordinateLimit& limit : problem_.limits.coordinates) {
      if (limit.cut) continue;
      const int at = layout_.theta(n, limit.rate);
      bounds_.x_lower[at] = std::max(bounds_.x_lower[at], limit.lower);
      bounds_.x_upper[at] = std::min(bounds_.x_upper[at], limit.upper);
    }
  }
  bound_theta(0, ends_[0]->fixed());
  bound_theta(layout_.n_steps, ends_[1]->fixed());
  for (int k = 0; k < layout_.n_steps; ++k) {
    for (int c = 0; c < layout_.n_u; ++c) {
      const ControlChoice& choice = problem_.controls[static_cast<std::size_t>(c)];
      const int at = layout_.w(k, c);
      const double least = choice.kind == ControlKind::squared ? std::max(choice.lower, 0.0) : choice.lower;
      bounds_.x_lower[at] = std::isfinite(least) ? dynamics_->control_unknown(c, least) : -infinity;
      bounds_.x_upper[at] = std::isfinite(choice.upper) ? dynamics_->control_unknown(c, choice.upper) : infinity;
    }
  }
  if (layout_.step >= 0) {
    bounds_.x_lower[layout_.step] = problem_.horizon.shortest_step;
    bounds_.x_upper[layout_.step] = problem_.horizon.longest_step;
  }
  for (std::size_t end = 0; end < 2; ++end) {
    const EndMotion& motion = layout_.motion[end];
    const MomentumCondition& momentum = end == 0 ? problem_.initial.momentum : problem_.final.momentum;
    using Kind = MomentumCondition::Kind;
    if (!motion.exists() || momentum.kind == Kind::free) continue;
    const int first = momentum.kind == Kind::rates ? motion.rates : motion.momenta;
    for (int k = 0; k < layout_.n_v; ++k) {
      const double value = momentum.kind == Kind::rest ? 0.0 : momentum.values[k];
      bounds_.x_lower[first + k] = bounds_.x_upper[first + k] = value;
    }
  }
  for (std::size_t i = 0; i < limits_->rows().size(); ++i) {
    bounds_.c_lower[limit_row_ + static_cast<Eigen::Index>(i)] = limits_->rows()[i].lower;
    bounds_.c_upper[limit_row_ + static_cast<Eigen::Index>(i)] = limits_->rows()[i].upper;
  }
  for (int row = 0; row < turns_->n_rows(); ++row) {
    const int first = turn_row_ + row * layout_.n_steps;
    bounds_.c_lower.segment(first, layout_.n_steps).setConstant(turns_->lower(row));
    bounds_.c_upper.segment(first, layout_.n_steps).setConstant(turns_->upper(row));
  }
  if (objectives_.has_peak()) bounds_.c_upper.tail(n_rows_ - peak_row_).setConstant(infinity);
}

void Transcription::set_scales() {
  const double h = sizes_.duration / layout_.n_steps;
  scale_x_ = Eigen::VectorXd::Ones(layout_.n);
  scale_c_ = Eigen::VectorXd::Ones(n_rows_);
  const Eigen::VectorXd momentum = sizes_.mass.cwiseProduct(sizes_.theta) / h;
  const double impulse = layout_.n_v > 0 ? momentum.cwiseProduct(sizes_.theta).maxCoeff() : 1.0;
  for (int n = 0; n <= layout_.n_steps; ++n) {
    scale_x_.segment(layout_.theta(n, 0), layout_.n_v) = sizes_.theta;
    const auto at = static_cast<std::size_t>(n);
    if (layout_.lambda(n, 0) >= 0) scale_x_.segment(layout_.lambda(n, 0), layout_.n_c).setConstant(impulse);
    if (balance_row_[at] >= 0) scale_c_.segment(balance_row_[at], layout_.n_v) = momentum.cwiseInverse();
  }
  if (layout_.step >= 0) scale_x_[layout_.step] = h;
  if (layout_.equilibrium_lambda >= 0)
    scale_x_.segment(layout_.equilibrium_lambda, layout_.n_c).setConstant(impulse / h);
  for (std::size_t end = 0; end < 2; ++end) {
    if (!layout_.motion[end].exists()) continue;
    scale_x_.segment(layout_.motion[end].rates, layout_.n_v) = sizes_.theta / h;
    scale_x_.segment(layout_.motion[end].momenta, layout_.n_v) = momentum;
    scale_c_.segment(motion_row_[end], layout_.n_v) = momentum.cwiseInverse();
    const int loops = motions_[end]->n_rows() - layout_.n_v;
    scale_c_.segment(motion_row_[end] + layout_.n_v, loops).setConstant(h);
  }
  if (layout_.peak >= 0) {
    double largest = 0.0;
    for (std::size_t c = 0; c < problem_.controls.size(); ++c) {
      const double reference = problem_.controls[c].reference;
      largest = std::max(largest, objectives_.peak_factors()[c] * reference * reference);
    }
    scale_x_[layout_.peak] = largest > 0.0 ? largest : 1.0;
    scale_c_.tail(n_rows_ - peak_row_).setConstant(1.0 / scale_x_[layout_.peak]);
  }
  bounds_.x_lower = bounds_.x_lower.cwiseQuotient(scale_x_);
  bounds_.x_upper = bounds_.x_upper.cwiseQuotient(scale_x_);
}

void Transcription::set_end_momenta() {
  const model::Manifold& manifold = *problem_.model.manifold;
  using Kind = MomentumCondition::Kind;
  for (std::size_t end = 0; end < 2; ++end) {
    end_momenta_[end] = Eigen::VectorXd::Zero(layout_.n_v);
    const MomentumCondition& momentum = end == 0 ? problem_.initial.momentum : problem_.final.momentum;
    if (layout_.motion[end].exists()) continue;
    if (momentum.kind == Kind::momenta) end_momenta_[end] = momentum.values;
    if (momentum.kind != Kind::rates) continue;
    // The pose is fixed: m = D^T pi(q, D rates).
    const EndRows& rows = *ends_[end];
    model::ChartPoint point;
    DynamicsNode& node = dynamics_->node(end == 0 ? 0 : layout_.n_steps);
    node.chart->evaluate(rows.pose(), point);
    const Eigen::VectorXd v = point.D * momentum.values;
    Eigen::VectorXd x(manifold.n_x());
    node.chart->stored(rows.pose(), x);
    const std::vector<double> none(problem_.model.controls.size(), 0.0);
    model::IntervalForces forces{.force = Eigen::VectorXd::Zero(problem_.model.n_q()),
                                 .momentum = Eigen::VectorXd::Zero(problem_.model.n_q())};
    problem_.model.forces({.q0 = point.q, .q1 = point.q, .q = point.q, .v = v, .u = none}, forces);
    end_momenta_[end] = point.D.transpose() * forces.momentum;
  }
}

void Transcription::check_counts() {
  int n_free = 0;
  for (int i = 0; i < layout_.n; ++i) n_free += bounds_.x_lower[i] < bounds_.x_upper[i] ? 1 : 0;
  int n_equations = 0;
  for (int i = 0; i < n_rows_; ++i) n_equations += bounds_.c_lower[i] == bounds_.c_upper[i] ? 1 : 0;
  if (n_equations <= n_free) return;
  faults_.push_back({"", "more conditions than freedoms: " + std::to_string(n_equations) + " equations for " +
                             std::to_string(n_free) + " unknowns; give more steps or controls, or fewer conditions"});
}

void Transcription::find_patterns() {
  std::set<std::pair<int, int>> pairs;
  const auto add = [&](const std::vector<int>& clique) {
    for (const int i : clique) {
      for (const int j : clique) pairs.insert({i, j});
    }
  };
  for (const auto& clique : dynamics_->pieces().cliques) add(clique);
  const model::Chart& chart = *dynamics_->node(0).chart;
  for (const auto& clique : objectives_.bind(chart)) add(clique);
  for (std::size_t i = 0; i < limits_->rows().size(); ++i) add(limits_->columns(i));
  for (int row = 0; row < turns_->n_rows(); ++row) add(turns_->columns(row));
  std::vector<int> all;
  for (int k = 0; k < layout_.n_v; ++k) {
    pairs.insert({k, k});
    all.push_back(k);
  }
  // Conditions at the end and loops reach over the whole system, which is small.
  const bool whole = layout_.n_c > 0 || ends_[0]->n_rows() > 0 || ends_[1]->n_rows() > 0 || motions_[0] || motions_[1];
  if (whole) add(all);
  theta_pairs_.assign(pairs.begin(), pairs.end());
  std::set<std::pair<int, int>> controls;
  const auto connect = [&](const std::vector<int>& columns, int choice) {
    for (const int k : columns) controls.insert({k, choice});
  };
  for (const Piece& piece : dynamics_->pieces().pieces) {
    for (const int control : piece.controls) {
      if (control < 0) continue;
      const int choice = dynamics_->choice_of_control()[static_cast<std::size_t>(control)];
      if (choice >= 0) connect(piece.columns, choice);
      for (const int second : piece.controls) {
        const int other = second < 0 ? -1 : dynamics_->choice_of_control()[static_cast<std::size_t>(second)];
        if (choice >= 0 && other >= 0 && other < choice) plain_pairs_.insert({choice, other});
      }
    }
  }
  for (std::size_t i = 0; i < limits_->rows().size(); ++i) {
    if (limits_->rows()[i].choice >= 0) connect(limits_->columns(i), limits_->rows()[i].choice);
  }
  control_pairs_.assign(controls.begin(), controls.end());
}

void Transcription::scale_objective(const Trajectory& guess) {
  if (!move_to(unknowns_of(guess))) return;
  Eigen::VectorXd g(layout_.n);
  gradient(g);
  double largest = layout_.n > 0 ? g.lpNorm<Eigen::Infinity>() : 0.0;
  // Squares may have their minimum at the guess.
  std::vector<double> second(hessian_entries_.pattern().size());
  hessian(1.0, Eigen::VectorXd::Zero(n_rows_), second.data());
  for (const double entry : second) largest = std::max(largest, std::abs(entry));
  if (largest > 0.0 && std::isfinite(largest)) objective_factor_ = 1.0 / largest;
}

}  // namespace muldi::control
