#pragma once
/// Solids that are led by the bodies to which they are tied: to initial poses and velocities that a scene gives for the
/// bodies only.
#include <Eigen/Core>
#include <memory>
#include <vector>

#include "build/built_model.hpp"
#include "model/substructure_set.hpp"
#include "statics/equilibrium.hpp"

namespace muldi::pipeline {

class LedSolids {
 public:
  /// `tolerance`: of the dimensionless increments. The model must outlive the object.
  LedSolids(const build::BuiltModel& built, double tolerance);

  /// True if a solid is tied to a body.
  bool any() const { return any_; }

  /// Moves the bodies from their pose in `state` to the coordinates x, in small steps in which every solid comes to
  /// rest with the bodies held and all controls zero. False if a solid finds no rest on the way; `state` is then where
  /// it was.
  bool lead_to(const Eigen::VectorXd& x, statics::StaticState& state);

  /// Completes the velocities v (n_q) of the bodies by those of the tied solids in a motion so slow that they are at
  /// rest all along.
  void add_velocities(const statics::StaticState& state, Eigen::VectorXd& v);

 private:
  bool settle(statics::StaticState& state);
  bool linearise(const statics::StaticState& state);
  /// The solids' answer to the motion of the bodies in dq_, at the last linearisation.
  void answer();
  void add_answer(statics::StaticState& state) const;

  const model::Model& model_;
  const multibody::TreeManifold& manifold_;
  std::vector<double> u_;  // zero
  double tolerance_;
  bool any_ = false;
  std::unique_ptr<model::SubstructureSet> parts_;
  math::BlockMatrix K_;
  model::IntervalForces forces_;
  Eigen::VectorXd zero_q_;
  Eigen::VectorXd dq_;
  Eigen::VectorXd dy_;
};

}  // namespace muldi::pipeline
