#pragma once
/// Springs, dampers, drives and stops on scalar joint coordinates.
///
/// Joints of the tree have their coordinates theta among those of the manifold, and the potential is discretised there:
///     L_d = -dt V(theta_mid),  theta_mid = (theta_n + theta_{n+1})/2,  theta' = (theta_{n+1} - theta_n)/dt.
/// Either end of the interval gets dt/2 Q grad theta, which T^T takes to dt/2 Q on the joint's rate: the tangent is a
/// diagonal. As theta does not see rigid motions, the momentum maps are kept.
#include <Eigen/Core>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "model/interval_term.hpp"

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
  /// The coordinate in the middle of an interval and its mean rate, 0 at rest.
  struct Motion {
    double position = 0.0;
    double rate = 0.0;
  };
  Response respond(const Motion& middle, std::span<const double> u) const;
  /// [dQ/dtheta, dQ/dtheta', dQ/du] of the response.
  Eigen::RowVector3d derivatives(const Response& response) const;
  /// What damping and drive do in an interval of length dt.
  void add_work(const Motion& middle, std::span<const double> u, double dt, model::IntervalWork& work) const;
  double potential(double position) const;
};

/// Names of the components that forces belong to, each once.
struct ForceParts {
  std::vector<std::string> names;
  std::vector<std::size_t> of;  ///< for every force

  void add(const JointForce& force);
};

/// A force on a joint of the tree: the coordinate's place in x, and in the minimal rates.
struct TreeJointForce {
  JointForce law;
  int coordinate = 0;
  int rate = 0;
};

class JointForces final : public model::IntervalTerm {
 public:
  explicit JointForces(std::vector<TreeJointForce> forces);

  void request(model::PatternRequest&) const override {}
  void bind(const math::BlockPattern&) override {}
  void add_forces(const model::IntervalPoint& at, model::IntervalForces& out) const override;
  void add_tangent(const model::IntervalPoint&, const model::TangentWeights&, math::BlockMatrix&) const override {}
  void add_control_force(const model::IntervalPoint&, int, Eigen::VectorXd&) const override {}
  void add_rate_tangent(const model::IntervalPoint& at, const model::TangentWeights& weights,
                        Eigen::VectorXd& diagonal) const override;
  void add_control_force_on_rates(const model::IntervalPoint& at, int control, Eigen::VectorXd& out) const override;
  /// Forces are linear in pieces: their second derivatives are zero.
  bool expand(const model::IntervalPoint& at, const model::ExpansionRequest& request,
              model::ExpansionSink& sink) const override;
  model::IntervalWork work(const model::IntervalPoint& at) const override;
  std::vector<std::string> parts() const override { return parts_.names; }
  void energies(const model::NodePoint& at, std::span<model::Energy> out) const override;

 private:
  std::vector<TreeJointForce> forces_;
  ForceParts parts_;
};

}  // namespace muldi::multibody
