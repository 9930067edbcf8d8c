#pragma once
/// Forces and torques on bodies, fixed in the world or carried by the body.
#include <string>
#include <vector>

#include "model/interval_term.hpp"
#include "multibody/joint.hpp"

namespace muldi::multibody {

/// A force at a point, or a torque, of the given direction times (control or constant).
struct Load {
  enum class Kind { force, torque };
  enum class Frame { world, body };

  std::string name;
  Kind kind = Kind::force;
  Frame frame = Frame::world;
  int body = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();      ///< body axes; forces only
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  ///< world or body axes
  int control = -1;
  double constant = 1.0;  ///< the factor where there is no control
  double control_factor = 1.0;

  double magnitude(std::span<const double> u) const {
    return control < 0 ? constant : control_factor * u[static_cast<std::size_t>(control)];
  }
};

class Loads final : public model::IntervalTerm {
 public:
  explicit Loads(std::vector<Load> loads) : loads_(std::move(loads)) {}

  void request(model::PatternRequest&) const override {}
  void bind(const math::BlockPattern& pattern) override;
  void add_forces(const model::IntervalPoint& at, model::IntervalForces& out) const override;
  void add_tangent(const model::IntervalPoint& at, const model::TangentWeights& weights,
                   math::BlockMatrix& K) const override;
  void add_control_force(const model::IntervalPoint& at, int control, Eigen::VectorXd& out) const override;
  bool expand(const model::IntervalPoint& at, const model::ExpansionRequest& request,
              model::ExpansionSink& sink) const override;
  model::IntervalWork work(const model::IntervalPoint& at) const override;
  std::vector<std::string> parts() const override { return {}; }
  void energies(const model::NodePoint&, std::span<model::Energy>) const override {}

 private:
  using LocalForce = Eigen::Matrix<double, 12, 1>;
  using LocalMatrix = Eigen::Matrix<double, 12, 12>;
  static LocalForce unit_force(const Load& load, const Eigen::VectorXd& q);
  /// d(unit force)/dq of the body; constant but for torques carried by the body.
  static LocalMatrix unit_slope(const Load& load, const Eigen::VectorXd& q);

  std::vector<Load> loads_;
  std::vector<math::BlockSlot> slots_;
};

}  // namespace muldi::multibody
