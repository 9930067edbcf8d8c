#pragma once
/// The chart of a TreeManifold: joint coordinates, rotation vectors of balls, plain unknowns.
#include <memory>
#include <vector>

#include "model/chart.hpp"
#include "multibody/chart_kinematics.hpp"

namespace muldi::multibody {

class TreeManifold;

class TreeChart final : public model::Chart {
 public:
  /// The manifold must outlive the chart; the reference is its scene pose.
  explicit TreeChart(const TreeManifold& manifold);

  void set_reference(const Eigen::VectorXd& x) override;
  void coordinates(const Eigen::VectorXd& x, Eigen::VectorXd& theta) const override;
  void stored(const Eigen::VectorXd& theta, Eigen::VectorXd& x) const override;
  bool is_coordinate(int k) const override { return is_coordinate_[static_cast<std::size_t>(k)]; }
  const std::vector<int>& columns_of(int dof) const override;
  void evaluate(const Eigen::VectorXd& theta, model::ChartPoint& out) override;
  void evaluate_along(const Eigen::VectorXd& theta, const Eigen::VectorXd& mu, model::ChartPoint& out) override;
  void add_curvature(const Eigen::VectorXd& y, Eigen::Ref<Eigen::MatrixXd> H) override;
  void add_curvature_along(const Eigen::VectorXd& y, const Eigen::VectorXd& b, Eigen::Ref<Eigen::MatrixXd> H) override;

 private:
  using Along = math::Dual<double>;

  void list_motions();
  template <class S>
  void resize(ChartKinematics<S>& at) const;
  /// Positions, axes and pivots for coordinates that `value(k)` gives.
  template <class S, class Value>
  void place(const Value& value, ChartKinematics<S>& at) const;
  template <class S, class Value>
  void place_group(const MotionGroup& group, const Value& value, Matrix3s<S>& E, ChartKinematics<S>& at) const;
  void prepare(model::ChartPoint& out) const;
  /// Sums the weights over the subtrees; `weight(dof)` is that of an unknown.
  template <class S, class Weight>
  void accumulate(const ChartKinematics<S>& at, const Weight& weight, SubtreeWeights<S>& sums) const;
  /// H += d2/dtheta2 (weights . q), of which `number` takes the wanted part.
  template <class S, class Number>
  void add_second(const ChartKinematics<S>& at, const SubtreeWeights<S>& sums, const Number& number,
                  Eigen::Ref<Eigen::MatrixXd> H) const;

  const TreeManifold& manifold_;
  const KinematicTree& tree_;
  std::vector<MotionGroup> groups_;
  std::vector<std::vector<int>> groups_of_link_;  // in order from the root outwards
  std::vector<std::vector<int>> path_of_link_;    // all groups from the root to the link's last
  std::vector<std::vector<int>> columns_of_link_;
  std::vector<std::vector<int>> columns_of_plain_;
  std::vector<int> link_of_body_;
  std::vector<bool> is_coordinate_;
  Eigen::VectorXd reference_;                    // x: balls at their reference, the rest 0
  std::vector<Eigen::Matrix3d> ball_reference_;  // of every group
  ChartKinematics<double> here_;
  ChartKinematics<Along> along_;
  SubtreeWeights<double> weights_;
  SubtreeWeights<Along> weights_along_;
};

}  // namespace muldi::multibody
