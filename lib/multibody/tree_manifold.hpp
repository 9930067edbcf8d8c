#pragma once
/// The constraint manifold of rigid multibody systems: trees on their own manifold, loops by multipliers, and plain
/// scalar unknowns (free lengths) beside the bodies.
#include <vector>

#include "multibody/null_space.hpp"

namespace muldi::multibody {

class TreeManifold final : public model::Manifold {
 public:
  /// `poses` (n_bodies): the scene pose, in which tree joints have coordinate zero. `plain`: reference values of scalar
  /// unknowns; they are the nodes after the bodies. `length`: size of the scene.
  /// The loops must close in the scene pose: the builder has checked it.
  TreeManifold(KinematicTree tree, const std::vector<Pose>& poses, std::vector<double> plain, double length);

  int n_x() const override { return tree_.n_coordinates + n_plain(); }
  int n_q() const override { return 12 * tree_.n_bodies + n_plain(); }
  int n_v() const override { return tree_.n_rates + n_plain(); }
  int n_loop_rows() const override { return static_cast<int>(rows_.size()); }
  int n_c() const override { return n_c_; }
  Eigen::VectorXd rate_scale() const override;
  Eigen::VectorXd reference() const override { return reference_; }
  void configuration(const Eigen::VectorXd& x, Eigen::VectorXd& q) const override;
  void retract(const Eigen::VectorXd& x, const Eigen::VectorXd& w, Eigen::VectorXd& x_new) const override;
  void difference(const Eigen::VectorXd& x_from, const Eigen::VectorXd& x_to, Eigen::VectorXd& w) const override;
  std::unique_ptr<model::Chart> make_chart() const override;
  std::unique_ptr<model::Frame> make_frame() const override;
  void update(const Eigen::VectorXd& x, const Eigen::VectorXd& q, model::Frame& frame) const override;
  model::LoopRank choose_loop_rows(model::Frame& frame) const override;
  const Eigen::MatrixXd& loop_basis(const model::Frame& frame) const override;
  void project(const model::Frame& frame, const Eigen::VectorXd& f, Eigen::VectorXd& r) const override;
  void lift(const model::Frame& frame, const Eigen::VectorXd& w, Eigen::VectorXd& dq) const override;
  void add_forces_on_rates(const model::Frame& frame, double factor, const Eigen::VectorXd& on_rates,
                           Eigen::VectorXd& f) const override;
  void constraints(const Eigen::VectorXd& q, Eigen::VectorXd& g) const override;
  void add_constraint_forces(const Eigen::VectorXd& q, double factor, const Eigen::VectorXd& lambda,
                             Eigen::VectorXd& f) const override;
  double violation(const Eigen::VectorXd& q) const override;
  void project_tangent(const model::Frame& left, const model::Frame& right, const math::BlockMatrix& K,
                       Eigen::MatrixXd& A) const override;
  void project_constraints(const model::Frame& frame, const Eigen::MatrixXd& Z, Eigen::MatrixXd& B) const override;
  void add_curvature(const model::Frame& frame, const Eigen::VectorXd& f, const Eigen::VectorXd& lambda,
                     Eigen::MatrixXd& A) const override;
  std::unique_ptr<model::ProjectedSolver> make_solver(const math::BlockPattern& pattern,
                                                      const std::string& kind) const override;
  bool loops_cross(const model::Frame& from, const model::Frame& to) const override;
  model::Turn largest_turn(const Eigen::VectorXd& q_from, const Eigen::VectorXd& q_to) const override;

  const KinematicTree& tree() const { return tree_; }
  int n_plain() const { return n_plain_; }
  /// Rows of the loop-closing joints, and which joint each belongs to.
  const std::vector<model::Bilinear>& loop_rows() const override { return rows_; }
  const std::vector<int>& loop_row_joint() const { return row_joint_; }
  /// Rows of all constraints of directors and tree joints, for tests and for `violation`.
  const std::vector<model::Bilinear>& tree_rows() const { return tree_rows_; }

 private:
  int rank_in_scene_pose() const;
  void decompose_loop_rows(TreeFrame& frame) const;

  KinematicTree tree_;
  int n_plain_ = 0;
  double length_ = 1.0;
  Eigen::VectorXd reference_;
  Eigen::VectorXd scale_;  // rate_scale(), with loops only
  std::vector<model::Bilinear> rows_;
  std::vector<int> row_joint_;
  int n_c_ = 0;
  std::vector<model::Bilinear> tree_rows_;
};

}  // namespace muldi::multibody
