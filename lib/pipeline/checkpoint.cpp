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

/// Calls visit(name, vector, length) for every vector of a state that a restart needs; those of substructures only
/// where there are some.
template <class State, class Visit>
void each_vector(State& state, const model::Model& model, const Visit& visit) {
  const model::Manifold& manifold = *model.manifold;
  visit("x", state.x, manifold.n_x());
  visit("p", state.p, model.n_q());
  visit("increment", state.increment, manifold.n_v());
  visit("multipliers", state.multipliers, manifold.n_loop_rows());
  if (model.substructures.empty()) return;
  visit("q", state.q, model.n_q());
  visit("y", state.y, model.n_y());
  visit("advance", state.advance, model.n_q());
  visit("factor_q0", state.factor.q0, model.n_q());
  visit("factor_q1", state.factor.q1, model.n_q());
  visit("factor_y", state.factor.y, model.n_y());
}

// The other entries of `reals`, before the vectors of the state; `first()` fixes them.
enum Real : std::size_t { ledger_sums, residual, row_values, state_vectors };

/// Name of the accounts of electric sources, in models that keep them.
constexpr const char* supply = "supply";

/// Name of the last vector, in models whose substructures have a memory.
constexpr const char* memory = "memory";

Eigen::Index memory_of(const model::Model& model) {
  Eigen::Index n = 0;
  for (const auto& part : model.substructures) n += part->n_memory();
  return n;
}

bool has(const results::Checkpoint& checkpoint, const std::string& name) {
  return std::any_of(checkpoint.reals.begin(), checkpoint.reals.end(),
                     [&](const auto& vector) { return vector.name == name; });
}

/// Records of older versions hold less, and go on with the same numbers to the tolerance.
void read_factor(const std::vector<std::int64_t>& values, variational::State& state) {
  state.factor.valid = values[0] != 0;
  state.factor.first = values[1] != 0;
  if (values.size() > 2) state.exact_steps = static_cast<int>(values[2]);
  if (values.size() < 6) return;
  state.factor_use = {
      .steps = static_cast<int>(values[3]), .iterations = static_cast<int>(values[4]), .renews = values[5] != 0};
}

}  // namespace

CheckpointWriter::CheckpointWriter(const model::Model& model, std::size_t n_row) : model_(model) {
  checkpoint_.reals = {{"ledger", zeros(4)}, {"residual", zeros(2)}, {"row", std::vector<double>(n_row, 0.0)}};
  variational::State none;
  each_vector(none, model, [&](const char* name, const Eigen::VectorXd&, Eigen::Index length) {
    checkpoint_.reals.push_back({name, zeros(length)});
  });
  if (model.books_supply) checkpoint_.reals.push_back({supply, std::vector<double>(model.terminals.size(), 0.0)});
  checkpoint_.integers = {{"step", {-1}}, {"solver", {0, 0}}};
  if (model.substructures.empty()) return;
  checkpoint_.integers.push_back({"factor", {0, 0, 0, 0, 0, 0}});
  if (const Eigen::Index n = memory_of(model); n > 0) checkpoint_.reals.push_back({memory, zeros(n)});
}

void CheckpointWriter::write_memory() {
  if (memory_of(model_) == 0) return;
  std::vector<double>& values = checkpoint_.reals.back().values;
  Eigen::Map<Eigen::VectorXd> all(values.data(), static_cast<Eigen::Index>(values.size()));
  Eigen::Index first = 0;
  for (const auto& part : model_.substructures) {
    part->store_memory(all.segment(first, part->n_memory()));
    first += part->n_memory();
  }
}

const results::Checkpoint& CheckpointWriter::write(const variational::State& state, const variational::Ledger& ledger,
                                                   const variational::StepReport& last, std::span<const double> row) {
  std::size_t at = Real::state_vectors;
  each_vector(state, model_, [&](const char*, const Eigen::VectorXd& vector, Eigen::Index) {
    copy(vector, checkpoint_.reals[at++].values);
  });
  // Empty before the first node is evaluated.
  if (model_.books_supply && !ledger.supply.empty())
    std::ranges::copy(ledger.supply, checkpoint_.reals[at].values.begin());
  std::vector<double>& sums = checkpoint_.reals[Real::ledger_sums].values;
  sums[0] = ledger.dissipated;
  sums[1] = ledger.external;
  sums[2] = ledger.source;
  sums[3] = ledger.initial_total;
  checkpoint_.reals[Real::residual].values[0] = last.residual;
  checkpoint_.reals[Real::residual].values[1] = last.violation;
  std::copy(row.begin(), row.end(), checkpoint_.reals[Real::row_values].values.begin());
  checkpoint_.integers[0].values[0] = state.step;
  checkpoint_.integers[1].values[0] = last.iterations;
  checkpoint_.integers[1].values[1] = last.factorisations;
  if (model_.substructures.empty()) return checkpoint_;
  const variational::FactorUse& use = state.factor_use;
  checkpoint_.integers[2].values = {
      state.factor.valid ? 1 : 0, state.factor.first ? 1 : 0, state.exact_steps, use.steps, use.iterations,
      use.renews ? 1 : 0};
  write_memory();
  return checkpoint_;
}

long steps_of(const results::Checkpoint& checkpoint) {
  for (const auto& vector : checkpoint.integers) {
    if (vector.name == "step" && !vector.values.empty()) return vector.values.front();
  }
  return -1;
}

variational::State state_of(const results::Checkpoint& checkpoint, const scene::Scene& scene,
                            const model::Model& model) {
  variational::State state;
  bool fits = true;
  each_vector(state, model, [&](const char* name, Eigen::VectorXd& vector, Eigen::Index length) {
    if (has(checkpoint, name)) vector = vector_of(checkpoint.real(name));
    fits &= has(checkpoint, name) && vector.size() == length;
  });
  if (!fits) {
    throw base::InputError(
        {scene::error_at(scene.initial.from.origin,
                         "the record holds the state of another system: its bodies, joints or solids differ")});
  }
  state.step = checkpoint.integer("step").front();
  if (model.substructures.empty()) {
    state.q.setZero(model.n_q());
  } else {
    read_factor(checkpoint.integer("factor"), state);
  }
  model.manifold->configuration(state.x, state.q);
  return state;
}

void restore_memory(const results::Checkpoint& checkpoint, const model::Model& model) {
  if (memory_of(model) == 0) return;
  const Eigen::VectorXd all = vector_of(checkpoint.real(memory));
  Eigen::Index first = 0;
  for (const auto& part : model.substructures) {
    part->restore_memory(all.segment(first, part->n_memory()));
    first += part->n_memory();
  }
}

void restore(const results::Checkpoint& checkpoint, variational::Ledger& ledger, variational::StepReport& last,
             std::span<double> row) {
  const std::vector<double>& sums = checkpoint.real("ledger");
  ledger = {.dissipated = sums[0], .external = sums[1], .source = sums[2], .initial_total = sums[3]};
  if (has(checkpoint, supply)) ledger.supply = checkpoint.real(supply);
  last.residual = checkpoint.real("residual")[0];
  last.violation = checkpoint.real("residual")[1];
  last.iterations = static_cast<int>(checkpoint.integer("solver")[0]);
  last.factorisations = static_cast<int>(checkpoint.integer("solver")[1]);
  std::copy(checkpoint.real("row").begin(), checkpoint.real("row").end(), row.begin());
}

}  // namespace muldi::pipeline
