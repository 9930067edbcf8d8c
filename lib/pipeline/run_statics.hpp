#pragma once
/// The `statics:` section of a scene: a curve of equilibria.
#include <optional>

#include "build/built_model.hpp"
#include "build/squeezed_cell.hpp"
#include "model/supply.hpp"
#include "pipeline/node_rows.hpp"
#include "pipeline/outcome.hpp"
#include "pipeline/run_context.hpp"
#include "statics/sweep.hpp"

namespace muldi::pipeline {

/// The controls along the curve of a scene, u = fixed + load direction, and how it is followed.
struct StaticLoads {
  std::vector<double> fixed;
  std::vector<double> direction;
  statics::SweepOptions options;
};
StaticLoads static_loads(const scene::Scene& scene, const build::BuiltModel& built);

/// Equilibria as rows of the group /statics.
class EquilibriumRows {
 public:
  EquilibriumRows(results::Recorder& recorder, const scene::Scene& scene, const build::BuiltModel& built);
  /// What the guards of the model say of an equilibrium; empty where they are silent.
  std::string breach(const statics::SweepPoint& point);
  void write(const statics::SweepPoint& point);

  /// A muscle or a cell, and its stretch.
  struct Stretched {
    std::string where = {};
    double stretch = 0.0;
  };
  /// The muscle that is shortest for its rest length at the last row; without muscles the cell that is squeezed most in
  /// some direction; empty without either.
  Stretched least_stretched();
  /// At the last row.
  build::SqueezedCell most_squeezed() const;

 private:
  void look_at(const statics::SweepPoint& point);
  model::NodeView last_view() const;

  const build::BuiltModel& built_;
  double last_load_;
  NodeRows rows_;
  std::vector<model::Energy> parts_;
  long looks_ = -2;
  model::SupplyBook supply_;
  std::vector<double> accounts_;
  struct {
    double load = 0.0;
    Eigen::VectorXd x, q, multipliers, y;
    std::vector<double> u;
  } last_;  // row
  Eigen::VectorXd zero_q_;
  Eigen::VectorXd zero_v_;
  Eigen::VectorXd constraint_force_;
};

class StaticsRun {
 public:
  StaticsRun(const scene::Scene& scene, const build::BuiltModel& built, results::Recorder& recorder);

  /// Finds the starting configuration and makes the solver; InputError if the initial joint positions contradict the
  /// loops, or the solver does not fit into this machine.
  void prepare();
  Outcome run(RunContext& context);

 private:
  std::string sentence_of(const statics::SweepResult& result);
  /// Where the equilibrium was lost, as the user speaks of it.
  std::string loss_sentence(const statics::SweepResult& result);
  /// Numbers of the load with its unit and the control that it belongs to, where it does to one.
  std::string load_text(const std::string& numbers) const;
  /// Where a guard of the model stopped the curve.
  struct Breach {
    std::string sentence = {};          ///< empty: nowhere
    std::optional<double> before = {};  ///< the load of the last row
    double at = 0.0;                    ///< the load that was refused
  };
  std::string breach_sentence(const Breach& breach) const;
  /// Limit points and branches that the arc length has passed: attributes and messages.
  void report_changes(const std::vector<statics::BranchChange>& changes, const RunContext& context);
  void report_critical(const std::vector<statics::CriticalPoint>& points, const RunContext& context);

  const scene::Scene& scene_;
  const build::BuiltModel& built_;
  results::Recorder& recorder_;
  EquilibriumRows rows_;
  std::optional<statics::Sweep> sweep_;
  statics::StaticState state_;
};

}  // namespace muldi::pipeline
