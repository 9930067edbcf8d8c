/// The trunk in SI and in um, ug, us, mA: the same dimensionless results with the same iterations (numerics 2, 5 no.
/// 17).
#include <gtest/gtest.h>

#include "support/figure.hpp"
#include "support/systems.hpp"
#include "support/trajectory.hpp"

namespace muldi::variational {
namespace {

/// How many of the new units one mm, g, ms, A is.
struct UnitSystem {
  double length = 1.0;
  double mass = 1.0;
  double time = 1.0;
  double current = 1.0;

  double stress() const { return mass / (length * time * time); }
  double field() const { return mass * length / (time * time * time * current); }
  double permittivity() const { return current * time / (field() * length * length); }
};

/// Bodies, joints, lumped muscles and constant fields in other units.
test::RigidSystem in_units(test::RigidSystem system, const UnitSystem& to) {
  const double volume = to.length * to.length * to.length;
  for (auto& body : system.bodies) {
    body.mass *= to.mass;
    body.inertia *= to.mass * to.length * to.length;
  }
  for (auto& pose : system.poses) pose.position *= to.length;
  for (auto& joint : system.joints) {
    joint.rho_a *= to.length;
    joint.rho_b *= to.length;
    joint.offset *= to.length;
  }
  for (auto& muscle : system.muscles) {
    muscle.a1.local *= to.length;
    muscle.a2.local *= to.length;
    muscle.element.shear_modulus *= to.stress();
    muscle.element.viscosity *= to.stress() * to.time;
    muscle.element.density *= to.mass / volume;
    muscle.element.length *= to.length;
    muscle.element.area *= to.length * to.length;
    for (double* c : {&muscle.element.electric_law.a_2, &muscle.element.electric_law.a_0,
                      &muscle.element.electric_law.a_m2, &muscle.element.electric_law.a_m4}) {
      *c *= to.permittivity();
    }
  }
  for (auto& control : system.controls) control.function = control.function.at(0.0) * to.field();
  system.gravity *= to.length / (to.time * to.time);
  system.length *= to.length;
  return system;
}

TEST(Units, OfTheTrunkDoNotMatter) {
  const UnitSystem si{.length = 1e-3, .mass = 1e-3, .time = 1e-3, .current = 1.0};
  const UnitSystem micro{.length = 1e3, .mass = 1e6, .time = 1e3, .current = 1e3};  // um, ug, us, mA
  EXPECT_NEAR(si.permittivity(), 1.0, 1e-12);
  const test::RigidSystem system = test::trunk(test::odd_fields(3e4));
  Eigen::VectorXd expected;
  std::vector<int> iterations;
  double largest = 0.0;
  for (const UnitSystem& to : {UnitSystem{}, si, micro}) {
    const auto model = test::make_model(in_units(system, to));
    std::vector<int> counts;
    const test::Run done = test::run(*model, test::state_at_rest(*model), {.dt = 5.0 * to.time, .steps = 100},
                                     [&](const NodeRecord& node) { counts.push_back(node.report.iterations); });
    ASSERT_EQ(done.result.status, Status::completed) << done.result.sentence;
    const Eigen::VectorXd x = done.state.x;  // angles
    if (expected.size() == 0) {
      expected = x;
      iterations = counts;
      EXPECT_GT((x - model->manifold->reference()).norm(), 1e-2) << "it moves";
    }
    EXPECT_EQ(counts, iterations);
    largest = std::max(largest, (x - expected).lpNorm<Eigen::Infinity>());
  }
  test::record_figure("17", "trunk in SI and in um, ug, us, mA against mm, g, ms, A, angles (rad)", largest, 1e-9);
}

}  // namespace
}  // namespace muldi::variational
