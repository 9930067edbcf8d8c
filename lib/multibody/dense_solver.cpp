/// Joint-space Newton matrix with the loop rows, one dense LU of the matrix scaled to entries of size 1.
#include <Eigen/LU>
#include <cmath>

#include "base/error.hpp"
#include "multibody/projected_solvers.hpp"
#include "multibody/tree_manifold.hpp"

namespace muldi::multibody {
namespace {

/// Pivots of the scaled matrix below this are round-off: the motion has neither inertia nor stiffness.
constexpr double pivot_tolerance = 1e-14;

class DenseSolver final : public model::ProjectedSolver {
 public:
  explicit DenseSolver(const TreeManifold& manifold)
      : manifold_(manifold),
        n_(manifold.n_v() + manifold.n_c()),
        A_(n_, n_),
        right_rows_(manifold.n_c(), manifold.n_v()),
        lu_(n_),
        unit_(Eigen::VectorXd::Zero(manifold.n_v())),
        dq_(manifold.n_q()),
        df_(manifold.n_q()),
        column_(manifold.n_v()),
        rhs_(n_),
        solution_(n_),
        scale_(Eigen::VectorXd::Ones(n_)),
        weights_(2, manifold.tree().n_bodies + manifold.n_plain()) {}

  bool factorise(const model::Frame& left, const model::Frame& right, const math::BlockMatrix& K,
                 const Eigen::VectorXd& diagonal) override {
    const int n_v = manifold_.n_v();
    weigh(K);
    for (int k = 0; k < n_v; ++k) {
      unit_[k] = 1.0;
      manifold_.lift(right, unit_, dq_);
      unit_[k] = 0.0;
      K.multiply(dq_, df_);
      manifold_.project(left, df_, column_);
      A_.col(k).head(n_v) = column_;
      double size = size_of(dq_);
      if (diagonal.size() > 0) {
        A_(k, k) += diagonal[k];
        size += std::abs(diagonal[k]);
      }
      scale_[k] = size > 0.0 ? 1.0 / std::sqrt(size) : 1.0;
    }
    if (manifold_.n_c() > 0) {
      const auto& at = static_cast<const TreeFrame&>(left);
      manifold_.project_constraints(right, at.loop_basis, right_rows_);
      A_.topRightCorner(n_v, manifold_.n_c()) = at.loop_rows.transpose();
      A_.bottomLeftCorner(manifold_.n_c(), n_v) = right_rows_;
      A_.bottomRightCorner(manifold_.n_c(), manifold_.n_c()).setZero();
    }
    if (n_ == 0) return true;
    for (int i = n_v; i < n_; ++i) {
      const double row = A_.row(i).head(n_v).transpose().cwiseProduct(scale_.head(n_v)).lpNorm<Eigen::Infinity>();
      scale_[i] = row > 0.0 ? 1.0 / row : 1.0;
    }
    for (int k = 0; k < n_; ++k) A_.col(k) = scale_[k] * A_.col(k).cwiseProduct(scale_);
    lu_.compute(A_);
    const auto pivots = lu_.matrixLU().diagonal().cwiseAbs();
    return std::isfinite(pivots.maxCoeff()) && pivots.minCoeff() > pivot_tolerance;
  }

  void solve(const Eigen::VectorXd& r, const Eigen::VectorXd& g, Eigen::VectorXd& w, Eigen::VectorXd& mu) override {
    if (n_ == 0) return;
    rhs_.head(manifold_.n_v()) = r;
    rhs_.tail(manifold_.n_c()) = g;
    rhs_.array() *= scale_.array();
    solution_.noalias() = lu_.permutationP() * rhs_;
    lu_.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(solution_);
    lu_.matrixLU().triangularView<Eigen::Upper>().solveInPlace(solution_);
    solution_.array() *= scale_.array();
    w = solution_.head(manifold_.n_v());
    mu = solution_.tail(manifold_.n_c());
  }

  std::string name() const override { return "dense"; }

 private:
  /// The diagonal of K: of positions and of directors of each body, of single unknowns.
  void weigh(const math::BlockMatrix& K) {
    const math::BlockPattern& pattern = K.pattern();
    for (int node = 0; node < pattern.n_nodes(); ++node) {
      const math::BlockSlot slot = pattern.slot(node, node);
      weights_.col(node).setZero();
      for (int k = 0; k < pattern.size(node); ++k) {
        weights_(k < 3 ? 0 : 1, node) += std::abs(K.data(slot)[k * slot.stride + k]);
      }
    }
  }

  /// What dq^T K dq would be if no terms cancelled: turns weigh the inertia of the body about all axes, so that a turn
  /// about an axis without inertia is seen as such.
  double size_of(const Eigen::VectorXd& dq) const {
    const int n_bodies = manifold_.tree().n_bodies;
    double size = 0.0;
    for (int body = 0; body < n_bodies; ++body) {
      size += weights_(0, body) * dq.segment<3>(12 * body).squaredNorm();
      size += weights_(1, body) * 0.5 * dq.segment<9>(12 * body + 3).squaredNorm();
    }
    for (int k = 0; k < manifold_.n_plain(); ++k) {
      size += weights_(0, n_bodies + k) * dq[12 * n_bodies + k] * dq[12 * n_bodies + k];
    }
    return size;
  }

  const TreeManifold& manifold_;
  int n_;
  Eigen::MatrixXd A_;
  Eigen::MatrixXd right_rows_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  Eigen::VectorXd unit_;
  Eigen::VectorXd dq_;
  Eigen::VectorXd df_;
  Eigen::VectorXd column_;
  Eigen::VectorXd rhs_;
  Eigen::VectorXd solution_;
  Eigen::VectorXd scale_;     // of rows and columns
  Eigen::Matrix2Xd weights_;  // a column a node
};

/// Up to this size the dense matrix is the faster one where the tree solver does not apply.
constexpr int dense_limit = 60;

}  // namespace

std::unique_ptr<model::ProjectedSolver> make_dense_solver(const TreeManifold& manifold) {
  return std::make_unique<DenseSolver>(manifold);
}

std::unique_ptr<model::ProjectedSolver> make_projected_solver(const TreeManifold& manifold,
                                                              const math::BlockPattern& pattern,
                                                              const std::string& kind) {
  const bool local = is_tree_local(manifold, pattern);
  if (kind == "tree" && !local) {
    throw base::InputError(
        "solver.linear: 'tree' needs a system without loops whose muscles and springs join neighbours in the tree; "
        "use auto, dense or bordered");
  }
  if (kind == "tree" || (kind == "auto" && local)) return make_tree_solver(manifold, pattern);
  if (kind == "bordered" || (kind == "auto" && manifold.n_v() > dense_limit))
    return make_bordered_solver(manifold, pattern);
  return make_dense_solver(manifold);
}

}  // namespace muldi::multibody
