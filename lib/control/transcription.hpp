#pragma once
/// An optimal control problem as a nonlinear program (numerics, 1.11), in scaled unknowns and rows.
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "control/end_motion.hpp"
#include "control/end_rows.hpp"
#include "control/limit_rows.hpp"
#include "control/nlp.hpp"
#include "control/objective_sum.hpp"
#include "control/solve.hpp"
#include "control/sparse_entries.hpp"
#include "control/turn_rows.hpp"

namespace muldi::control {

class Transcription final : public Nlp {
 public:
  /// The problem must outlive this; `guess` has the horizon's number of steps and fixes references and bases.
  Transcription(const Problem& problem, std::span<const WeightedObjective> objectives, const Trajectory& guess);

  /// What rules a solution out; the functions may only be called where this is empty.
  const std::vector<Fault>& faults() const { return faults_; }
  const Layout& layout() const { return layout_; }

  int n_variables() const override { return layout_.n; }
  int n_constraints() const override { return n_rows_; }
  const NlpBounds& bounds() const override { return bounds_; }
  const SparsePattern& jacobian_pattern() const override { return jacobian_entries_.pattern(); }
  const SparsePattern& hessian_pattern() const override { return hessian_entries_.pattern(); }
  bool move_to(const Eigen::VectorXd& x) override;
  double objective() override;
  void gradient(Eigen::VectorXd& out) override;
  void constraints(Eigen::VectorXd& out) override;
  void jacobian(double* values) override;
  void hessian(double factor, const Eigen::VectorXd& mu, double* values) override;

  /// The scaled unknowns of a trajectory, within the bounds.
  Eigen::VectorXd unknowns_of(const Trajectory& trajectory) const;
  Trajectory trajectory_of(const Eigen::VectorXd& x) const;
  /// The objective in the user's scale from the solver's.
  double objective_factor() const { return objective_factor_; }

  /// What a row and a variable are, and when.
  struct Place {
    std::string name;
    int node = 0;
  };
  Place row_place(int row) const;
  Place variable_place(int variable) const;

 private:
  /// Impulse of a loop multiplier at a node: the ends have half a step.
  double impulse_weight(int node, double step) const;
  void count_rows();
  void find_sizes(const Trajectory& guess);
  void make_ends(const Trajectory& guess);
  void place_unknowns();
  void set_bounds(const Trajectory& guess);
  void bound_theta(int node, const std::vector<std::optional<double>>& fixed);
  void set_scales();
  void scale_objective(const Trajectory& guess);
  void find_patterns();
  void set_end_momenta();
  void check_counts();

  void write_jacobian();
  void write_node_rows(int n);
  void write_end_rows(int end);
  void write_limit_rows();
  void write_turn_rows();
  void write_hessian();
  void write_extra_hessian();
  void write_hessian_blocks();

  const Problem& problem_;
  ObjectiveSum objectives_;
  Layout layout_;
  NaturalSizes sizes_;
  std::unique_ptr<DiscreteDynamics> dynamics_;
  std::array<std::unique_ptr<EndRows>, 2> ends_;
  std::array<std::unique_ptr<EndMotionRows>, 2> motions_;
  std::array<Eigen::VectorXd, 2> end_momenta_;  ///< constants (n_v), where the motion has no unknowns
  std::unique_ptr<LimitRows> limits_;
  std::unique_ptr<TurnRows> turns_;
  std::vector<Fault> faults_;

  int n_rows_ = 0;
  std::vector<int> balance_row_;  // of every node, -1 without
  std::vector<int> closing_row_;
  std::array<int, 2> end_row_{};
  std::array<int, 2> motion_row_{-1, -1};
  int limit_row_ = 0;
  int turn_row_ = 0;
  int peak_row_ = 0;

  NlpBounds bounds_;
  Eigen::VectorXd scale_x_;
  Eigen::VectorXd scale_c_;
  double objective_factor_ = 1.0;  // the solver's objective is this times the user's
  std::vector<std::pair<int, int>> theta_pairs_;
  std::vector<std::pair<int, int>> control_pairs_;  // (theta, choice)
  SparseEntries jacobian_entries_{false};
  SparseEntries hessian_entries_{true};

  Eigen::VectorXd unknowns_;
  DynamicsJacobian jacobian_;
  DynamicsHessian hessian_;
  Vectors m_;
  Vectors nu_;
  std::array<Eigen::MatrixXd, 2> end_jacobian_;
  std::array<Eigen::MatrixXd, 2> end_by_lambda_;
  std::set<std::pair<int, int>> plain_pairs_;  // choices of which one piece has both
  const Eigen::VectorXd* motion_weights_ = nullptr;
  double change_factor_ = 0.0;
  Eigen::MatrixXd equilibrium_lambda_;  // (n_c, n_v) Hessian by the multipliers of the equilibrium
};

}  // namespace muldi::control
