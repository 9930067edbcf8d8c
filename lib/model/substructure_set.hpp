#pragma once
/// The substructures of a model in the Newton iteration: their solvers, called together.
#include <memory>
#include <string>
#include <vector>

#include "model/model.hpp"

namespace muldi::model {

/// Does nothing, at no cost, where the model has no substructures.
class SubstructureSet {
 public:
  /// The model must outlive the set; `name` as the substructures' make_solver takes it.
  SubstructureSet(const Model& model, Linearisation kind, const std::string& name);

  bool empty() const { return solvers_.empty(); }
  /// True if positions are prescribed by controls.
  bool moves() const;
  /// Writes what is not free.
  void place(const Placement& at, Eigen::VectorXd& q, Eigen::VectorXd& y) const;
  void settle_stage(const IntervalPoint& at, Eigen::VectorXd& y) const;
  void keep_free(Eigen::VectorXd& rows) const;
  void gather(Eigen::VectorXd& rows) const;
  /// Largest entries of an increment over all parts; 0 without parts.
  IncrementSize size_of(const Eigen::VectorXd& dq, const Eigen::VectorXd& dy) const;
  /// See Substructure::deformation: the largest of all parts.
  double deformation(const Eigen::VectorXd& q, const Eigen::VectorXd& dq) const;
  /// See Substructure::carry.
  void carry(const Eigen::VectorXd& before, const Eigen::VectorXd& motion, Eigen::VectorXd& q) const;
  /// Mean product of the positions' increments over all parts, each in its natural length; 0 without parts.
  double product(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;
  /// See Substructure::add_load_rate.
  void add_load_rate(const IntervalPoint& at, std::span<const double> du, Eigen::VectorXd& rows,
                     Eigen::VectorXd& h) const;
  /// Largest entry of the rows of the substructures' slices.
  double largest_row(const Eigen::VectorXd& rows) const;

  /// False if a matrix is singular.
  bool factorise(const IntervalPoint& at);
  /// Exact derivatives for the next elimination, see SubstructureSolver::linearise.
  void linearise(const IntervalPoint& at, double accuracy);
  bool factorised() const { return factorised_; }
  /// See SubstructureSolver::turn.
  void turn(const Eigen::VectorXd& q);
  /// Eliminates the parts: their stiffness goes to K, their response to the rows of the bodies in `bracket`.
  void eliminate(Eigen::VectorXd& bracket, const Eigen::VectorXd& h, math::BlockMatrix& K);
  /// The same but for the stiffness, with other right sides.
  void respond(Eigen::VectorXd& bracket, const Eigen::VectorXd& h);
  /// Completes dq and dy for the motion of the bodies in dq.
  void complete(Eigen::VectorXd& dq, Eigen::VectorXd& dy);
  int unstable_directions() const;
  /// Copies the substructures' slices of q.
  void copy_slices(const Eigen::VectorXd& from, Eigen::VectorXd& to) const;
  /// to += factor from on the substructures' slices of q.
  void add_slices(double factor, const Eigen::VectorXd& from, Eigen::VectorXd& to) const;

 private:
  const Model& model_;
  std::vector<std::unique_ptr<SubstructureSolver>> solvers_;
  std::vector<char> done_;
  bool factorised_ = false;
};

}  // namespace muldi::model
