#pragma once
/// Runs of models in tests: nodes at a given time, observed orders.
#include <functional>
#include <string>

#include "model/model.hpp"
#include "variational/time_loop.hpp"

namespace muldi::test {

struct RunSetup {
  double dt = 1.0;
  long steps = 1;
  variational::StepOptions step = {};
};

/// A finished run.
struct Run {
  variational::State state;
  variational::Ledger ledger;
  variational::LoopResult result;
};

using Visit = std::function<void(const variational::NodeRecord&)>;

/// Runs the time loop from `state` and shows every node to `visit`, if given.
Run run(const model::Model& model, variational::State state, const RunSetup& setup, const Visit& visit = {});

/// What is compared at one node: all second order in dt.
struct NodeSample {
  Eigen::VectorXd q;
  Eigen::VectorXd momentum;  ///< M v
  Eigen::VectorXd reaction;  ///< -G^T lambda
  Eigen::VectorXd multipliers;
};

/// Node `steps` of a run.
NodeSample sample(const model::Model& model, const variational::State& state, const RunSetup& setup);

/// log2(|y(h) - y(h/2)| / |y(h/2) - y(h/4)|), h = setup.dt, at the same time: 2 for a second-order method.
struct Orders {
  double q = 0.0;
  double momentum = 0.0;
  double reaction = 0.0;
  double multipliers = 0.0;
};
/// Slopes of steps dt, dt/2, dt/4, dt/8: of the two that they give, the one further from 2.
Orders observed_orders(const model::Model& model, const variational::State& state, const RunSetup& setup);

/// Distance from the start, largest entry of q, after the steps of `setup` and as many back with the momentum turned
/// round; a run that fails throws.
double distance_after_return(const model::Model& model, const variational::State& start, const RunSetup& setup);

/// (4 fine - coarse)/3: the limit of a second-order value from steps h and h/2.
inline double extrapolated(double coarse, double fine) { return (4.0 * fine - coarse) / 3.0; }

/// Largest distance of a function of the node from its value at the first node, over all nodes and over tenths.
struct Band {
  double all = 0.0;
  double first_tenth = 0.0;
  double last_tenth = 0.0;
  void add(double deviation, long step, long steps);
};

}  // namespace muldi::test
