/// What a solid answers to the motion of the bodies that it is tied to, by its solver.
#include "fem/solid/solid_solver.hpp"

namespace muldi::fem {
namespace {

/// In the columns of the responses, with which an iteration has exact residuals.
constexpr double refined_column = 1e-9;

}  // namespace

void SolidSolver::make_responses() {
  Eigen::MatrixXd& W = responses_.displacements();
  responses_.impose();
  for (Eigen::Index j = 0; j < W.cols(); ++j) solid_.bonds().follow(pattern_.block_size(), W.col(j));
  imposed_ = W;
  for (Eigen::Index j = 0; j < W.cols(); ++j) linear_->matrix().multiply(imposed_.col(j), W.col(j));
  linear_->solve_columns(W);
  W = imposed_ - W;
  if (exact() && solid_.is_incompressible()) {
    if (!keep_volumes_exactly()) {
      W = imposed_;
      make_exact_responses();
    }
  } else {
    for (Eigen::Index j = 0; j < W.cols() && solid_.has_pressures(); ++j) {
      for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) {
        dx_.segment<3>(3 * node) = W.col(j).segment<3>(pattern_.block_size() * node);
      }
      lagged_.project(solid_.elements(), dx_, dp_);
      responses_.pressures().col(j) = coupling_.cwiseProduct(dp_).cwiseQuotient(compliance_);
    }
  }
  responses_.condense(linear_->matrix());
}

bool SolidSolver::keep_volumes_exactly() {
  if (solid_.filter().n_patterns() > 0) return false;
  return exact_responses_.keep_volumes({.elements = solid_.elements(),
                                        .volumes = lagged_,
                                        .coupling = coupling_,
                                        .compliance = compliance_,
                                        .proximal = proximal,
                                        .relative_accuracy = refined_column,
                                        .most_iterations = max_refinements},
                                       *linear_, responses_.displacements(), responses_.pressures());
}

/// Column by column, also beyond a loss of stability.
void SolidSolver::make_exact_responses() {
  refined_ = refined_column;
  const Eigen::Index block = pattern_.block_size();
  Eigen::MatrixXd& W = responses_.displacements();
  for (Eigen::Index j = 0; j < W.cols(); ++j) {
    linear_->matrix().multiply(W.col(j), rhs_);
    for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) {
      dx_.segment<3>(3 * node) = W.col(j).segment<3>(block * node);
      residual_.x.segment<3>(3 * node) = -rhs_.segment<3>(block * node);
      if (block == 4) residual_.phi[node] = -rhs_[4 * node + potential_bit] / potential_rows_;
    }
    lagged_.project(solid_.elements(), dx_, rows_);
    residual_.p = -coupling_.cwiseProduct(rows_);
    // The matrix holds the eliminated pressures, which the solution adds once more.
    dp_ = -coupling_.cwiseProduct(residual_.p).cwiseQuotient(compliance_);
    lagged_.add_gradients(solid_.elements(), dp_, residual_.x);
    solve_lagged(residual_, total_);
    for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) {
      W.col(j).segment<3>(block * node) += total_.x.segment<3>(3 * node);
      if (block == 4) W(4 * node + potential_bit, j) += total_.phi[node];
    }
    responses_.pressures().col(j) = total_.p;
  }
  refined_ = refined;
}

void SolidSolver::add_motion_of_bodies(const Eigen::VectorXd& dq) {
  const Eigen::Index block = pattern_.block_size();
  responses_.read_bodies(turning_, dq);
  rhs_.setZero();
  responses_.add_displacements(rhs_);
  for (Eigen::Index node = 0; node < pattern_.n_nodes(); ++node) {
    total_.x.segment<3>(3 * node) += rhs_.segment<3>(block * node);
    if (block == 4) total_.phi[node] += rhs_[4 * node + potential_bit];
  }
  if (solid_.has_pressures()) responses_.add_pressures(total_.p);
}

}  // namespace muldi::fem
