#include "fem/solid/solid_iteration.hpp"

namespace muldi::fem {
namespace {

constexpr int most_iterations = 600;
constexpr int gmres_restart = 30;

}  // namespace

SolidIteration::SolidIteration(const math::SymmetricBlockPattern& pattern, const math::NodeMask& mask,
                               std::vector<std::vector<int>> electrodes, Options options)
    : SolidLinear(pattern, mask, std::move(electrodes)),
      options_(options),
      preconditioner_(pattern, options.degrees),
      gmres_(gmres_restart) {}

std::string SolidIteration::name_of(const Options& options) {
  const std::string front = options.method == KrylovMethod::cg       ? "cg"
                            : options.method == KrylovMethod::minres ? "minres"
                                                                     : "gmres";
  return front + " (chebyshev, multigrid)";
}

double SolidIteration::bytes_of(const math::SymmetricBlockPattern& pattern, const Options& options) {
  const double n = static_cast<double>(pattern.n_rows());
  const double vectors = options.method == KrylovMethod::gmres ? 2.0 * gmres_restart : 10.0;
  // Positions in single precision; both triangles of the potential with its coarse matrices.
  const double blocks = 4.0 * 9.0 * pattern.n_blocks();
  const double multigrid = pattern.block_size() == 4 ? 1.5 * 8.0 * 2.0 * pattern.n_blocks() : 0.0;
  return blocks + multigrid + 8.0 * vectors * n;
}

int SolidIteration::factorise_free() {
  matrix_.constrain(mask_);
  return preconditioner_.update(matrix_) ? options_.expected_negative : -1;
}

void SolidIteration::solve_free(Eigen::VectorXd& x) {
  const bool gmres = options_.method == KrylovMethod::gmres;
  const auto product = [this](const Eigen::VectorXd& d, Eigen::VectorXd& out) { matrix_.multiply(d, out); };
  const auto inverse = [this, gmres](const Eigen::VectorXd& r, Eigen::VectorXd& z) {
    if (z.size() != r.size()) z.resize(r.size());
    preconditioner_.apply(r, z, gmres ? math::PotentialSign::of_the_matrix : math::PotentialSign::positive);
  };
  rhs_ = x;
  x.setZero();
  const math::KrylovLimits limits{.relative_tolerance = options_.accuracy, .max_iterations = most_iterations};
  math::KrylovOutcome outcome;
  switch (options_.method) {
    case KrylovMethod::cg:
      outcome = cg_.solve(product, inverse, rhs_, x, limits);
      break;
    case KrylovMethod::minres:
      outcome = minres_.solve(product, inverse, rhs_, x, limits);
      break;
    case KrylovMethod::gmres:
      outcome = gmres_.solve(product, inverse, rhs_, x, limits);
      break;
  }
  iterations_ += outcome.iterations;
}

}  // namespace muldi::fem
