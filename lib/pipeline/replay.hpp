#pragma once
/// The controls of an optimum in the forward integrator, and how far its motion is from the optimum.
#include <optional>
#include <string>
#include <vector>

#include "build/built_model.hpp"
#include "control/problem.hpp"
#include "pipeline/node_rows.hpp"
#include "pipeline/outcome.hpp"
#include "pipeline/run_context.hpp"
#include "results/recorder.hpp"

namespace muldi::pipeline {

/// How far a joint coordinate or a point is from the optimum.
struct Deviation {
  std::string name = {};  ///< e.g. "joints/hinge" or "points/arm.tip"
  bool is_angle = false;
  std::vector<double> values = {};  ///< at the nodes of the optimum: of coordinates replay less optimum, of points the
                                    ///< distance
  double largest = 0.0;             ///< magnitude over the horizon
  double final = 0.0;               ///< magnitude at its end
  double after = 0.0;               ///< largest distance, beyond the horizon, from the end of the optimum
};

struct Deviations {
  std::vector<Deviation> all = {};
  bool beyond = false;                    ///< the replay goes on after the horizon
  std::optional<double> stopped_at = {};  ///< time at which the replay stopped before its end
  bool in_horizon = false;                ///< it stopped before the end of the horizon
};

/// Builds the model of a replay and drops it; InputError if its muscles do not fit.
void build_replay(const scene::Scene& scene);

/// The replay that a scene asks for: its own scene and model, declared in the recorder before the optimisation starts.
class ReplayRun {
 public:
  /// Builds the model with the muscles of the replay; InputError if they do not fit.
  ReplayRun(const scene::Scene& scene, results::Recorder& recorder);

  /// Runs the controls of the optimum from its initial pose with these minimal velocities (n_v).
  Outcome run(const control::Trajectory& optimum, const Eigen::VectorXd& rates, RunContext& context);

  /// What the last run found; valid where it got.
  const Deviations& deviations() const { return deviations_; }

 private:
  /// What is compared: a minimal coordinate, or a point where there is none.
  struct Watched {
    int rate = -1;
    model::LinearPoint point = {};
  };
  void set_controls(const control::Trajectory& optimum);
  void start(const control::Trajectory& optimum, const Eigen::VectorXd& rates, variational::State& state) const;
  void compare(const variational::NodeRecord& node, const control::Trajectory& optimum);
  void store() const;

  scene::Scene scene_;
  results::Recorder& recorder_;
  build::BuiltModel built_;
  std::optional<NodeRows> rows_;
  std::vector<Watched> watched_;  // beside deviations_.all
  Deviations deviations_;
  long fine_ = 1;      // steps of the replay in a step of the optimum
  long n_beyond_ = 0;  // steps after the horizon
  double step_ = 0.0;
};

}  // namespace muldi::pipeline
