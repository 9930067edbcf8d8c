/// The elephant trunk off its straight pose, against an independent program (reference-results E).
#include <gtest/gtest.h>

#include <array>

#include "support/systems.hpp"

namespace muldi::multibody {
namespace {

TEST(Trunk, HasTheTipLengthsAndPotentialOfTheReference) {
  const std::array<double, 12> kilovolts{30, 5, 10, 20, 0, 40, 25, 15, 35, 0, 12, 8};
  std::vector<double> fields;
  for (const double field : kilovolts) fields.push_back(1e3 * field);
  const test::RigidSystem system = test::trunk(fields);
  const auto model = test::make_model(system);
  const Eigen::VectorXd x{{0.1, -0.05, 0.2, 0.15, -0.1, 0.05}};
  const Eigen::VectorXd q = test::configuration_at(*model->manifold, x);
  const test::End tip = test::trunk_tip();
  // Printed to ten digits.
  EXPECT_LT((body_point(tip.body, tip.local).value(q) - Eigen::Vector3d(-60.05429896, 297.7868222, 12.75517058)).norm(),
            1e-7);
  const std::array<double, 4> lengths{49.228435312289, 50.726610060859, 50.369262351521, 49.619490484388};
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& muscle = system.muscles[k];
    const Eigen::Vector3d across =
        body_point(muscle.a1.body, muscle.a1.local).value(q) - body_point(muscle.a2.body, muscle.a2.local).value(q);
    EXPECT_NEAR(across.norm(), lengths[k], 1e-11);
  }
  std::vector<model::Energy> parts(model->parts().size());
  const Eigen::VectorXd v = Eigen::VectorXd::Zero(q.size());
  model->energies({.x = {x.data(), 6}, .q = q, .v = v, .u = fields}, parts);
  double potential = 0.0;
  for (const model::Energy& part : parts) potential += part.potential();
  EXPECT_NEAR(potential, -212.333425162110, 1e-9);
}

}  // namespace
}  // namespace muldi::multibody
