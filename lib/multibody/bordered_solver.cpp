/// The tree solver with a dense border for what reaches beyond neighbours: loop rows and couplings of bodies that are
/// not parent and child.
///
/// With the neighbour part A of the projected tangent, loop rows B, and far couplings N between the twists t_F = T_F w
/// of some bodies, z = N t_F,
///     A w + B_l^T mu + T_Fl^T z = r,   B_r w = g,   N T_Fr w - z = 0,
/// is reduced to a dense system for y = (mu, z): (R A^-1 C - D) y = R A^-1 r - (g, 0), with C = [B_l^T T_Fl^T],
/// R = [B_r; N T_Fr], D = diag(0, -1). The work is O(bodies x border + border^3).
#include <Eigen/LU>
#include <algorithm>

#include "multibody/projected_solvers.hpp"
#include "multibody/tree_manifold.hpp"
#include "multibody/twist_block.hpp"

namespace muldi::multibody {
namespace {

struct FarBlock {
  int row;  ///< position in the list of far links
  int column;
  math::BlockSlot slot;
};

class BorderedSolver final : public model::ProjectedSolver {
 public:
  BorderedSolver(const TreeManifold& manifold, const math::BlockPattern& pattern)
      : manifold_(manifold), tree_(manifold.tree()), inner_(make_tree_solver(manifold, pattern)) {
    for (int i = 0; i < tree_.n_bodies; ++i) {
      for (const int j : pattern.columns(i)) {
        if (are_neighbours(tree_, i, j)) continue;
        far_blocks_.push_back({far_index(i), far_index(j), pattern.slot(i, j)});
      }
    }
    const Eigen::Index n_v = manifold.n_v();
    n_c_ = manifold.n_c();
    const Eigen::Index n_far = 6 * static_cast<Eigen::Index>(far_links_.size());
    const Eigen::Index m = n_c_ + n_far;
    C_ = Eigen::MatrixXd::Zero(n_v, m);
    R_ = Eigen::MatrixXd::Zero(m, n_v);
    T_far_ = Eigen::MatrixXd::Zero(n_far, n_v);
    N_ = Eigen::MatrixXd::Zero(n_far, n_far);
    A_inverse_C_ = C_;
    B_ = Eigen::MatrixXd::Zero(n_c_, n_v);
    capacitance_ = Eigen::MatrixXd::Zero(m, m);
    lu_ = Eigen::PartialPivLU<Eigen::MatrixXd>(m);
    w_ = Eigen::VectorXd::Zero(n_v);
    column_ = w_;
    y_ = Eigen::VectorXd::Zero(m);
    permuted_ = y_;
  }

  bool factorise(const model::Frame& left, const model::Frame& right, const math::BlockMatrix& K,
                 const Eigen::VectorXd& diagonal) override {
    const auto& l_frame = static_cast<const TreeFrame&>(left);
    const auto& r_frame = static_cast<const TreeFrame&>(right);
    if (!inner_->factorise(left, right, K, diagonal)) return false;
    if (C_.cols() == 0) return true;
    C_.leftCols(n_c_) = l_frame.loop_rows.transpose();
    manifold_.project_constraints(right, l_frame.loop_basis, B_);
    R_.topRows(n_c_) = B_;
    far_columns(l_frame);
    C_.rightCols(T_far_.rows()) = T_far_.transpose();
    far_columns(r_frame);
    for (const FarBlock& block : far_blocks_) {
      const auto row = static_cast<std::size_t>(far_links_[static_cast<std::size_t>(block.row)]);
      const auto column = static_cast<std::size_t>(far_links_[static_cast<std::size_t>(block.column)]);
      N_.block<6, 6>(6 * block.row, 6 * block.column) =
          twist_block(K, block.slot, l_frame.links[row].pose.orientation, r_frame.links[column].pose.orientation);
    }
    R_.bottomRows(T_far_.rows()).noalias() = N_ * T_far_;
    for (Eigen::Index k = 0; k < C_.cols(); ++k) {
      column_ = C_.col(k);
      inner_->solve(column_, no_rows_, w_, no_rows_);
      A_inverse_C_.col(k) = w_;
    }
    capacitance_.noalias() = R_ * A_inverse_C_;
    capacitance_.bottomRightCorner(T_far_.rows(), T_far_.rows()).diagonal().array() += 1.0;
    lu_.compute(capacitance_);
    const auto pivots = lu_.matrixLU().diagonal().cwiseAbs();
    return std::isfinite(pivots.maxCoeff()) && pivots.minCoeff() > 0.0;
  }

  void solve(const Eigen::VectorXd& r, const Eigen::VectorXd& g, Eigen::VectorXd& w, Eigen::VectorXd& mu) override {
    inner_->solve(r, no_rows_, w, no_rows_);
    if (C_.cols() == 0) return;
    y_.noalias() = R_ * w;
    y_.head(n_c_) -= g;
    permuted_.noalias() = lu_.permutationP() * y_;
    lu_.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(permuted_);
    lu_.matrixLU().triangularView<Eigen::Upper>().solveInPlace(permuted_);
    w.noalias() -= A_inverse_C_ * permuted_;
    mu = permuted_.head(n_c_);
  }

  std::string name() const override { return "bordered"; }

 private:
  int far_index(int body) {
    const int link = tree_.link_of_body[static_cast<std::size_t>(body)];
    const auto known = std::find(far_links_.begin(), far_links_.end(), link);
    if (known != far_links_.end()) return static_cast<int>(known - far_links_.begin());
    far_links_.push_back(link);
    return static_cast<int>(far_links_.size()) - 1;
  }

  /// T_F: rows are the twists of the far links, found as joint forces of unit wrenches.
  void far_columns(const TreeFrame& frame) {
    for (std::size_t f = 0; f < far_links_.size(); ++f) {
      for (int k = 0; k < 6; ++k) {
        frame.twists.setZero();
        frame.twists(k, far_links_[f]) = 1.0;
        accumulate_wrenches(tree_, frame, frame.twists);
        column_.setZero();
        joint_forces_of(tree_, frame, frame.twists, column_);
        T_far_.row(static_cast<Eigen::Index>(6 * f) + k) = column_.transpose();
      }
    }
  }

  const TreeManifold& manifold_;
  const KinematicTree& tree_;
  std::unique_ptr<model::ProjectedSolver> inner_;
  std::vector<FarBlock> far_blocks_;
  std::vector<int> far_links_;
  Eigen::Index n_c_ = 0;
  Eigen::MatrixXd C_;
  Eigen::MatrixXd R_;
  Eigen::MatrixXd T_far_;
  Eigen::MatrixXd N_;
  Eigen::MatrixXd A_inverse_C_;
  Eigen::MatrixXd B_;
  Eigen::MatrixXd capacitance_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  Eigen::VectorXd w_;
  Eigen::VectorXd column_;
  Eigen::VectorXd y_;
  Eigen::VectorXd permuted_;
  Eigen::VectorXd no_rows_;
};

}  // namespace

std::unique_ptr<model::ProjectedSolver> make_bordered_solver(const TreeManifold& manifold,
                                                             const math::BlockPattern& pattern) {
  return std::make_unique<BorderedSolver>(manifold, pattern);
}

}  // namespace muldi::multibody
