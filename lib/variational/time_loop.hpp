#pragma once
/// Runs a model from a state over a number of steps and hands every node to an observer, with the energy ledger.
#include <functional>
#include <vector>

#include "model/observable.hpp"
#include "model/supply.hpp"
#include "variational/control_rates.hpp"
#include "variational/node_values.hpp"
#include "variational/stepper.hpp"

namespace muldi::variational {

/// Sums over the run, part of the state of a restart.
struct Ledger {
  double dissipated = 0.0;
  double external = 0.0;
  double source = 0.0;  ///< work of control jumps: electric enthalpy after minus before, summed over the nodes passed
  double initial_total = 0.0;       ///< energy at t = 0
  std::vector<double> supply = {};  ///< accounts of the electric sources (model/supply.hpp), where they are kept
};

/// Counts over the run.
struct LoopStatistics {
  long steps = 0;
  long iterations = 0;
  long factorisations = 0;
  double largest_residual = 0.0;
  double largest_rotation = 0.0;
};

/// A node that is complete: the reactions at it are known once the following step is solved.
struct NodeRecord {
  long step = 0;
  double t = 0.0;
  const State& state;
  const NodeValues& values;
  const Ledger& ledger;
  const Eigen::VectorXd& constraint_force;  ///< -G^T lambda (n_q)
  const Eigen::VectorXd& multipliers;       ///< (n_loop_rows)
  const Eigen::VectorXd& y_after;           ///< stage unknowns of the step that follows (n_y)
  std::span<const double> u;                ///< of the interval that ends here (of the first one at t = 0)
  const StepReport& report;                 ///< of the step that ends here
  bool last = false;                        ///< no step follows
};

/// What observables see of the node; its serial number is the step.
model::NodeView view_of(const NodeRecord& node);

enum class Integrator { midpoint, explicit_scheme };

struct LoopOptions {
  double dt = 0.0;
  long steps = 0;  ///< nodes 0 .. steps
  long record_every = 1;
  StepOptions step = {};
  Integrator integrator = Integrator::midpoint;
};

struct LoopCallbacks {
  std::function<void(const NodeRecord&)> record;  ///< every `record_every`-th node, the last, and on failure
  /// Before every step whose node is recorded, and at the end; may skip.
  std::function<void(const State&, const Ledger&, const StepReport&)> checkpoint = {};
  std::function<bool()> interrupted = {};
  std::function<void(const StepReport&, double t)> warn = {};  ///< rotation or loop near a limit; called once each
};

struct LoopResult {
  Status status = Status::completed;
  std::string sentence;
  double t = 0.0;
  LoopStatistics statistics;
  double t_of_breach = 0.0;  ///< with Status::breakdown: the node that was refused, the one after t or that at t = 0
};

class TimeLoop {
 public:
  /// Makes the solvers; InputError where they do not fit into this machine.
  TimeLoop(const model::Model& model, LoopOptions options);

  /// Goes on from `state` and `ledger`, with `last` the report of the step that ended there (default at t = 0), and
  /// leaves them at the last node that was reached. A node is recorded after the step that follows it, so a run that
  /// resumes from a checkpoint records the checkpoint's own node again.
  LoopResult run(State& state, Ledger& ledger, StepReport& last, const LoopCallbacks& callbacks);

 private:
  void controls_of(const State& state);
  struct Reactions {
    const Eigen::VectorXd& force;
    const Eigen::VectorXd& multipliers;
    const Eigen::VectorXd& stage;
    bool last = false;
  };
  void record(const LoopCallbacks& callbacks, const State& state, const Ledger& ledger, const StepReport& last,
              const Reactions& reactions);
  /// Work of the motions that are prescribed: half of an interval's by the force (n_q) at either of its nodes.
  double half_work(const Eigen::VectorXd& force, const State& state) const;
  void record_end(const LoopCallbacks& callbacks, const State& state, Ledger& ledger, const StepReport& last);
  /// Rates of the controls at the node, empty where nothing moves by them.
  std::span<const double> rates_at(const State& state, Side side);
  /// True, and said in the result, if a guard of the model does not let pass this node under the controls u.
  bool refuses(const State& state, const std::vector<double>& u, LoopResult& result);
  /// What guards and sources see of a node: positions and controls; velocities may be those of an earlier node.
  model::NodeView look(const State& state, const std::vector<double>& u);
  /// Opens the accounts of the sources at t = 0; leaves in supply_after_ those after the change of the controls here.
  void book_supply(const State& state, Ledger& ledger);

  const model::Model& model_;
  LoopOptions options_;
  std::unique_ptr<StepMethod> stepper_;
  NodeEvaluator nodes_;
  ControlRates control_rates_;
  model::SupplyBook supply_;
  long looks_;  // serials of its views, none of which is a record's
  std::vector<double> supply_after_;
  NodeValues values_;
  State before_;
  std::vector<double> u_before_;
  std::vector<double> u_;
  Eigen::VectorXd end_force_;
  Eigen::VectorXd end_multipliers_;
  Eigen::VectorXd end_stage_;
};

}  // namespace muldi::variational
