#pragma once
/// Scenes run in this process, as `muldi-sim run` runs them, with their results in memory.
#include <Eigen/Core>
#include <string>
#include <vector>

#include "build/built_model.hpp"
#include "pipeline/outcome.hpp"
#include "results/memory_recorder.hpp"
#include "scene/scene.hpp"

namespace muldi::golden {

inline constexpr double degree = 0.017453292519943295;

using Overrides = std::vector<std::string>;

/// A scene of scenes/ by name, or of tests/golden/ by `si/<name>`.
scene::Scene shipped(const std::string& name, const Overrides& overrides = {});

/// The scene as its own resolved text says it, read again: what a user's file with these numbers gives.
scene::Scene written_and_read(const scene::Scene& scene, const Overrides& overrides = {});

/// A finished run; paths are those of the result file.
class SceneRun {
 public:
  explicit SceneRun(scene::Scene scene);
  explicit SceneRun(const std::string& name, const Overrides& overrides = {}) : SceneRun(shipped(name, overrides)) {}

  const scene::Scene& scene() const { return scene_; }
  const pipeline::Outcome& outcome() const { return outcome_; }
  /// Sentences about the numerics that the user would have seen.
  const std::vector<std::string>& warnings() const { return warnings_; }
  const results::MemoryRecorder& recorder() const { return recorder_; }

  std::size_t n_rows(const std::string& path) const;
  /// All rows of a channel: one column a row, entries in the order of the file.
  Eigen::Map<const Eigen::MatrixXd> rows(const std::string& path) const;
  /// The last row, and its first value.
  Eigen::VectorXd last(const std::string& path) const { return rows(path).rightCols<1>(); }
  double value(const std::string& path) const { return last(path)[0]; }
  /// The first value of the row at time `t`, which is a recorded node.
  double value_at(const std::string& path, double t) const;
  /// A real attribute set at the end of the run.
  double attribute(const std::string& object, const std::string& name) const;
  /// Newton iterations of each row.
  std::vector<std::int64_t> iterations(const std::string& prefix = {}) const;

 private:
  scene::Scene scene_;
  build::BuiltModel built_;
  results::MemoryRecorder recorder_;
  std::vector<std::string> warnings_;
  pipeline::Outcome outcome_;
};

/// (4 fine - coarse)/3: the limit of a second-order value from steps h and h/2.
inline double extrapolated(double coarse, double fine) { return (4.0 * fine - coarse) / 3.0; }

/// `dynamics.step=<step>`; the step with all its digits.
std::string step_of(double step);

}  // namespace muldi::golden
