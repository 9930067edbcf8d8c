#pragma once
/// Rigid bodies in directors: constant mass matrix and gravity (numerics, 1.6).
#include <Eigen/Core>
#include <string>
#include <vector>

#include "model/interval_term.hpp"

namespace muldi::multibody {

/// Mass and inertia tensor about the centre of mass in body axes (any axes, not only principal ones).
struct RigidBody {
  std::string name;
  double mass = 0.0;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();

  /// Euler tensor E = tr(J)/2 1 - J: T = m/2 |phi'|^2 + 1/2 sum E_ij d_i'.d_j'.
  Eigen::Matrix3d euler_tensor() const { return 0.5 * inertia.trace() * Eigen::Matrix3d::Identity() - inertia; }
};

/// Kinetic energy of all bodies; body i has the unknowns of node i.
class RigidBodies final : public model::IntervalTerm {
 public:
  RigidBodies(std::vector<RigidBody> bodies, const Eigen::Vector3d& gravity);

  void request(model::PatternRequest&) const override {}
  void bind(const math::BlockPattern& pattern) override;
  void add_forces(const model::IntervalPoint& at, model::IntervalForces& out) const override;
  void add_tangent(const model::IntervalPoint& at, const model::TangentWeights& weights,
                   math::BlockMatrix& K) const override;
  void add_control_force(const model::IntervalPoint&, int, Eigen::VectorXd&) const override {}
  void add_constant_mass(std::vector<model::MassEntry>& mass) const override;
  bool expand(const model::IntervalPoint&, const model::ExpansionRequest&, model::ExpansionSink&) const override {
    return true;  // all of it is constant mass and constant weight
  }
  model::IntervalWork work(const model::IntervalPoint&) const override { return {}; }
  std::vector<std::string> parts() const override;
  void energies(const model::NodePoint& at, std::span<model::Energy> out) const override;

  const std::vector<RigidBody>& bodies() const { return bodies_; }

 private:
  std::vector<RigidBody> bodies_;
  std::vector<Eigen::Matrix3d> euler_;
  std::vector<math::BlockSlot> slots_;
  Eigen::Vector3d gravity_;
};

}  // namespace muldi::multibody
