#pragma once
/// Optimal control problems of scenes solved in this process, as `muldi-sim optimise` solves them.
#include <string>

#include "pipeline/optimise.hpp"
#include "scene_run.hpp"

namespace muldi::golden {

/// A finished optimisation; paths are those of the result file.
class OptimalRun {
 public:
  explicit OptimalRun(const std::string& name, const Overrides& overrides = {})
      : scene_(shipped(name, overrides)),
        built_(build::build_model(scene_)),
        found_(pipeline::optimise(scene_, built_, recorder_, context_, {})) {}

  const scene::Scene& scene() const { return scene_; }
  const pipeline::Optimised& found() const { return found_; }
  bool completed() const { return found_.outcome.completed(); }
  const pipeline::StageEnd& last() const { return found_.stages.back(); }
  double objective() const { return last().result.objective; }
  const control::Trajectory& trajectory() const { return last().result.trajectory; }
  /// Value of control `name` in interval n.
  double control(const std::string& name, std::size_t n) const {
    return trajectory().u[n][static_cast<std::size_t>(scene_.controls.index(name))];
  }
  /// The last value of a channel.
  double final_value(const std::string& path) const { return recorder_.reals(path).back(); }
  const results::MemoryRecorder& recorder() const { return recorder_; }
  /// Largest deviation of the replay over all joints and points.
  double largest_deviation() const {
    double largest = 0.0;
    for (const pipeline::Deviation& one : found_.replay->all) largest = std::max(largest, one.largest);
    return largest;
  }
  /// Largest distance from the end of the optimum after the horizon.
  double largest_afterwards() const {
    double largest = 0.0;
    for (const pipeline::Deviation& one : found_.replay->all) largest = std::max(largest, one.after);
    return largest;
  }

 private:
  scene::Scene scene_;
  build::BuiltModel built_;
  results::MemoryRecorder recorder_;
  pipeline::RunContext context_;
  pipeline::Optimised found_;
};

}  // namespace muldi::golden
