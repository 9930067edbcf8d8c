#pragma once
/// A chain of bodies on revolute joints with muscles across each joint, in joint angles: the equations of motion by
/// hand, as a rival's user would write them for speed. The axis of each joint is the z axis of the body beyond it.
#include <vector>

#include "bench/work_precision/minimal_system.hpp"

namespace muldi::bench {

struct ChainLink {
  Eigen::Matrix3d place = Eigen::Matrix3d::Identity();   ///< orientation at angle 0 relative to the link before
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();      ///< centre of mass from the joint, body axes
  Eigen::Vector3d next_joint = Eigen::Vector3d::Zero();  ///< from the joint, body axes
  double mass = 0.0;
  Eigen::Vector3d inertia = Eigen::Vector3d::Zero();  ///< principal, about the centre of mass
};

/// Between the link before a joint and the link beyond it; ends from the joint, in the axes of their links.
struct ChainMuscle {
  int joint = 0;
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  UniformMuscle law = {};
};

class JointChain final : public MinimalSystem {
 public:
  JointChain(std::vector<ChainLink> links, std::vector<ChainMuscle> muscles);

  Coordinates start() const override { return Coordinates::Zero(static_cast<Eigen::Index>(links_.size())); }
  void acceleration(const Coordinates& x, const Coordinates& v, Coordinates& a) const override;
  double kinetic(const Coordinates& x, const Coordinates& v) const override;
  double potential(const Coordinates& x) const override;

 private:
  /// Positions, velocities and accelerations for angles without second derivatives, world axes.
  struct Motion {
    Eigen::Matrix3d A;      ///< orientation
    Eigen::Vector3d pivot;  ///< place of the joint
    Eigen::Vector3d axis;
    Eigen::Vector3d omega;
    Eigen::Vector3d alpha;
    Eigen::Vector3d pivot_velocity;
    Eigen::Vector3d pivot_acceleration;
  };
  using Motions = std::array<Motion, most_coordinates>;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_coordinates, most_coordinates>;

  void move(const Coordinates& x, const Coordinates& v, Motions& at) const;
  /// Mass matrix and the forces at x'' = 0.
  void assemble(const Coordinates& x, const Coordinates& v, Matrix& M, Coordinates& h) const;
  void add_body(int i, const Motions& at, Matrix& M, Coordinates& h) const;
  void add_muscle(const ChainMuscle& muscle, const Motions& at, const Coordinates& v, Matrix& M, Coordinates& h) const;

  std::vector<ChainLink> links_;
  std::vector<ChainMuscle> muscles_;
};

}  // namespace muldi::bench
