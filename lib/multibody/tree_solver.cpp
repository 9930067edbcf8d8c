/// Block elimination over the kinematic tree (the articulated-body idea, for the nonsymmetric Newton matrix of a step).
///
/// Let W_B be the wrench of the subtree of B caused by twists, W_B = A_B t_B + C_B t_A + w_B with its parent A. With
/// t_B = X_r t_A + S_r y and the rows S_l^T W_B = r_B, eliminating the joint rates y gives
///     D = S_l^T A_B S_r,  y = D^-1 (r_B - S_l^T w_B - U t_A),  U = S_l^T (A_B X_r + C_B),
/// and W_B, carried to A by X_l^T, is again affine in t_A. (X, S: T_a, T_b at the left or right frame.)
#include <Eigen/LU>
#include <cmath>

#include "multibody/projected_solvers.hpp"
#include "multibody/tree_manifold.hpp"
#include "multibody/twist_block.hpp"

namespace muldi::multibody {
namespace {

using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>;  // 6 x rates
using Rows = Eigen::Matrix<double, Eigen::Dynamic, 6, 0, 6, 6>;     // rates x 6
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;
using Rates = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;

/// Pivots of D below this fraction of the terms that sum up to them are round-off: the motion has neither inertia nor
/// stiffness.
constexpr double pivot_tolerance = 1e-14;

struct Node {
  math::BlockSlot diagonal;
  math::BlockSlot to_parent;    // row B, column A
  math::BlockSlot from_parent;  // row A, column B
  bool coupled = false;         // to the parent by the pattern
  Matrix6 A;                    // A_B
  Columns S_l;
  Columns S_r;
  Eigen::Vector3d arm_l;
  Eigen::Vector3d arm_r;
  Square D_inverse;
  Rows U;
  Columns V;  // A_B S_r
  Columns E;  // K_AB S_r
  Vector6 w;
  Rates y;
};

/// X t: the twist that B takes from its parent.
template <class Derived>
void carry(const Eigen::Vector3d& arm, Eigen::MatrixBase<Derived>& t) {
  t.template head<3>() += Eigen::Vector3d(t.template tail<3>()).cross(arm);
}

/// M X for 6 x 6 M: columns of rotation gain -v-columns hat(arm).
Matrix6 times_carry(const Matrix6& M, const Eigen::Vector3d& arm) {
  Matrix6 result = M;
  for (int row = 0; row < 6; ++row) {
    result.block<1, 3>(row, 3) += arm.cross(Eigen::Vector3d(M.block<1, 3>(row, 0).transpose())).transpose();
  }
  return result;
}

/// X^T M: a wrench about B becomes one about A.
template <class Matrix>
void carry_wrench(const Eigen::Vector3d& arm, Matrix& M) {
  for (Eigen::Index column = 0; column < M.cols(); ++column) {
    M.template block<3, 1>(3, column) += arm.cross(Eigen::Vector3d(M.template block<3, 1>(0, column)));
  }
}

class TreeSolver final : public model::ProjectedSolver {
 public:
  TreeSolver(const TreeManifold& manifold, const math::BlockPattern& pattern)
      : tree_(manifold.tree()), n_plain_(manifold.n_plain()), nodes_(tree_.links.size()), plain_(n_plain_) {
    for (std::size_t l = 0; l < nodes_.size(); ++l) {
      const TreeLink& link = tree_.links[l];
      nodes_[l].diagonal = pattern.slot(link.body, link.body);
      nodes_[l].coupled = link.parent != ground && pattern.contains(link.body, link.parent);
      if (!nodes_[l].coupled) continue;
      nodes_[l].to_parent = pattern.slot(link.body, link.parent);
      nodes_[l].from_parent = pattern.slot(link.parent, link.body);
    }
    for (int k = 0; k < n_plain_; ++k) {
      plain_slots_.push_back(pattern.slot(tree_.n_bodies + k, tree_.n_bodies + k));
    }
    twists_ = Twists::Zero(6, static_cast<Eigen::Index>(nodes_.size()));
  }

  bool factorise(const model::Frame& left, const model::Frame& right, const math::BlockMatrix& K) override {
    const auto& l_frame = static_cast<const TreeFrame&>(left);
    const auto& r_frame = static_cast<const TreeFrame&>(right);
    for (std::size_t l = 0; l < nodes_.size(); ++l) {
      nodes_[l].A =
          twist_block(K, nodes_[l].diagonal, l_frame.links[l].pose.orientation, r_frame.links[l].pose.orientation);
    }
    for (std::size_t l = nodes_.size(); l-- > 0;) {
      if (!eliminate(l, l_frame, r_frame, K)) return false;
    }
    for (int k = 0; k < n_plain_; ++k) plain_[k] = *K.data(plain_slots_[static_cast<std::size_t>(k)]);
    return n_plain_ == 0 || plain_.cwiseAbs().minCoeff() > 0.0;
  }

  void solve(const Eigen::VectorXd& r, const Eigen::VectorXd&, Eigen::VectorXd& rates, Eigen::VectorXd&) override {
    for (Node& node : nodes_) node.w.setZero();
    for (std::size_t l = nodes_.size(); l-- > 0;) {
      Node& node = nodes_[l];
      const TreeLink& link = tree_.links[l];
      Rates rest = r.segment(link.first_rate, node.U.rows());
      rest.noalias() -= node.S_l.transpose() * node.w;
      node.y.noalias() = node.D_inverse * rest;
      if (link.parent == ground) continue;
      Vector6 w = node.w + node.V * node.y;
      carry_wrench(node.arm_l, w);
      Node& parent = nodes_[parent_of(link)];
      parent.w += w;
      if (node.coupled) parent.w += node.E * node.y;
    }
    for (std::size_t l = 0; l < nodes_.size(); ++l) {
      Node& node = nodes_[l];
      const TreeLink& link = tree_.links[l];
      Vector6 t = Vector6::Zero();
      if (link.parent != ground) {
        t = twists_.col(static_cast<Eigen::Index>(parent_of(link)));
        node.y -= node.D_inverse * (node.U * t);
        carry(node.arm_r, t);
      }
      t += node.S_r * node.y;
      twists_.col(static_cast<Eigen::Index>(l)) = t;
      rates.segment(link.first_rate, node.y.size()) = node.y;
    }
    rates.tail(n_plain_) = r.tail(n_plain_).cwiseQuotient(plain_);
  }

  std::string name() const override { return "tree"; }

 private:
  std::size_t parent_of(const TreeLink& link) const {
    return static_cast<std::size_t>(tree_.link_of_body[static_cast<std::size_t>(link.parent)]);
  }

  bool eliminate(std::size_t l, const TreeFrame& left, const TreeFrame& right, const math::BlockMatrix& K) {
    Node& node = nodes_[l];
    const TreeLink& link = tree_.links[l];
    const int n = tree_.joint(link).pattern.n_rates();
    node.S_l = left.links[l].columns.leftCols(n);
    node.S_r = right.links[l].columns.leftCols(n);
    node.arm_l = left.links[l].arm;
    node.arm_r = right.links[l].arm;
    node.V.noalias() = node.A * node.S_r;
    const Square D = node.S_l.transpose() * node.V;
    const Columns terms = node.A.cwiseAbs() * node.S_r.cwiseAbs();
    if (!invert(D, node.S_l.cwiseAbs().cwiseProduct(terms).colwise().sum().transpose(), node.D_inverse)) return false;
    node.U.resize(n, 6);
    if (link.parent == ground) {
      node.U.setZero();
      return true;
    }
    const std::size_t p = parent_of(link);
    Matrix6 P = times_carry(node.A, node.arm_r);
    if (node.coupled) {
      P += twist_block(K, node.to_parent, left.links[l].pose.orientation, right.links[p].pose.orientation);
    }
    node.U.noalias() = node.S_l.transpose() * P;
    const Rows y_of_parent = node.D_inverse * node.U;
    P.noalias() -= node.V * y_of_parent;
    carry_wrench(node.arm_l, P);
    nodes_[p].A += P;
    if (node.coupled) {
      const Matrix6 K_AB =
          twist_block(K, node.from_parent, left.links[p].pose.orientation, right.links[l].pose.orientation);
      node.E.noalias() = K_AB * node.S_r;
      nodes_[p].A += times_carry(K_AB, node.arm_r);
      nodes_[p].A.noalias() -= node.E * y_of_parent;
    }
    return true;
  }

  /// `size`: sums of the magnitudes of the terms on the diagonal of D.
  static bool invert(const Square& D, const Rates& size, Square& inverse) {
    inverse.resize(D.rows(), D.cols());
    if (D.rows() == 0) return true;
    if (D.rows() == 1) {
      inverse(0, 0) = 1.0 / D(0, 0);
      return std::abs(D(0, 0)) > pivot_tolerance * size[0] && std::isfinite(inverse(0, 0));
    }
    const Rates scale = size.cwiseSqrt().cwiseInverse();
    const Square scaled = scale.asDiagonal() * D * scale.asDiagonal();
    const Eigen::PartialPivLU<Square> lu(scaled);
    if (!(lu.matrixLU().diagonal().cwiseAbs().minCoeff() > pivot_tolerance)) return false;
    inverse = scale.asDiagonal() * lu.inverse() * scale.asDiagonal();
    return true;
  }

  const KinematicTree& tree_;
  int n_plain_;
  std::vector<Node> nodes_;
  Eigen::VectorXd plain_;
  std::vector<math::BlockSlot> plain_slots_;
  Twists twists_;
};

}  // namespace

bool are_neighbours(const KinematicTree& tree, int body_i, int body_j) {
  return body_i == body_j || tree.link_of(body_i).parent == body_j || tree.link_of(body_j).parent == body_i;
}

bool is_tree_local(const TreeManifold& manifold, const math::BlockPattern& pattern) {
  const KinematicTree& tree = manifold.tree();
  if (manifold.n_c() > 0) return false;
  for (int i = 0; i < pattern.n_nodes(); ++i) {
    for (const int j : pattern.columns(i)) {
      if (i == j) continue;
      if (i >= tree.n_bodies || j >= tree.n_bodies) return false;
      if (!are_neighbours(tree, i, j)) return false;
    }
  }
  return true;
}

std::unique_ptr<model::ProjectedSolver> make_tree_solver(const TreeManifold& manifold,
                                                         const math::BlockPattern& pattern) {
  return std::make_unique<TreeSolver>(manifold, pattern);
}

}  // namespace muldi::multibody
