#pragma once
/// Springs, dampers, drives and stops on loop-closing joints, whose coordinates theta(q) are no unknowns.
///
/// The discretisation is that of the other joints, so that results do not depend on which joint of a loop is cut:
/// theta_mid = (theta(q_n) + theta(q_{n+1}))/2, theta' = (theta(q_{n+1}) - theta(q_n))/dt, and the forces dt/2 Q grad
/// theta(q_n), dt/2 Q grad theta(q_{n+1}) at the ends. At rest (dt = 0) the force is Q grad theta(q).
#include <array>

#include "multibody/joint_coordinate.hpp"
#include "multibody/joint_forces.hpp"

namespace muldi::multibody {

struct CutJointForce {
  JointForce law;
  JointCoordinate coordinate;
};

class CutJointForces final : public model::IntervalTerm {
 public:
  explicit CutJointForces(std::vector<CutJointForce> forces);

  void request(model::PatternRequest& pattern) const override;
  void bind(const math::BlockPattern& pattern) override;
  bool acts_at_ends() const override { return true; }
  void add_forces(const model::IntervalPoint& at, model::IntervalForces& out) const override;
  void add_tangent(const model::IntervalPoint& at, const model::TangentWeights& weights,
                   math::BlockMatrix& K) const override;
  void add_control_force(const model::IntervalPoint& at, int control, Eigen::VectorXd& out) const override;
  /// Forces are linear in pieces of their coordinates: all second derivatives are those of the coordinates.
  bool expand(const model::IntervalPoint& at, const model::ExpansionRequest& request,
              model::ExpansionSink& sink) const override;
  model::IntervalWork work(const model::IntervalPoint& at) const override;
  std::vector<std::string> parts() const override { return parts_.names; }
  void energies(const model::NodePoint& at, std::span<model::Energy> out) const override;

 private:
  /// K += A on the nodes of force f.
  void add_local(std::size_t f, const JointCoordinate::LocalMatrix& A, math::BlockMatrix& K) const;

  std::vector<CutJointForce> forces_;
  ForceParts parts_;
  std::vector<std::array<math::BlockSlot, 4>> slots_;  // node pairs of each force, row-major
};

}  // namespace muldi::multibody
