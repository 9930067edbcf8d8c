#pragma once
/// Springs, dampers, drives and stops on scalar joint coordinates.
#include <limits>
#include <string>
#include <vector>

#include "model/interval_term.hpp"
#include "multibody/joint_coordinate.hpp"

namespace muldi::multibody {

/// One-sided penalty outside [lower, upper]: force stiffness * penetration + damping * rate while outside.
struct Stops {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double stiffness = 0.0;
  double damping = 0.0;
};

/// Generalised force on one coordinate:
/// Q = -stiffness (theta - rest) - damping theta' - stops + drive, drive = control_factor u_control + constant.
struct JointForce {
  std::string part;  ///< "joints/<name>"; forces of one joint share it
  JointCoordinate coordinate;
  double stiffness = 0.0;
  double rest = 0.0;
  double damping = 0.0;
  Stops stops = {};
  int control = -1;
  double control_factor = 1.0;
  double constant = 0.0;

  struct Response {
    double force;          ///< Q
    double by_position;    ///< dQ/dtheta
    double by_rate;        ///< dQ/dtheta'
    double damping_force;  ///< the part that dissipates
    double drive;          ///< the part that does external work
  };
  Response respond(double position, double rate, std::span<const double> u) const;
  double potential(double position) const;
};

class JointForces final : public model::IntervalTerm {
 public:
  explicit JointForces(std::vector<JointForce> forces);

  void request(model::PatternRequest& pattern) const override;
  void bind(const math::BlockPattern& pattern) override;
  void add_forces(const model::IntervalPoint& at, model::IntervalForces& out) const override;
  void add_tangent(const model::IntervalPoint& at, const model::TangentWeights& weights,
                   math::BlockMatrix& K) const override;
  void add_control_force(const model::IntervalPoint& at, int control, Eigen::VectorXd& out) const override;
  model::IntervalWork work(const model::IntervalPoint& at) const override;
  std::vector<std::string> parts() const override { return parts_; }
  void energies(const model::NodePoint& at, std::span<model::Energy> out) const override;

 private:
  std::vector<JointForce> forces_;
  std::vector<std::size_t> part_of_;
  std::vector<std::string> parts_;
  std::vector<std::array<math::BlockSlot, 4>> slots_;  // node pairs of each force, row-major
};

}  // namespace muldi::multibody
