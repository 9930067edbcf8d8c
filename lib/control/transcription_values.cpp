/// Values and derivatives of the transcription.
#include <algorithm>

#include "control/transcription.hpp"

namespace muldi::control {
namespace {

/// Multiplies the entries of a pattern by the scales of their rows and columns.
void scale_values(const SparsePattern& pattern, const Eigen::VectorXd& rows, const Eigen::VectorXd& columns,
                  double* values) {
  for (std::size_t i = 0; i < pattern.size(); ++i) values[i] *= rows[pattern.rows[i]] * columns[pattern.columns[i]];
}

}  // namespace

bool Transcription::move_to(const Eigen::VectorXd& x) {
  unknowns_ = x.cwiseProduct(scale_x_);
  if (!dynamics_->move_to(unknowns_)) return false;
  for (std::size_t end = 0; end < 2; ++end) {
    const int node = end == 0 ? 0 : layout_.n_steps;
    Eigen::VectorXd lambda = Eigen::VectorXd::Zero(layout_.n_c);
    if (end == 1 && layout_.equilibrium_lambda >= 0)
      lambda = unknowns_.segment(layout_.equilibrium_lambda, layout_.n_c);
    if (ends_[end]->n_rows() > 0) ends_[end]->move_to(dynamics_->node(node).theta, lambda);
    const EndMotion& motion = layout_.motion[end];
    if (!motion.exists()) continue;
    motions_[end]->move_to(unknowns_.segment(motion.rates, layout_.n_v),
                           unknowns_.segment(motion.momenta, layout_.n_v));
  }
  return true;
}

double Transcription::objective() { return objective_factor_ * objectives_.value(unknowns_, layout_, *dynamics_); }

void Transcription::gradient(Eigen::VectorXd& out) {
  out.setZero(layout_.n);
  objectives_.add_gradient(unknowns_, layout_, *dynamics_, out);
  out = objective_factor_ * out.cwiseProduct(scale_x_);
}

void Transcription::constraints(Eigen::VectorXd& out) {
  out.setZero(n_rows_);
  Eigen::VectorXd row(layout_.n_v);
  Eigen::VectorXd closing(layout_.n_c);
  for (int n = 0; n <= layout_.n_steps; ++n) {
    const auto at = static_cast<std::size_t>(n);
    if (balance_row_[at] >= 0) {
      dynamics_->balance(n, row);
      out.segment(balance_row_[at], layout_.n_v) = row;
    }
    if (closing_row_[at] < 0) continue;
    dynamics_->closing(n, closing);
    out.segment(closing_row_[at], layout_.n_c) = closing;
  }
  for (std::size_t end = 0; end < 2; ++end) {
    const int node = end == 0 ? 0 : layout_.n_steps;
    const int balance = balance_row_[static_cast<std::size_t>(node)];
    const double sign = end == 0 ? 1.0 : -1.0;
    const EndMotion& motion = layout_.motion[end];
    if (balance >= 0) {
      if (motion.exists()) {
        out.segment(balance, layout_.n_v) += sign * unknowns_.segment(motion.momenta, layout_.n_v);
      } else {
        out.segment(balance, layout_.n_v) += sign * end_momenta_[end];
      }
    }
    if (ends_[end]->n_rows() > 0) out.segment(end_row_[end], ends_[end]->n_rows()) = ends_[end]->values();
    if (motion.exists()) out.segment(motion_row_[end], motions_[end]->n_rows()) = motions_[end]->values();
  }
  for (std::size_t i = 0; i < limits_->rows().size(); ++i) {
    const LimitRow& limit = limits_->rows()[i];
    const double w = limit.choice >= 0 ? unknowns_[layout_.w(limit.interval, limit.choice)] : 0.0;
    out[limit_row_ + static_cast<Eigen::Index>(i)] = limits_->value(limit, *dynamics_, w);
  }
  int turn = turn_row_;
  for (int which = 0; which < turns_->n_rows(); ++which) {
    for (int k = 0; k < layout_.n_steps; ++k) out[turn++] = turns_->value(which, k, *dynamics_);
  }
  int peak = peak_row_;
  for (int c = 0; c < layout_.n_u && objectives_.has_peak(); ++c) {
    const double factor = objectives_.peak_factors()[static_cast<std::size_t>(c)];
    for (int k = 0; k < layout_.n_steps && factor != 0.0; ++k) {
      const double u = dynamics_->control_value(c, unknowns_[layout_.w(k, c)]);
      out[peak++] = unknowns_[layout_.peak] - factor * u * u;
    }
  }
  out = out.cwiseProduct(scale_c_);
}

void Transcription::jacobian(double* values) {
  dynamics_->jacobian(jacobian_);
  for (std::size_t end = 0; end < 2; ++end) {
    if (ends_[end]->n_rows() > 0) end_jacobian_[end] = ends_[end]->jacobian(end_by_lambda_[end]);
  }
  jacobian_entries_.begin(values);
  write_jacobian();
  scale_values(jacobian_entries_.pattern(), scale_c_, scale_x_, values);
}

void Transcription::write_node_rows(int n) {
  const auto at = static_cast<std::size_t>(n);
  const int row = balance_row_[at];
  SparseEntries& out = jacobian_entries_;
  if (row >= 0) {
    for (const auto& [r, c] : theta_pairs_) {
      if (n > 0) out.add(row + r, layout_.theta(n - 1, c), jacobian_.previous[at](r, c));
      out.add(row + r, layout_.theta(n, c), jacobian_.diagonal[at](r, c));
      if (n < layout_.n_steps) out.add(row + r, layout_.theta(n + 1, c), jacobian_.next[at](r, c));
    }
    for (const auto& [r, c] : control_pairs_) {
      if (n > 0) out.add(row + r, layout_.w(n - 1, c), jacobian_.by_w_before[at](r, c));
      if (n < layout_.n_steps) out.add(row + r, layout_.w(n, c), jacobian_.by_w_after[at](r, c));
    }
    for (int r = 0; r < layout_.n_v; ++r) {
      out.add(row + r, layout_.step, jacobian_.by_step[at][r]);
      for (int c = 0; c < layout_.n_c; ++c) out.add(row + r, layout_.lambda(n, c), jacobian_.by_lambda[at](r, c));
    }
  }
  if (closing_row_[at] < 0) return;
  for (int r = 0; r < layout_.n_c; ++r) {
    for (int c = 0; c < layout_.n_v; ++c)
      out.add(closing_row_[at] + r, layout_.theta(n, c), jacobian_.closing[at](r, c));
  }
}

void Transcription::write_end_rows(int end) {
  const auto e = static_cast<std::size_t>(end);
  const int node = end == 0 ? 0 : layout_.n_steps;
  SparseEntries& out = jacobian_entries_;
  for (int r = 0; r < ends_[e]->n_rows(); ++r) {
    for (int c = 0; c < layout_.n_v; ++c) out.add(end_row_[e] + r, layout_.theta(node, c), end_jacobian_[e](r, c));
    for (int c = 0; c < layout_.n_c && end == 1 && layout_.equilibrium_lambda >= 0; ++c) {
      out.add(end_row_[e] + r, layout_.equilibrium_lambda + c, end_by_lambda_[e](r, c));
    }
  }
  const EndMotion& motion = layout_.motion[e];
  if (!motion.exists()) return;
  const int balance = balance_row_[static_cast<std::size_t>(node)];
  for (int k = 0; k < layout_.n_v; ++k) {
    if (balance >= 0) out.add(balance + k, motion.momenta + k, end == 0 ? 1.0 : -1.0);
    out.add(motion_row_[e] + k, motion.momenta + k, -1.0);
  }
  Eigen::MatrixXd by_theta = Eigen::MatrixXd::Zero(motions_[e]->n_rows(), layout_.n_v);
  Eigen::MatrixXd by_rates = by_theta;
  if (out.writing()) motions_[e]->jacobian(by_theta, by_rates);
  for (int r = 0; r < motions_[e]->n_rows(); ++r) {
    for (int c = 0; c < layout_.n_v; ++c) {
      out.add(motion_row_[e] + r, layout_.theta(node, c), by_theta(r, c));
      out.add(motion_row_[e] + r, motion.rates + c, by_rates(r, c));
    }
  }
}

void Transcription::write_limit_rows() {
  SparseEntries& out = jacobian_entries_;
  for (std::size_t i = 0; i < limits_->rows().size(); ++i) {
    const LimitRow& limit = limits_->rows()[i];
    const int row = limit_row_ + static_cast<int>(i);
    LimitDerivatives d{.by_theta = Eigen::RowVectorXd::Zero(layout_.n_v)};
    if (out.writing()) {
      const double w = limit.choice >= 0 ? unknowns_[layout_.w(limit.interval, limit.choice)] : 0.0;
      d = limits_->derivatives(limit, *dynamics_, w);
    }
    for (const int c : limits_->columns(i)) out.add(row, layout_.theta(limit.node, c), d.by_theta[c]);
    if (limit.choice >= 0) out.add(row, layout_.w(limit.interval, limit.choice), d.by_w);
  }
  int peak = peak_row_;
  for (int c = 0; c < layout_.n_u && objectives_.has_peak(); ++c) {
    const auto at = static_cast<std::size_t>(c);
    const ControlChoice& choice = problem_.controls[at];
    const double factor = objectives_.peak_factors()[at] * choice.reference * choice.reference;
    for (int k = 0; k < layout_.n_steps && factor != 0.0; ++k) {
      const double slope =
          choice.kind == ControlKind::squared || !out.writing() ? factor : 2.0 * factor * unknowns_[layout_.w(k, c)];
      out.add(peak, layout_.peak, 1.0);
      out.add(peak++, layout_.w(k, c), -slope);
    }
  }
}

void Transcription::write_turn_rows() {
  SparseEntries& out = jacobian_entries_;
  Eigen::VectorXd by_begin;
  Eigen::VectorXd by_end;
  int turn = turn_row_;
  for (int row = 0; row < turns_->n_rows(); ++row) {
    const std::vector<int>& columns = turns_->columns(row);
    by_begin.setZero(static_cast<Eigen::Index>(columns.size()));
    by_end = by_begin;
    for (int k = 0; k < layout_.n_steps; ++k, ++turn) {
      if (out.writing()) turns_->derivatives(row, k, *dynamics_, by_begin, by_end);
      for (std::size_t i = 0; i < columns.size(); ++i) {
        out.add(turn, layout_.theta(k, columns[i]), by_begin[static_cast<Eigen::Index>(i)]);
        out.add(turn, layout_.theta(k + 1, columns[i]), by_end[static_cast<Eigen::Index>(i)]);
      }
    }
  }
}

void Transcription::write_jacobian() {
  write_end_rows(0);
  for (int n = 0; n <= layout_.n_steps; ++n) write_node_rows(n);
  write_end_rows(1);
  write_limit_rows();
  write_turn_rows();
}

void Transcription::hessian(double factor, const Eigen::VectorXd& mu, double* values) {
  const Eigen::VectorXd weights = mu.cwiseProduct(scale_c_);
  for (int n = 0; n <= layout_.n_steps; ++n) {
    const auto at = static_cast<std::size_t>(n);
    m_[at].setZero();
    nu_[at].setZero();
    if (balance_row_[at] >= 0) m_[at] = weights.segment(balance_row_[at], layout_.n_v);
    if (closing_row_[at] >= 0) nu_[at] = weights.segment(closing_row_[at], layout_.n_c);
  }
  dynamics_->hessian(m_, nu_, hessian_);
  objectives_.add_hessian(factor * objective_factor_, layout_, *dynamics_, hessian_);
  for (std::size_t i = 0; i < limits_->rows().size(); ++i) {
    const LimitRow& limit = limits_->rows()[i];
    const double w = limit.choice >= 0 ? unknowns_[layout_.w(limit.interval, limit.choice)] : 0.0;
    limits_->add_hessian(limit, weights[limit_row_ + static_cast<Eigen::Index>(i)], *dynamics_, w, hessian_);
  }
  int turn = turn_row_;
  for (int row = 0; row < turns_->n_rows(); ++row) {
    for (int k = 0; k < layout_.n_steps; ++k) {
      turns_->add_hessian(row, k, weights[turn++], *dynamics_, hessian_);
    }
  }
  int peak = peak_row_;
  for (int c = 0; c < layout_.n_u && objectives_.has_peak(); ++c) {
    const ControlChoice& choice = problem_.controls[static_cast<std::size_t>(c)];
    const double of_u = objectives_.peak_factors()[static_cast<std::size_t>(c)];
    for (int k = 0; k < layout_.n_steps && of_u != 0.0; ++k, ++peak) {
      if (choice.kind == ControlKind::squared) continue;
      hessian_.ww[static_cast<std::size_t>(k)](c, c) -=
          2.0 * weights[peak] * of_u * choice.reference * choice.reference;
    }
  }
  equilibrium_lambda_.setZero();
  for (std::size_t end = 0; end < 2; ++end) {
    if (ends_[end]->n_rows() == 0) continue;
    const auto at = static_cast<std::size_t>(end == 0 ? 0 : layout_.n_steps);
    ends_[end]->add_hessian(weights.segment(end_row_[end], ends_[end]->n_rows()), hessian_.diagonal[at],
                            equilibrium_lambda_);
  }
  hessian_entries_.begin(values);
  motion_weights_ = &weights;
  change_factor_ = factor * objective_factor_;
  write_extra_hessian();
  dynamics_->finish(hessian_);
  write_hessian_blocks();
  scale_values(hessian_entries_.pattern(), scale_x_, scale_x_, values);
}

void Transcription::write_hessian() {
  write_extra_hessian();
  write_hessian_blocks();
}

void Transcription::write_extra_hessian() {
  SparseEntries& out = hessian_entries_;
  for (std::size_t end = 0; end < 2; ++end) {
    const EndMotion& motion = layout_.motion[end];
    if (!motion.exists()) continue;
    const int node = end == 0 ? 0 : layout_.n_steps;
    Eigen::MatrixXd rates_theta = Eigen::MatrixXd::Zero(layout_.n_v, layout_.n_v);
    if (out.writing()) {
      motions_[end]->add_hessian(motion_weights_->segment(motion_row_[end], motions_[end]->n_rows()),
                                 hessian_.diagonal[static_cast<std::size_t>(node)], rates_theta);
    }
    for (int r = 0; r < layout_.n_v; ++r) {
      for (int c = 0; c < layout_.n_v; ++c) out.add(motion.rates + r, layout_.theta(node, c), rates_theta(r, c));
      if (end == 1 && objectives_.has_kinetic_energy()) {
        out.add(motion.momenta + r, motion.rates + r, 0.5 * change_factor_ * objectives_.kinetic_factor());
      }
    }
  }
  for (int c = 0; c < layout_.n_u; ++c) {
    const double factor = objectives_.change_factor(c);
    for (int k = 1; k < layout_.n_steps && factor != 0.0; ++k) {
      out.add(layout_.w(k, c), layout_.w(k - 1, c), -2.0 * change_factor_ * factor);
    }
  }
  for (int r = 0; r < layout_.n_c && layout_.equilibrium_lambda >= 0; ++r) {
    for (int c = 0; c < layout_.n_v; ++c) {
      out.add(layout_.equilibrium_lambda + r, layout_.theta(layout_.n_steps, c), equilibrium_lambda_(r, c));
    }
  }
}

void Transcription::write_hessian_blocks() {
  SparseEntries& out = hessian_entries_;
  for (int n = 0; n <= layout_.n_steps; ++n) {
    const auto at = static_cast<std::size_t>(n);
    for (const auto& [r, c] : theta_pairs_) {
      if (c <= r) out.add(layout_.theta(n, r), layout_.theta(n, c), hessian_.diagonal[at](r, c));
      if (n < layout_.n_steps) out.add(layout_.theta(n + 1, r), layout_.theta(n, c), hessian_.below[at](r, c));
    }
    for (int r = 0; r < layout_.n_v; ++r) {
      out.add(layout_.step, layout_.theta(n, r), hessian_.step_theta[at][r]);
      for (int i = 0; i < layout_.n_c; ++i)
        out.add(layout_.lambda(n, i), layout_.theta(n, r), hessian_.lambda[at](i, r));
    }
    if (n == layout_.n_steps) break;
    for (const auto& [r, c] : control_pairs_) {
      out.add(layout_.w(n, c), layout_.theta(n, r), hessian_.w_begin[at](c, r));
      out.add(layout_.theta(n + 1, r), layout_.w(n, c), hessian_.w_end[at](c, r));
    }
    for (int c = 0; c < layout_.n_u; ++c) {
      out.add(layout_.step, layout_.w(n, c), hessian_.step_w[at][c]);
      for (int d = 0; d <= c; ++d) {
        if (c == d || plain_pairs_.count({c, d}) > 0) out.add(layout_.w(n, c), layout_.w(n, d), hessian_.ww[at](c, d));
      }
    }
  }
  out.add(layout_.step, layout_.step, hessian_.step_step);
}

}  // namespace muldi::control
