#include "pipeline/checkpoint.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "base/text.hpp"

namespace muldi::pipeline {
namespace {

std::vector<double> zeros(Eigen::Index n) { return std::vector<double>(static_cast<std::size_t>(n), 0.0); }

void copy(const Eigen::VectorXd& from, std::vector<double>& to) {
  std::copy(from.data(), from.data() + from.size(), to.begin());
}

Eigen::VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

// Places in the lists; `first()` fixes them.
enum Real : std::size_t { x, p, increment, multipliers, ledger_sums, residual, row_values };

}  // namespace

CheckpointWriter::CheckpointWriter(const model::Manifold& manifold, std::size_t n_row) {
  checkpoint_.reals = {{"x", zeros(manifold.n_x())},
                       {"p", zeros(manifold.n_q())},
                       {"increment", zeros(manifold.n_v())},
                       {"multipliers", zeros(manifold.n_loop_rows())},
                       {"ledger", zeros(4)},
                       {"residual", zeros(1)},
                       {"row", std::vector<double>(n_row, 0.0)}};
  checkpoint_.integers = {{"step", {-1}}, {"solver", {0, 0}}};
}

const results::Checkpoint& CheckpointWriter::write(const variational::State& state, const variational::Ledger& ledger,
                                                   const variational::StepReport& last, std::span<const double> row) {
  copy(state.x, checkpoint_.reals[Real::x].values);
  copy(state.p, checkpoint_.reals[Real::p].values);
  copy(state.increment, checkpoint_.reals[Real::increment].values);
  copy(state.multipliers, checkpoint_.reals[Real::multipliers].values);
  std::vector<double>& sums = checkpoint_.reals[Real::ledger_sums].values;
  sums[0] = ledger.dissipated;
  sums[1] = ledger.external;
  sums[2] = ledger.source;
  sums[3] = ledger.initial_total;
  checkpoint_.reals[Real::residual].values[0] = last.residual;
  std::copy(row.begin(), row.end(), checkpoint_.reals[Real::row_values].values.begin());
  checkpoint_.integers[0].values[0] = state.step;
  checkpoint_.integers[1].values[0] = last.iterations;
  checkpoint_.integers[1].values[1] = last.factorisations;
  return checkpoint_;
}

long steps_of(const results::Checkpoint& checkpoint) {
  for (const auto& vector : checkpoint.integers) {
    if (vector.name == "step" && !vector.values.empty()) return vector.values.front();
  }
  return -1;
}

variational::State state_of(const results::Checkpoint& checkpoint, const scene::Scene& scene,
                            const model::Manifold& manifold) {
  variational::State state;
  state.x = vector_of(checkpoint.real("x"));
  state.p = vector_of(checkpoint.real("p"));
  state.increment = vector_of(checkpoint.real("increment"));
  state.multipliers = vector_of(checkpoint.real("multipliers"));
  if (state.x.size() != manifold.n_x() || state.p.size() != manifold.n_q() ||
      state.increment.size() != manifold.n_v() || state.multipliers.size() != manifold.n_loop_rows()) {
    throw base::InputError({scene::error_at(
        scene.initial.from.origin, "the record holds the state of another system: its bodies or joints differ")});
  }
  state.step = checkpoint.integer("step").front();
  state.q.setZero(manifold.n_q());
  manifold.configuration(state.x, state.q);
  return state;
}

void restore(const results::Checkpoint& checkpoint, variational::Ledger& ledger, variational::StepReport& last,
             std::span<double> row) {
  const std::vector<double>& sums = checkpoint.real("ledger");
  ledger = {.dissipated = sums[0], .external = sums[1], .source = sums[2], .initial_total = sums[3]};
  last.residual = checkpoint.real("residual").front();
  last.iterations = static_cast<int>(checkpoint.integer("solver")[0]);
  last.factorisations = static_cast<int>(checkpoint.integer("solver")[1]);
  std::copy(checkpoint.real("row").begin(), checkpoint.real("row").end(), row.begin());
}

}  // namespace muldi::pipeline
