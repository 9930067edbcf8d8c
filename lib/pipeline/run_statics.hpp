#pragma once
/// The `statics:` section of a scene: a curve of equilibria.
#include <optional>

#include "build/built_model.hpp"
#include "pipeline/node_rows.hpp"
#include "pipeline/outcome.hpp"
#include "pipeline/run_context.hpp"
#include "statics/sweep.hpp"

namespace muldi::pipeline {

class StaticsRun {
 public:
  StaticsRun(const scene::Scene& scene, const build::BuiltModel& built, results::Recorder& recorder);

  /// Finds the starting configuration and makes the solver; InputError if the initial joint positions contradict the
  /// loops, or the solver does not fit into this machine.
  void prepare();
  Outcome run(RunContext& context);

 private:
  void record(const statics::SweepPoint& point);
  void make_sweep();
  /// Where the equilibrium was lost, as the user speaks of it.
  std::string loss_sentence(const statics::SweepResult& result) const;
  double last_load() const;
  /// Limit points and branches that the arc length has passed: attributes and messages.
  void report_critical(const std::vector<statics::CriticalPoint>& points, const RunContext& context);

  const scene::Scene& scene_;
  const build::BuiltModel& built_;
  results::Recorder& recorder_;
  NodeRows rows_;
  std::optional<statics::Sweep> sweep_;
  statics::StaticState state_;
  std::vector<model::Energy> parts_;
  long looks_ = -2;
  double least_stretch_ = 0.0;   // of the muscles at the last recorded equilibrium
  std::string least_stretched_;  // its muscle; empty without muscles
  Eigen::VectorXd zero_q_;
  Eigen::VectorXd zero_v_;
  Eigen::VectorXd constraint_force_;
};

}  // namespace muldi::pipeline
