#include "math/krylov.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.hpp"
#include "math/vector_loops.hpp"

namespace muldi::math {
namespace {

double norm(const Eigen::VectorXd& x) { return std::sqrt(dot(x, x)); }

double target(const KrylovLimits& limits, double norm_b) {
  return std::max(limits.relative_tolerance * norm_b, limits.absolute_tolerance);
}

/// r = b - A x
void residual(LinearMap a, const Eigen::VectorXd& b, const Eigen::VectorXd& x, Eigen::VectorXd& r) {
  a(x, r);
  for_vector_chunks(b.size(), [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    r.segment(first, n) = b.segment(first, n) - r.segment(first, n);
  });
}

/// y = a y + x
void scale_and_add(Eigen::VectorXd& y, double a, const Eigen::VectorXd& x) {
  for_vector_chunks(x.size(), [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    y.segment(first, n) = a * y.segment(first, n) + x.segment(first, n);
  });
}

}  // namespace

KrylovOutcome ConjugateGradients::solve(LinearMap a, LinearMap p, const Eigen::VectorXd& b, Eigen::VectorXd& x,
                                        const KrylovLimits& limits) {
  MULDI_EXPECT(b.size() == x.size() && &b != &x, "a start of the size of b");
  for (Eigen::VectorXd* v : {&r_, &z_, &d_, &q_}) v->resize(b.size());
  const double goal = target(limits, norm(b));
  residual(a, b, x, r_);
  KrylovOutcome outcome;
  outcome.residual = norm(r_);
  double rz = 0.0;
  double step = 0.0;
  while (outcome.residual > goal && outcome.iterations < limits.max_iterations) {
    p(r_, z_);
    const double rz_new = dot(r_, z_);
    if (outcome.iterations == 0) {
      d_ = z_;
    } else {
      // r - r_before = -step q, so that no further vector is kept.
      scale_and_add(d_, -step * dot(z_, q_) / rz, z_);
    }
    rz = rz_new;
    a(d_, q_);
    const double curvature = dot(d_, q_);
    if (!(rz > 0.0) || !(curvature > 0.0)) {
      outcome.end = KrylovEnd::breakdown;
      return outcome;
    }
    step = dot(d_, r_) / curvature;
    add_scaled(x, step, d_);
    add_scaled(r_, -step, q_);
    outcome.residual = norm(r_);
    ++outcome.iterations;
  }
  if (outcome.residual <= goal) outcome.end = KrylovEnd::converged;
  if (std::isnan(outcome.residual)) outcome.end = KrylovEnd::breakdown;
  return outcome;
}

KrylovOutcome Minres::solve(LinearMap a, LinearMap p, const Eigen::VectorXd& b, Eigen::VectorXd& x,
                            const KrylovLimits& limits) {
  MULDI_EXPECT(b.size() == x.size() && &b != &x, "a start of the size of b");
  for (Eigen::VectorXd* v : {&r_before_, &r_, &v_, &z_, &w_, &w_before_, &product_}) v->setZero(b.size());
  KrylovOutcome outcome;
  p(b, v_);
  const double goal = target(limits, std::sqrt(std::max(dot(b, v_), 0.0)));
  residual(a, b, x, r_);
  p(r_, z_);
  double beta_square = dot(r_, z_);
  double beta = std::sqrt(std::max(beta_square, 0.0));
  double beta_before = 1.0;
  double eta = beta;
  double c = 1.0, c_before = 1.0, s = 0.0, s_before = 0.0;
  outcome.residual = beta;
  if (!(beta_square >= 0.0) || !(dot(b, v_) >= 0.0)) {
    outcome.end = KrylovEnd::breakdown;
    return outcome;
  }
  while (outcome.residual > goal && outcome.iterations < limits.max_iterations && beta_square > 0.0) {
    v_ = z_ / beta;
    a(v_, product_);
    const double alpha = dot(v_, product_);
    // The next Lanczos vector, before the preconditioner, replaces the one before the last.
    for_vector_chunks(b.size(), [&](std::ptrdiff_t first, std::ptrdiff_t n) {
      r_before_.segment(first, n) = product_.segment(first, n) - alpha / beta * r_.segment(first, n) -
                                    beta / beta_before * r_before_.segment(first, n);
    });
    r_before_.swap(r_);
    p(r_, z_);
    beta_square = dot(r_, z_);
    if (!(beta_square >= 0.0)) break;
    const double beta_next = std::sqrt(beta_square);
    const double delta = c * alpha - c_before * s * beta;
    const double rho = std::hypot(delta, beta_next);
    const double rho_2 = s * alpha + c_before * c * beta;
    const double rho_3 = s_before * beta;
    if (!(rho > 0.0)) break;
    c_before = c;
    s_before = s;
    c = delta / rho;
    s = beta_next / rho;
    for_vector_chunks(b.size(), [&](std::ptrdiff_t first, std::ptrdiff_t n) {
      w_before_.segment(first, n) =
          (v_.segment(first, n) - rho_3 * w_before_.segment(first, n) - rho_2 * w_.segment(first, n)) / rho;
      x.segment(first, n) += c * eta * w_before_.segment(first, n);
    });
    w_before_.swap(w_);
    eta *= -s;
    outcome.residual = std::abs(eta);
    beta_before = beta;
    beta = beta_next;
    ++outcome.iterations;
  }
  const bool stuck = outcome.iterations < limits.max_iterations || !(beta_square >= 0.0);
  outcome.end = stuck ? KrylovEnd::breakdown : KrylovEnd::iteration_limit;
  if (outcome.residual <= goal) outcome.end = KrylovEnd::converged;
  return outcome;
}

FlexibleGmres::FlexibleGmres(int restart) : restart_(restart) {
  MULDI_EXPECT(restart >= 1, "at least one vector");
  basis_.resize(static_cast<std::size_t>(restart) + 1);
  preconditioned_.resize(static_cast<std::size_t>(restart));
  hessenberg_.resize(restart + 1, restart);
  for (Eigen::VectorXd* v : {&cosines_, &sines_, &y_}) v->resize(restart);
  g_.resize(restart + 1);
}

/// The next column of the Arnoldi relation by modified Gram and Schmidt; false if the product has no numbers.
bool FlexibleGmres::extend(LinearMap a, LinearMap p, int k) {
  const std::size_t i = static_cast<std::size_t>(k);
  preconditioned_[i].resize(basis_[0].size());
  basis_[i + 1].resize(basis_[0].size());
  p(basis_[i], preconditioned_[i]);
  a(preconditioned_[i], basis_[i + 1]);
  Eigen::VectorXd& next = basis_[i + 1];
  for (int j = 0; j <= k; ++j) {
    hessenberg_(j, k) = dot(basis_[static_cast<std::size_t>(j)], next);
    add_scaled(next, -hessenberg_(j, k), basis_[static_cast<std::size_t>(j)]);
  }
  hessenberg_(k + 1, k) = norm(next);
  if (!std::isfinite(hessenberg_(k + 1, k))) return false;
  if (hessenberg_(k + 1, k) > 0.0) next /= hessenberg_(k + 1, k);
  return true;
}

/// Applies the old rotations to column k and makes the one that clears its last entry; the new residual.
double FlexibleGmres::rotate(int k) {
  for (int j = 0; j < k; ++j) {
    const double upper = hessenberg_(j, k);
    hessenberg_(j, k) = cosines_(j) * upper + sines_(j) * hessenberg_(j + 1, k);
    hessenberg_(j + 1, k) = -sines_(j) * upper + cosines_(j) * hessenberg_(j + 1, k);
  }
  const double length = std::hypot(hessenberg_(k, k), hessenberg_(k + 1, k));
  // Nothing new: A maps this direction to where the others lead. It gets no part in the solution.
  const bool is_new = length > 1e-13 * hessenberg_.col(k).head(k + 2).norm();
  cosines_(k) = is_new ? hessenberg_(k, k) / length : 0.0;
  sines_(k) = is_new ? hessenberg_(k + 1, k) / length : 1.0;
  hessenberg_(k, k) = is_new ? length : 0.0;
  g_(k + 1) = -sines_(k) * g_(k);
  g_(k) *= cosines_(k);
  return std::abs(g_(k + 1));
}

/// x += the combination of the first k preconditioned vectors with the least residual.
void FlexibleGmres::correct(int k, Eigen::VectorXd& x) {
  for (int i = k - 1; i >= 0; --i) {
    double sum = g_(i);
    for (int j = i + 1; j < k; ++j) sum -= hessenberg_(i, j) * y_(j);
    y_(i) = hessenberg_(i, i) != 0.0 ? sum / hessenberg_(i, i) : 0.0;
  }
  for (int i = 0; i < k; ++i) add_scaled(x, y_(i), preconditioned_[static_cast<std::size_t>(i)]);
}

KrylovOutcome FlexibleGmres::solve(LinearMap a, LinearMap p, const Eigen::VectorXd& b, Eigen::VectorXd& x,
                                   const KrylovLimits& limits) {
  MULDI_EXPECT(b.size() == x.size() && &b != &x, "a start of the size of b");
  basis_[0].resize(b.size());
  const double goal = target(limits, norm(b));
  KrylovOutcome outcome;
  double before = std::numeric_limits<double>::infinity();
  while (true) {
    residual(a, b, x, basis_[0]);
    outcome.residual = norm(basis_[0]);
    if (outcome.residual <= goal) {
      outcome.end = KrylovEnd::converged;
      return outcome;
    }
    // A whole cycle without progress: A is singular, or P is useless.
    if (!(outcome.residual < before)) {
      outcome.end = KrylovEnd::breakdown;
      return outcome;
    }
    if (outcome.iterations >= limits.max_iterations) return outcome;
    before = outcome.residual;
    basis_[0] /= outcome.residual;
    g_(0) = outcome.residual;
    int k = 0;
    while (k < restart_ && outcome.iterations < limits.max_iterations && outcome.residual > goal) {
      if (!extend(a, p, k)) {
        outcome.end = KrylovEnd::breakdown;
        break;
      }
      outcome.residual = rotate(k);
      ++k;
      ++outcome.iterations;
    }
    correct(k, x);
    if (outcome.end == KrylovEnd::breakdown) return outcome;
    if (outcome.residual <= goal) {
      outcome.end = KrylovEnd::converged;
      return outcome;
    }
  }
}

}  // namespace muldi::math
