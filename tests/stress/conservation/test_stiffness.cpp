/// Springs whose stiffnesses differ by 1e8 (numerics 5 no. 18).
#include <gtest/gtest.h>

#include <iostream>

#include "multibody/registry.hpp"
#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi {
namespace {

using Eigen::Vector3d;

TEST(Stiffness, RatioOfAHundredMillionConverges) {
  // The stiff spring holds the angle between the two bodies, the soft one draws the second to ground.
  test::RigidSystem system = test::double_pendulum();
  system.springs = {{.name = "soft",
                     .element = {.stiffness = 1e-3, .rest_length = 50.0},
                     .a1 = {multibody::ground, Vector3d(150.0, 120.0, 40.0)},
                     .a2 = system.end_at(1, Vector3d(184.0, 0.0, 0.0))},
                    {.name = "stiff",
                     .element = {.stiffness = 1e5, .rest_length = std::hypot(60.0, 20.0)},
                     .a1 = system.end_at(0, Vector3d(62.0, 20.0, 0.0)),
                     .a2 = system.end_at(1, Vector3d(122.0, 0.0, 0.0))}};
  const auto model = test::make_model(system);
  const auto end = [&](double dt, long steps) {
    double violation = 0.0;
    const test::Run done = test::run(*model, test::state_at_rest(*model), {.dt = dt, .steps = steps},
                                     [&](const variational::NodeRecord& node) {
                                       violation = std::max(violation, model->manifold->violation(node.state.q));
                                     });
    EXPECT_EQ(done.result.status, variational::Status::completed) << done.result.sentence;
    EXPECT_LT(violation, 1e-10);
    std::cout << "violation " << violation << ", iterations a step "
              << static_cast<double>(done.result.statistics.iterations) / static_cast<double>(steps) << '\n';
    return done.state.q;
  };
  const double apart = (end(1.0, 1000) - end(0.1, 10'000)).lpNorm<Eigen::Infinity>() / system.length;
  std::cout << "dt against dt/10: " << apart << '\n';
  EXPECT_LT(apart, 1e-4);
}

}  // namespace
}  // namespace muldi
