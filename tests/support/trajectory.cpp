#include "support/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace muldi::test {

Run run(const model::Model& model, variational::State state, const RunSetup& setup, const Visit& visit) {
  Run result{.state = std::move(state), .ledger = {}, .result = {}};
  variational::TimeLoop loop(model, {.dt = setup.dt, .steps = setup.steps, .step = setup.step});
  variational::StepReport last;
  result.result = loop.run(result.state, result.ledger, last, {.record = visit});
  return result;
}

NodeSample sample(const model::Model& model, const variational::State& state, const RunSetup& setup) {
  NodeSample result;
  // One step more: the reactions at a node come from the step that follows it.
  const Run done = run(model, state, {.dt = setup.dt, .steps = setup.steps + 1, .step = setup.step},
                       [&](const variational::NodeRecord& node) {
                         if (node.step != setup.steps) return;
                         result.q = node.state.q;
                         result.momentum = node.values.momentum;
                         result.reaction = node.constraint_force;
                         result.multipliers = node.multipliers;
                       });
  if (done.result.status != variational::Status::completed) throw std::runtime_error(done.result.sentence);
  return result;
}

Orders observed_orders(const model::Model& model, const variational::State& state, const RunSetup& setup) {
  std::array<NodeSample, 4> at;
  for (std::size_t k = 0; k < at.size(); ++k) {
    const long factor = 1L << k;
    at[k] = sample(model, state,
                   {.dt = setup.dt / static_cast<double>(factor), .steps = setup.steps * factor, .step = setup.step});
  }
  const auto order = [&](Eigen::VectorXd NodeSample::*value) {
    const auto slope = [&](std::size_t k) {
      return std::log2((at[k].*value - at[k + 1].*value).norm() / (at[k + 1].*value - at[k + 2].*value).norm());
    };
    return std::abs(slope(0) - 2.0) > std::abs(slope(1) - 2.0) ? slope(0) : slope(1);
  };
  return {.q = order(&NodeSample::q),
          .momentum = order(&NodeSample::momentum),
          .reaction = order(&NodeSample::reaction),
          .multipliers = order(&NodeSample::multipliers)};
}

double distance_after_return(const model::Model& model, const variational::State& start, const RunSetup& setup) {
  const Run there = run(model, start, setup);
  if (there.result.status != variational::Status::completed) throw std::runtime_error(there.result.sentence);
  variational::State back = there.state;
  back.p = -back.p;
  back.increment = -back.increment;
  back.advance = -back.advance;
  back.step = 0;
  back.t = 0.0;
  back.factor = {};
  const Run home = run(model, back, setup);
  if (home.result.status != variational::Status::completed) throw std::runtime_error(home.result.sentence);
  return (home.state.q - start.q).lpNorm<Eigen::Infinity>();
}

void Band::add(double deviation, long step, long steps) {
  const double size = std::abs(deviation);
  all = std::max(all, size);
  if (10 * step <= steps) first_tenth = std::max(first_tenth, size);
  if (10 * step >= 9 * steps) last_tenth = std::max(last_tenth, size);
}

}  // namespace muldi::test
