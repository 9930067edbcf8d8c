#pragma once
/// Second-order expansions of interval terms for optimal control: their small pieces with exact derivatives.
///
/// The constraints of a discrete optimal control problem are the equations of motion, so that their Jacobian holds the
/// second derivatives of the Lagrangian and the Hessian of mu . c its third ones, contracted with two vectors
/// (numerics, 1.11): of Psi = a . F + b . pi with F = dL/dq + f, pi = dL/dv and frozen a, b. A term is a sum of pieces
/// that each depend on a few linear forms xi of q: a muscle on the vector between its ends. The pieces are handed over
/// one by one.
#include <Eigen/Core>
#include <array>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "model/end_coordinate.hpp"
#include "model/linear_point.hpp"

namespace muldi::model {

/// The forms that a piece depends on, linear but for the last; one of the four is given.
struct LocalForms {
  std::span<const LinearPoint> points = {};  ///< three forms each
  std::span<const int> entries = {};         ///< unknowns of q
  int rate = -1;                             ///< a coordinate theta of the manifold; F acts on its rate
  /// Of a loop-closing joint; F acts on its rate, with the gradients at either end. It outlives the sink.
  const EndCoordinate* coordinate = nullptr;

  int size() const {
    return rate >= 0 || coordinate != nullptr ? 1 : static_cast<int>(3 * points.size() + entries.size());
  }
};

/// Derivatives of one piece by y = (xi, xi', s): m forms, their rates, c controls.
struct LocalExpansion {
  std::span<const int> controls;        ///< of the model (c)
  const Eigen::MatrixXd& tangent;       ///< d(F, pi)/dy (2 m, 2 m + c)
  const Eigen::MatrixXd* hessian = {};  ///< d2 Psi/dy2 (2 m + c, 2 m + c); null where not asked for
  double force = 0.0;                   ///< F itself, of EndCoordinates
};

/// Takes the pieces; their order and their forms are the same in every call.
class ExpansionSink {
 public:
  virtual ~ExpansionSink() = default;
  virtual void add(const LocalForms& forms, const LocalExpansion& piece) = 0;
};

/// What is asked of an expansion.
struct ExpansionRequest {
  /// Of every control of the model: 0 to differentiate by u, else by u^2, in which F must be affine; a value at which
  /// the part that depends on it stands out.
  std::span<const double> squared;
  const Eigen::VectorXd* a = nullptr;  ///< (n_q) on F; null: no Hessian
  const Eigen::VectorXd* b = nullptr;  ///< (n_q) on pi
};

/// A part m/2 (x' . y') of the kinetic energy that does not depend on the state.
struct MassEntry {
  LinearPoint x;
  LinearPoint y;
  double mass = 0.0;
};

/// A muscle whose field and axial stiffness can be limited, with its length as a function of q.
struct LimitedMuscle {
  std::string name = {};               ///< as parts() of its term
  std::vector<LinearPoint> ends = {};  ///< two, or none where the length is an unknown of q
  int entry = -1;                      ///< that unknown
  int control = -1;                    ///< of the model; -1: `constant_field`
  double control_factor = 1.0;         ///< from the control's unit to the field
  double constant_field = 0.0;
  double rest_length = 0.0;

  /// Pi''(Lambda, E)/Pi''(1, 0) = elastic(z) + E^2 electric(z), each with its first two derivatives.
  struct Stiffness {
    std::array<double, 3> elastic{};
    std::array<double, 3> electric{};
  };
  std::function<Stiffness(double z)> stiffness = {};
};

}  // namespace muldi::model
