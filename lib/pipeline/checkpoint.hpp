#pragma once
/// Checkpoints: everything that goes on bit for bit, as named vectors.
#include "multibody/tree_manifold.hpp"
#include "results/recorder.hpp"
#include "scene/scene.hpp"
#include "variational/time_loop.hpp"

namespace muldi::pipeline {

/// Writes states into a checkpoint of fixed shape without allocating.
class CheckpointWriter {
 public:
  /// `n_row`: values of one recorded row (the next row may refer to them).
  CheckpointWriter(const model::Model& model, std::size_t n_row);

  const results::Checkpoint& first() const { return checkpoint_; }
  const results::Checkpoint& write(const variational::State& state, const variational::Ledger& ledger,
                                   const variational::StepReport& last, std::span<const double> row);

 private:
  void write_memory();

  const model::Model& model_;
  results::Checkpoint checkpoint_;
};

/// Time steps made when the checkpoint was taken; -1 before the dynamics and in records without dynamics.
long steps_of(const results::Checkpoint& checkpoint);
/// True if the checkpoint was taken in the dynamics.
inline bool in_dynamics(const results::Checkpoint& checkpoint) { return steps_of(checkpoint) >= 0; }

/// The state at a checkpoint; InputError if it belongs to another system.
variational::State state_of(const results::Checkpoint& checkpoint, const scene::Scene& scene,
                            const model::Model& model);
/// Gives the substructures what their iterative evaluations start from.
void restore_memory(const results::Checkpoint& checkpoint, const model::Model& model);
void restore(const results::Checkpoint& checkpoint, variational::Ledger& ledger, variational::StepReport& last,
             std::span<double> row);

}  // namespace muldi::pipeline
