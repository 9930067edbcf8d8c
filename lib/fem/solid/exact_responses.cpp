#include "fem/solid/exact_responses.hpp"

namespace muldi::fem {

void ExactResponses::project(const VolumeRows& rows, int block, const Eigen::MatrixXd& x, Eigen::MatrixXd& out) {
  const auto& cells = rows.elements.cells();
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    const double* column = x.col(j).data();
    const double* g = rows.volumes.gradient.data();
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      double sum = 0.0;
      for (const int node : cells[cell]) {
        const double* at = column + static_cast<Eigen::Index>(block) * node;
        for (int i = 0; i < 3; ++i) sum += *g++ * at[i];
      }
      const auto row = static_cast<Eigen::Index>(cell);
      out(row, j) = rows.coupling[row] * sum;
    }
  }
}

void ExactResponses::respond(const VolumeRows& rows, SolidLinear& linear, const Eigen::MatrixXd& p,
                             Eigen::MatrixXd& x) {
  const auto& cells = rows.elements.cells();
  const int block = linear.matrix().block_size();
  x.setZero();
  for (Eigen::Index j = 0; j < p.cols(); ++j) {
    double* column = x.col(j).data();
    const double* g = rows.volumes.gradient.data();
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      const auto row = static_cast<Eigen::Index>(cell);
      const double weight = rows.coupling[row] * p(row, j);
      for (const int node : cells[cell]) {
        double* at = column + static_cast<Eigen::Index>(block) * node;
        for (int i = 0; i < 3; ++i) at[i] += weight * *g++;
      }
    }
  }
  linear.solve_columns(x);
}

bool ExactResponses::keep_volumes(const VolumeRows& rows, SolidLinear& linear, Eigen::MatrixXd& W, Eigen::MatrixXd& P) {
  const int block = linear.matrix().block_size();
  const Eigen::Index n_columns = W.cols();
  x_.resize(W.rows(), n_columns);
  for (Eigen::MatrixXd* one : {&r_, &z_, &d_, &product_}) one->resize(P.rows(), n_columns);
  project(rows, block, W, r_);
  P.setZero();
  d_.setZero();
  const Eigen::VectorXd wanted = rows.relative_accuracy * r_.colwise().norm();
  Eigen::VectorXd before = Eigen::VectorXd::Ones(n_columns);
  for (int iteration = 0; iteration < rows.most_iterations; ++iteration) {
    bool done = true;
    for (Eigen::Index j = 0; j < n_columns; ++j) {
      // A column that is done stays as it is.
      if (r_.col(j).norm() <= wanted[j]) {
        d_.col(j).setZero();
        continue;
      }
      done = false;
      z_.col(j) = r_.col(j).cwiseQuotient(rows.compliance);
      const double now = r_.col(j).dot(z_.col(j));
      d_.col(j) = z_.col(j) + (iteration == 0 ? 0.0 : now / before[j]) * d_.col(j);
      before[j] = now;
    }
    if (done) {
      respond(rows, linear, P, x_);
      W -= (1.0 - rows.proximal) * x_;
      return true;
    }
    respond(rows, linear, d_, x_);
    project(rows, block, x_, product_);
    for (Eigen::Index j = 0; j < n_columns; ++j) {
      if (r_.col(j).norm() <= wanted[j]) continue;
      product_.col(j) =
          (1.0 - rows.proximal) * product_.col(j) + rows.proximal * rows.compliance.cwiseProduct(d_.col(j));
      const double curvature = d_.col(j).dot(product_.col(j));
      if (!(curvature > 0.0)) return false;
      const double step = before[j] / curvature;
      P.col(j) += step * d_.col(j);
      r_.col(j) -= step * product_.col(j);
    }
  }
  return false;
}

}  // namespace muldi::fem
