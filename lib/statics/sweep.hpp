#pragma once
/// Load curves: equilibria along u(s) = u_0 + s du, by load stepping or by arc length past limit points.
#include <functional>
#include <string>
#include <vector>

#include "statics/arc_length.hpp"

namespace muldi::statics {

enum class Continuation { natural, arc_length };

struct SweepOptions {
  double from = 0.0;
  double to = 1.0;
  int steps = 10;
  Continuation continuation = Continuation::natural;
  EquilibriumOptions equilibrium = {};
};

/// One equilibrium of a curve.
struct SweepPoint {
  double load = 0.0;
  const StaticState& state;
  const Eigen::VectorXd& q;
  const Eigen::VectorXd& y;
  const Eigen::VectorXd& force;  ///< F (n_q): minus the constraint forces
  std::span<const double> u;
  const EquilibriumReport& report;
};

/// Where load stepping left its branch: the last load on it, and the first on the other.
struct BranchChange {
  double before = 0.0;
  double after = 0.0;
  bool jumps = false;  ///< to a state far away (snap-through); otherwise another branch begins there
};

struct SweepResult {
  enum class End { completed, loss_of_equilibrium, no_convergence, free_motion, interrupted };
  End end = End::completed;
  std::string sentence;
  double last_good = 0.0;  ///< largest load with a stable equilibrium (natural), bracketing the critical one
  double first_bad = 0.0;  ///< with last_good: where the equilibrium is lost
  std::vector<CriticalPoint> critical = {};  ///< on the way of the arc length
  std::vector<BranchChange> changes = {};    ///< on the way of load stepping
};

/// A step of load stepping that was tried.
struct FollowedStep {
  bool accepted = false;
  bool leaves_branch = false;  ///< accepted, for it is as short as steps get
  bool jumps = false;
};

struct SweepCallbacks {
  std::function<void(const SweepPoint&)> record;
  std::function<bool()> interrupted = {};
};

class Sweep {
 public:
  /// Controls along the curve: u = u_fixed + load * direction.
  Sweep(const model::Model& model, std::vector<double> u_fixed, std::vector<double> direction, SweepOptions options);

  /// Leaves `state` at the last recorded equilibrium.
  SweepResult run(StaticState& state, const SweepCallbacks& callbacks);

 private:
  SweepResult natural(StaticState& state, const SweepCallbacks& callbacks);
  /// Moves an equilibrium at `load` to one at `next` on the same branch. Not accepted if there is none, it is not
  /// stable, or it is too far from the predicted one to be of this branch; the last counts only while steps can still
  /// be halved.
  FollowedStep follow(double load, double next, StaticState& state, EquilibriumReport& report);
  SweepResult arc_length(StaticState& state, const SweepCallbacks& callbacks);
  EquilibriumReport solve_at(double load, StaticState& state);
  bool first_equilibrium(StaticState& state, EquilibriumReport& report, SweepResult& result);
  void controls_at(double load);
  void record(const SweepCallbacks& callbacks, double load, const StaticState& state, const EquilibriumReport& report);
  /// Length of the motion of the minimal rates per unit of load, in natural sizes, at the linearised state.
  double response_length();

  const model::Model& model_;
  std::vector<double> u_fixed_;
  std::vector<double> direction_;
  SweepOptions options_;
  EquilibriumSolver solver_;
  std::vector<double> u_;
};

}  // namespace muldi::statics
