/// Long chains: closed, and the same from every solver.
#include <gtest/gtest.h>

#include "support/figure.hpp"
#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi::variational {
namespace {

TEST(Chains, OfTwoHundredBodiesStayClosed) {
  // 200 bodies fall from rest, 200 steps of 1 ms; orientations are products of
  // 200 rotations.
  const test::RigidSystem system = test::revolute_chain(200);
  const auto model = test::make_model(system);
  double violation = 0.0;
  const test::Run run = test::run(
      *model, test::state_at_rest(*model), {.dt = 1.0, .steps = 200},
      [&](const NodeRecord& node) { violation = std::max(violation, model->manifold->violation(node.state.q)); });
  EXPECT_EQ(run.result.status, Status::completed) << run.result.sentence;
  EXPECT_LT(violation, 1e-12);
}

TEST(Chains, OfFortyBodiesMoveTheSameUnderEverySolver) {
  test::RigidSystem system = test::revolute_chain(40);
  const auto model = test::make_model(system);
  std::vector<Eigen::VectorXd> ends;
  for (const std::string kind : {"tree", "dense", "bordered"}) {
    const test::Run run =
        test::run(*model, test::state_at_rest(*model), {.dt = 1.0, .steps = 50, .step = {.linear = kind}});
    EXPECT_EQ(run.result.status, Status::completed) << kind << run.result.sentence;
    ends.push_back(run.state.q);
  }
  const double apart = std::max((ends[1] - ends[0]).norm(), (ends[2] - ends[0]).norm());
  test::record_figure("19", "chain of 40 bodies, dense and bordered solver against the tree, relative",
                      apart / ends[0].norm(), 1e-9);
}

}  // namespace
}  // namespace muldi::variational
