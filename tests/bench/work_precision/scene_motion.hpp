#pragma once
/// Our own runs: the stepper alone, with what is read off its states at the samples.
#include <functional>
#include <string>
#include <vector>

#include "bench/scene_runs.hpp"
#include "bench/work_precision/integrators.hpp"
#include "variational/node_values.hpp"

namespace muldi::bench {

/// Rows of equal length, one a sample; fewer where the run failed.
struct Motion {
  std::vector<std::vector<double>> rows = {};
  long iterations = 0;  ///< of Newton, in all steps
};

/// Takes what is compared from a state into a row.
using Read = std::function<void(const variational::State&, std::vector<double>&)>;

/// The time steps of a scene from its state at t = 0, and nothing else.
inline Motion march(const ReadyScene& ready, const Grid& grid, const variational::StepOptions& options,
                    const Read& read) {
  const model::Model& model = *ready.built.model;
  variational::Stepper stepper(model, grid.step, options);
  variational::State state = ready.state;
  std::vector<double> u(model.controls.size());
  Motion motion;
  const long steps = grid.steps();
  const long every = grid.steps_a_sample();
  motion.rows.reserve(static_cast<std::size_t>(steps / every));
  for (long i = 1; i <= steps; ++i) {
    model.evaluate_controls((static_cast<double>(i) - 0.5) * grid.step, u);
    const variational::StepReport report = stepper.advance(state, u);
    if (report.status != variational::Status::running) break;
    motion.iterations += report.iterations;
    if (i % every != 0) continue;
    motion.rows.emplace_back();
    read(state, motion.rows.back());
  }
  return motion;
}

/// Largest difference from the reference over all samples and entries, relative to the largest motion from `start`.
/// NaN where samples are missing.
inline double motion_error(const std::vector<std::vector<double>>& rows,
                           const std::vector<std::vector<double>>& reference, const std::vector<double>& start) {
  if (rows.size() != reference.size()) return std::nan("");
  double amplitude = 0.0;
  double difference = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t k = 0; k < start.size(); ++k) {
      amplitude = std::max(amplitude, std::abs(reference[i][k] - start[k]));
      difference = std::max(difference, std::abs(rows[i][k] - reference[i][k]));
    }
  }
  return difference / amplitude;
}

/// Error of second order from two runs, that is of the finer one, removed: (4 fine - coarse) / 3.
inline std::vector<std::vector<double>> extrapolated(const Motion& fine, const Motion& coarse) {
  std::vector<std::vector<double>> rows = fine.rows;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t k = 0; k < rows[i].size(); ++k) rows[i][k] += (fine.rows[i][k] - coarse.rows[i][k]) / 3.0;
  }
  return rows;
}

}  // namespace muldi::bench
