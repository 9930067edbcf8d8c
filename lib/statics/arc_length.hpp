#pragma once
/// Pseudo-arc-length (Keller): a curve of equilibria past limit points, by steps along its tangent.
///
/// The arc is measured in natural sizes: of the minimal rates, of the positions of substructures (mean over their
/// nodes) and of the load (the swept range). The bordered system is solved by block elimination with the factors of the
/// equilibrium at fixed load: with K z = R and K z_L = dR/dload the step is z + dload z_L. That loses digits only where
/// K itself is singular to working precision, and Newton's iteration on the exact residual returns them.
#include <span>
#include <vector>

#include "statics/equilibrium.hpp"

namespace muldi::statics {

/// A point of the curve, with the unit tangent there.
struct CurvePoint {
  StaticState state = {};
  double load = 0.0;
  StaticMotion tangent = {};
  double load_tangent = 0.0;  ///< of load over range
  EquilibriumReport report = {};
};

/// Where the stability of a curve changes.
struct CriticalPoint {
  enum class Kind {
    limit,  ///< the load turns
    branch  ///< it does not: another branch crosses
  };
  Kind kind = Kind::limit;
  double load = 0.0;
};

class ArcLength {
 public:
  /// Controls along the curve: u = u_fixed + load * direction. `range` is the natural size of the load. All that is
  /// passed by reference must outlive the object.
  ArcLength(EquilibriumSolver& solver, const std::vector<double>& u_fixed, const std::vector<double>& direction,
            double range, const EquilibriumOptions& options);

  /// The equilibrium `state` as the first point, its tangent on the side of rising load/range.
  CurvePoint start(const StaticState& state, double load);
  /// The point of the curve whose distance along the tangent of `from` is `arc`; false with a report if there is none
  /// nearby or the curve turns too much on the way.
  bool advance(const CurvePoint& from, double arc, CurvePoint& to);
  /// Moves a point of the curve to a load nearby, at which the curve does not turn.
  bool move_to(double load, CurvePoint& point);
  /// The critical point between two successive points; `arc` the step from a to b. Nothing if there is none.
  bool locate(const CurvePoint& a, const CurvePoint& b, double arc, CriticalPoint& found);

 private:
  /// The hyperplane that a corrector stays in: distance `arc` from `from` along a motion and a change of load.
  struct Plane {
    const CurvePoint& from;
    const StaticMotion& along;
    double along_load;
    double arc;
  };
  void linearise(const CurvePoint& at);
  bool correct(const Plane& plane, CurvePoint& at);
  void find_tangent(double side_of_load, const CurvePoint* previous, CurvePoint& at);
  bool locate_limit(const CurvePoint& a, const CurvePoint& b, double arc, CriticalPoint& found);
  bool locate_branch(const CurvePoint& a, double arc, CriticalPoint& found);

  EquilibriumSolver& solver_;
  const std::vector<double>& u_fixed_;
  const std::vector<double>& direction_;
  double range_;
  EquilibriumOptions options_;
  std::vector<double> u_;
  StaticMotion newton_;
  StaticMotion response_;
};

}  // namespace muldi::statics
