#pragma once
/// The weighted sum of objectives as the terms that the transcription knows.
#include <vector>

#include "control/cut_coordinate.hpp"
#include "control/discrete_dynamics.hpp"

namespace muldi::control {

/// factor (theta_rate - wanted)^2 at one node, or of the coordinate of a cut joint.
struct SquaredCoordinate {
  int rate = 0;
  CutJoint cut = {};
  double wanted = 0.0;
  double factor = 1.0;
};

/// factor (component of a point - wanted)^2 at one node.
struct SquaredPoint {
  model::LinearPoint point = {};
  int component = 0;
  double wanted = 0.0;
  double factor = 1.0;
};

/// Collects what objectives contribute; every call adds to the sum with the current weight.
class ObjectiveSum {
 public:
  ObjectiveSum(const Problem& problem, std::span<const WeightedObjective> objectives);

  int n_steps() const { return problem_.horizon.n_steps; }
  int n_controls() const { return static_cast<int>(problem_.controls.size()); }
  double step() const { return problem_.horizon.shortest_step; }

  /// factor sum_n u_c,n^2 of a choice.
  void add_squared_control(int choice, double factor);
  /// factor sum_n (w_c,n+1 - w_c,n)^2.
  void add_squared_change(int choice, double factor);
  /// factor N h.
  void add_duration(double factor) { duration_ += weight_ * factor; }
  void add_squared_coordinate(int node, const SquaredCoordinate& term);
  void add_squared_point(int node, const SquaredPoint& term);
  /// factor times the kinetic energy at the last node.
  void add_final_kinetic_energy(double factor) { kinetic_ += weight_ * factor; }
  /// max over intervals of factors[c] u_c^2; choices with 0 do not count.
  void add_peak(const std::vector<double>& factors);

  bool has_kinetic_energy() const { return kinetic_ != 0.0; }
  bool has_peak() const { return peak_weight_ != 0.0; }
  const std::vector<double>& peak_factors() const { return peak_factors_; }
  /// Finds what squared points and coordinates of cut joints depend on: sets of coordinates of a node that they couple.
  /// To be called before values and derivatives are asked for.
  std::vector<std::vector<int>> bind(const model::Chart& chart);
  /// Whether a term needs the duration to be fixed.
  bool follows_time() const;

  /// Value at unscaled unknowns.
  double value(const Eigen::VectorXd& unknowns, const Layout& layout, const DiscreteDynamics& dynamics) const;
  /// out (n) += factor gradient.
  void add_gradient(const Eigen::VectorXd& unknowns, const Layout& layout, const DiscreteDynamics& dynamics,
                    Eigen::VectorXd& out) const;
  /// Second derivatives at the nodes and of controls within an interval.
  void add_hessian(double factor, const Layout& layout, const DiscreteDynamics& dynamics, DynamicsHessian& out) const;
  /// Entry (w_n+1, w_n) of a choice, to which changes contribute -2 factor.
  double change_factor(int choice) const { return changes_[static_cast<std::size_t>(choice)]; }
  double kinetic_factor() const { return kinetic_; }

 private:
  const Problem& problem_;
  double weight_ = 1.0;
  std::vector<double> squares_;  // of every choice, of u^2
  std::vector<double> changes_;
  double duration_ = 0.0;
  double kinetic_ = 0.0;
  double peak_weight_ = 0.0;
  std::vector<double> peak_factors_;
  std::vector<std::vector<SquaredCoordinate>> coordinates_;  // of every node
  std::vector<std::vector<SquaredPoint>> points_;

  struct SquaredCut {
    CutCoordinate coordinate;
    double wanted = 0.0;
    double factor = 1.0;
  };
  std::vector<std::vector<SquaredCut>> cuts_;  // those of coordinates_, bound to the chart
};

}  // namespace muldi::control
