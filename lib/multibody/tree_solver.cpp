/// Block elimination over the kinematic tree (the articulated-body idea, for the nonsymmetric Newton matrix of a step).
///
/// Let W_B be the wrench of the subtree of B caused by twists, W_B = A_B t_B + C_B t_A + w_B with its parent A. With
/// t_B = X_r t_A + S_r y and the rows S_l^T W_B + diagonal y = r_B, eliminating the joint rates y gives
///     D = S_l^T A_B S_r + diagonal,  y = D^-1 (r_B - S_l^T w_B - U t_A),  U = S_l^T (A_B X_r + C_B),
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

/// Where a link stands in the tree and in the matrix.
struct Place {
  int parent = -1;  ///< link, or -1
  int first_rate = 0;
  int n = 0;             ///< rates
  bool coupled = false;  ///< to the parent by the pattern
  math::BlockSlot diagonal = {};
  math::BlockSlot to_parent = {};    // row B, column A
  math::BlockSlot from_parent = {};  // row A, column B
  std::size_t first_value = 0;
};

/// The factors of one link, which take what its rates need: of long chains they are most of the memory that a step
/// goes through.
struct Factors {
  Eigen::Map<Eigen::Vector3d> arm_l;
  Eigen::Map<Eigen::Vector3d> arm_r;
  Eigen::Map<Rates> y;
  Eigen::Map<Square> D_inverse;
  Eigen::Map<Columns> S_l;
  Eigen::Map<Columns> S_r;
  Eigen::Map<Rows> U;
  Eigen::Map<Columns> V;  // A_B S_r
  Eigen::Map<Columns> E;  // K_AB S_r, of coupled links

  Factors(const Place& place, double* values)
      : arm_l(values),
        arm_r(values + 3),
        y(values + 6, place.n),
        D_inverse(y.data() + place.n, place.n, place.n),
        S_l(D_inverse.data() + place.n * place.n, 6, place.n),
        S_r(S_l.data() + 6 * place.n, 6, place.n),
        U(S_r.data() + 6 * place.n, place.n, 6),
        V(U.data() + 6 * place.n, 6, place.n),
        E(V.data() + 6 * place.n, 6, place.coupled ? place.n : 0) {}

  static std::size_t size(const Place& place) {
    const auto n = static_cast<std::size_t>(place.n);
    return 6 + n + n * n + (place.coupled ? 30 : 24) * n;
  }
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
      : n_plain_(manifold.n_plain()), plain_(n_plain_) {
    const KinematicTree& tree = manifold.tree();
    std::size_t n_values = 0;
    for (const TreeLink& link : tree.links) {
      Place place{.first_rate = link.first_rate, .n = tree.joint(link).pattern.n_rates(), .first_value = n_values};
      place.diagonal = pattern.slot(link.body, link.body);
      if (link.parent != ground) {
        place.parent = tree.link_of_body[static_cast<std::size_t>(link.parent)];
        place.coupled = pattern.contains(link.body, link.parent);
      }
      if (place.coupled) {
        place.to_parent = pattern.slot(link.body, link.parent);
        place.from_parent = pattern.slot(link.parent, link.body);
      }
      n_values += Factors::size(place);
      places_.push_back(place);
    }
    values_.resize(n_values);
    A_.assign(places_.size(), Matrix6::Zero());
    for (int k = 0; k < n_plain_; ++k) {
      plain_slots_.push_back(pattern.slot(tree.n_bodies + k, tree.n_bodies + k));
    }
    twists_ = Twists::Zero(6, static_cast<Eigen::Index>(places_.size()));
  }

  bool factorise(const model::Frame& left, const model::Frame& right, const math::BlockMatrix& K,
                 const Eigen::VectorXd& diagonal) override {
    const System system{static_cast<const TreeFrame&>(left), static_cast<const TreeFrame&>(right), K, diagonal};
    bool regular = true;
    for (std::size_t l = places_.size(); l-- > 0;) {
      regular = regular && eliminate(l, system);
      A_[l].setZero();
    }
    if (!regular) return false;
    for (int k = 0; k < n_plain_; ++k) plain_[k] = *K.data(plain_slots_[static_cast<std::size_t>(k)]);
    if (diagonal.size() > 0) plain_ += diagonal.tail(n_plain_);
    return n_plain_ == 0 || plain_.cwiseAbs().minCoeff() > 0.0;
  }

  void solve(const Eigen::VectorXd& r, const Eigen::VectorXd&, Eigen::VectorXd& rates, Eigen::VectorXd&) override {
    twists_.setZero();  // first the wrenches w of the subtrees
    for (std::size_t l = places_.size(); l-- > 0;) {
      const Place& place = places_[l];
      Factors at = factors(place);
      Vector6 w = twists_.col(static_cast<Eigen::Index>(l));
      Rates rest = r.segment(place.first_rate, place.n);
      rest.noalias() -= at.S_l.transpose() * w;
      at.y.noalias() = at.D_inverse * rest;
      if (place.parent < 0) continue;
      w += at.V * at.y;
      carry_wrench(at.arm_l, w);
      if (place.coupled) w += at.E * at.y;
      twists_.col(place.parent) += w;
    }
    for (std::size_t l = 0; l < places_.size(); ++l) {
      const Place& place = places_[l];
      Factors at = factors(place);
      Vector6 t = Vector6::Zero();
      if (place.parent >= 0) {
        t = twists_.col(place.parent);
        at.y -= at.D_inverse * (at.U * t);
        carry(at.arm_r, t);
      }
      t += at.S_r * at.y;
      twists_.col(static_cast<Eigen::Index>(l)) = t;
      rates.segment(place.first_rate, place.n) = at.y;
    }
    rates.tail(n_plain_) = r.tail(n_plain_).cwiseQuotient(plain_);
  }

  std::string name() const override { return "tree"; }

 private:
  struct System {
    const TreeFrame& left;
    const TreeFrame& right;
    const math::BlockMatrix& K;
    const Eigen::VectorXd& diagonal;
  };

  Factors factors(const Place& place) { return {place, values_.data() + place.first_value}; }

  /// Eliminates the rates of link l; A_[l] holds what its children left, and is complete with the link's own block.
  bool eliminate(std::size_t l, const System& system) {
    const auto& [left, right, K, diagonal] = system;
    const Place& place = places_[l];
    const LinkFrame& at_l = left.links[l];
    const LinkFrame& at_r = right.links[l];
    Factors to = factors(place);
    Matrix6& A = A_[l];
    A += twist_block(K, place.diagonal, at_l.pose.orientation, at_r.pose.orientation);
    to.S_l = at_l.columns.leftCols(place.n);
    to.S_r = at_r.columns.leftCols(place.n);
    to.arm_l = at_l.arm;
    to.arm_r = at_r.arm;
    to.V.noalias() = A * to.S_r;
    Square D = to.S_l.transpose() * to.V;
    const Columns terms = A.cwiseAbs() * to.S_r.cwiseAbs();
    Rates size = to.S_l.cwiseAbs().cwiseProduct(terms).colwise().sum().transpose();
    if (diagonal.size() > 0) {
      D.diagonal() += diagonal.segment(place.first_rate, place.n);
      size += diagonal.segment(place.first_rate, place.n).cwiseAbs();
    }
    if (!invert(D, size, to.D_inverse)) return false;
    if (place.parent >= 0) {
      carry_to_parent(l, to, system);
    } else {
      to.U.setZero();
    }
    return true;
  }

  /// Adds what the eliminated link leaves on its parent.
  void carry_to_parent(std::size_t l, Factors& to, const System& system) {
    const auto& [left, right, K, diagonal] = system;
    const Place& place = places_[l];
    const auto p = static_cast<std::size_t>(place.parent);
    Matrix6 P = times_carry(A_[l], to.arm_r);
    if (place.coupled) {
      P += twist_block(K, place.to_parent, left.links[l].pose.orientation, right.links[p].pose.orientation);
    }
    to.U.noalias() = to.S_l.transpose() * P;
    const Rows y_of_parent = to.D_inverse * to.U;
    P.noalias() -= to.V * y_of_parent;
    carry_wrench(to.arm_l, P);
    A_[p] += P;
    if (!place.coupled) return;
    const Matrix6 K_AB =
        twist_block(K, place.from_parent, left.links[p].pose.orientation, right.links[l].pose.orientation);
    to.E.noalias() = K_AB * to.S_r;
    A_[p] += times_carry(K_AB, to.arm_r);
    A_[p].noalias() -= to.E * y_of_parent;
  }

  /// `size`: sums of the magnitudes of the terms on the diagonal of D.
  static bool invert(const Square& D, const Rates& size, Eigen::Map<Square>& inverse) {
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

  int n_plain_;
  std::vector<Place> places_;   // of the links, parents before children
  std::vector<double> values_;  // their factors
  std::vector<Matrix6> A_;      // A_B without the link's own block; zero between factorisations
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
