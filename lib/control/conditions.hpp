#pragma once
/// Conditions on the state at one node and along the path, resolved to unknowns of the model.
///
/// Joint coordinates are addressed by their place in the minimal velocities (`rate`); those of joints that close loops,
/// which are no unknowns, by what computes them (`cut`). Balls are asked for by orientations and points.
#include <Eigen/Core>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/end_coordinate.hpp"
#include "model/linear_point.hpp"

namespace muldi::control {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// Computes the coordinate of a joint that closes a loop; null for joints of the tree.
using CutJoint = std::shared_ptr<const model::EndCoordinate>;

/// The coordinate `rate` or `cut` has this value (rad or length).
struct CoordinateTarget {
  std::string name;  ///< as users read it, e.g. "joints.hinge"
  int rate = 0;
  CutJoint cut = {};
  double value = 0.0;
};

/// The components of a point that are given have these values.
struct PointTarget {
  std::string name;
  model::LinearPoint point;
  std::array<std::optional<double>, 3> value{};
};

/// Three directors have these world components (columns).
struct OrientationTarget {
  std::string name;
  std::array<model::LinearPoint, 3> directors;
  Eigen::Matrix3d value = Eigen::Matrix3d::Identity();
};

/// What is asked of the momentum at an end of the horizon.
struct MomentumCondition {
  enum class Kind {
    rest,     ///< T^T p = 0
    free,     ///< nothing
    momenta,  ///< T^T p = values, on the loops their projection
    rates,    ///< T^T p = T^T M T values
  };
  Kind kind = Kind::rest;
  Eigen::VectorXd values = {};  ///< (n_v), with momenta and rates
};

/// What holds at an end of the horizon; all of it together.
struct EndCondition {
  std::optional<Eigen::VectorXd> x = {};  ///< the whole pose as coordinates of the manifold (n_x)
  std::vector<CoordinateTarget> coordinates = {};
  std::vector<PointTarget> points = {};
  std::vector<OrientationTarget> orientations = {};
  MomentumCondition momentum = {};
  /// The pose is a static equilibrium under these values of all controls of the model, in their own units.
  std::optional<std::vector<double>> equilibrium = {};
};

struct CoordinateLimit {
  std::string name;
  int rate = 0;
  CutJoint cut = {};
  double lower = -infinity;
  double upper = infinity;
};

/// A box for a point, infinite where there is no bound.
struct PointLimit {
  std::string name;
  model::LinearPoint point;
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(-infinity);
  Eigen::Vector3d upper = Eigen::Vector3d::Constant(infinity);
};

/// What holds at every node but the first, whose pose is the initial condition; fields and margins at both ends of
/// every interval, under its controls.
struct PathLimits {
  std::vector<CoordinateLimit> coordinates = {};
  std::vector<PointLimit> points = {};
  std::optional<double> true_field = {};      ///< largest E/Lambda
  std::optional<double> pull_in_margin = {};  ///< smallest Pi''(Lambda, E)/Pi''(1, 0)
  /// Largest change of an angle, and largest turn of a body behind a ball, from node to node (rad). Midpoint momenta of
  /// a body that turns by a are J sin(a)/dt: half turns cost nothing, and an optimum may hold them where this is
  /// infinite.
  double longest_turn = infinity;
};

}  // namespace muldi::control
