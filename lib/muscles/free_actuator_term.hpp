#pragma once
/// Isolated actuators as one interval term: the length is the only unknown, no translation, no weight (thesis 7.2).
#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "model/interval_term.hpp"
#include "muscles/lumped_dea.hpp"
#include "muscles/two_point_term.hpp"

namespace muldi::muscles {

/// One actuator on its own node of size 1; T = m zd^2/48 (k V z^-3 + 2), thesis (7.47) and (7.60).
struct FreeActuator {
  std::string name;
  LumpedDea element;   ///< used with Inertia::thesis: with the centre at rest both inertias are the same
  int node = 0;        ///< of the block pattern
  int dof = 0;         ///< entry of q that holds the length z
  ControlInput field;  ///< nominal field
};

class FreeActuatorTerm final : public model::IntervalTerm {
 public:
  explicit FreeActuatorTerm(std::vector<FreeActuator> actuators);

  const std::vector<FreeActuator>& actuators() const { return actuators_; }

  void request(model::PatternRequest& pattern) const override;
  void bind(const math::BlockPattern& pattern) override;
  void add_forces(const model::IntervalPoint& at, model::IntervalForces& out) const override;
  void add_tangent(const model::IntervalPoint& at, const model::TangentWeights& weights,
                   math::BlockMatrix& K) const override;
  void add_control_force(const model::IntervalPoint& at, int control, Eigen::VectorXd& out) const override;
  model::IntervalWork work(const model::IntervalPoint& at) const override;
  std::vector<std::string> parts() const override;
  void energies(const model::NodePoint& at, std::span<model::Energy> out) const override;
  std::string inadmissible(const Eigen::VectorXd& q) const override;

 private:
  std::vector<FreeActuator> actuators_;
  std::vector<math::BlockSlot> slots_;
};

}  // namespace muldi::muscles
