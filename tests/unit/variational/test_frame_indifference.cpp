/// A system carried along by a rigid motion, with gravity, anchors and all, moves the same (numerics 5 no. 1).
#include <gtest/gtest.h>

#include "support/linkages.hpp"
#include "support/random_tree.hpp"
#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi::variational {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

void expect_indifferent(const test::RigidSystem& system, const test::RunSetup& setup) {
  std::mt19937 random(130);
  const auto model = test::make_model(system);
  const test::Run run = test::run(*model, test::state_at_rest(*model), setup);
  ASSERT_EQ(run.result.status, Status::completed) << run.result.sentence;
  EXPECT_GT((run.state.q - test::state_at_rest(*model).q).norm(), 1e-4 * system.length) << "it moves";
  for (int n = 0; n < 3; ++n) {
    const multibody::Pose motion = test::random_pose(random, system.length);
    const auto carried = test::make_model(system.moved(motion));
    const test::Run again = test::run(*carried, test::state_at_rest(*carried), setup);
    ASSERT_EQ(again.result.status, Status::completed) << again.result.sentence;
    VectorXd expected(run.state.q.size());
    VectorXd momentum(run.state.q.size());
    for (Eigen::Index k = 0; k < expected.size(); k += 3) {
      const Vector3d triple = run.state.q.segment<3>(k);
      expected.segment<3>(k) = k % 12 == 0 ? motion.point(triple) : Vector3d(motion.orientation * triple);
      momentum.segment<3>(k) = motion.orientation * run.state.p.segment<3>(k);
    }
    EXPECT_LT((again.state.q - expected).lpNorm<Eigen::Infinity>(), 1e-9 * system.length);
    EXPECT_LT((again.state.p - momentum).norm(), 1e-9 * momentum.norm());
  }
}

TEST(FrameIndifference, OfPendulumsTopAndTrunk) {
  expect_indifferent(test::double_pendulum(), {.dt = 2.0, .steps = 200});
  expect_indifferent(test::heavy_top(0.5), {.dt = 1.0, .steps = 200});
  expect_indifferent(test::trunk(test::odd_fields(3e4)), {.dt = 5.0, .steps = 100});
}

TEST(FrameIndifference, OfLoops) {
  expect_indifferent(test::four_bar({}, test::earth_gravity), {.dt = 1.0, .steps = 200});
  expect_indifferent(test::slider_crank(test::earth_gravity), {.dt = 1.0, .steps = 200});
}

TEST(FrameIndifference, OfRandomForestsWithSpringsAndLoads) {
  std::mt19937 random(131);
  for (int n = 0; n < 10; ++n) {
    test::RigidSystem system = test::random_forest(random, {.n_bodies = 6, .n_chains = 2});
    system.springs.push_back({.name = "s",
                              .element = {.stiffness = 1e-3, .rest_length = 20.0, .damping = 1e-2},
                              .a1 = {0, Vector3d(1.0, 2.0, 3.0)},
                              .a2 = {multibody::ground, Vector3d(3.0, -1.0, 4.0)}});
    for (const auto frame : {multibody::Load::Frame::world, multibody::Load::Frame::body}) {
      system.loads.push_back({.name = "l",
                              .kind = multibody::Load::Kind::torque,
                              .frame = frame,
                              .body = 3,
                              .direction = Vector3d(1.0, 0.5, -0.3)});
    }
    expect_indifferent(system, {.dt = 1.0, .steps = 30});
  }
}

}  // namespace
}  // namespace muldi::variational
