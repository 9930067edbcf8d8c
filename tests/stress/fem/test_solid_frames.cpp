/// Solids do not notice where they are, how fast the room moves, nor in what units they are written (numerics 5 nos. 1,
/// 17).
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <stdexcept>

#include "support/figure.hpp"
#include "support/random_tree.hpp"
#include "support/solid_system.hpp"
#include "support/tied_system.hpp"
#include "support/trajectory.hpp"

namespace muldi::fem {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double mu = 0.233;  // MPa

/// New units: how many of them one mm, g, ms, A is.
struct UnitSystem {
  double length = 1.0;
  double mass = 1.0;
  double time = 1.0;
  double current = 1.0;

  double acceleration() const { return length / (time * time); }
  double stress() const { return mass / (length * time * time); }
  double voltage() const { return mass * length * length / (time * time * time * current); }
  double permittivity() const { return current * time / (voltage() * length); }
};

/// A viscous cube of distorted cells on a clamped foot, under its weight and a voltage on a part of its top.
test::SolidSystem footed(Formulation formulation, const UnitSystem& in = {}) {
  test::SolidSystem system = test::solid_of(test::cube_of(2));
  for (int i = 0; i < 3; ++i) system.hold(test::plane(2, 0.0), i);
  system.set_potential(test::plane(2, 0.0), {});
  system.set_potential([](const Vector3d& X) { return X[2] > 1 - 1e-9 && X[0] < 0.8; },
                       {.constant = 2e4 * in.voltage()});
  Material material = test::rubber(mu * in.stress(), 10.0 * in.stress(), formulation);
  material.density = 1e-3 * in.mass / std::pow(in.length, 3);
  material.electric = IdealDielectric{.permittivity = 3.7 * test::eps0_si * in.permittivity()};
  material.viscous = KelvinVoigt{.viscosity = 0.05 * in.stress() * in.time};
  system.fill(material, mu * in.stress(), formulation);
  system.solid.gravity = in.acceleration() * Vector3d(3.0, 1.0, -9.0);
  system.solid.X *= in.length;
  return system;
}

void carry(SolidDescription& solid, const multibody::Pose& motion) {
  for (Eigen::Index k = 0; k < solid.X.size(); k += 3) {
    solid.X.segment<3>(k) = motion.point(Vector3d(solid.X.segment<3>(k)));
  }
  solid.gravity = motion.orientation * solid.gravity;
}

VectorXd final_positions(const model::Model& model, const variational::State& start, const test::RunSetup& setup) {
  const test::Run done = test::run(model, start, setup);
  if (done.result.status != variational::Status::completed) throw std::runtime_error(done.result.sentence);
  return done.state.q;
}

constexpr std::array<Formulation, 3> kinds = {Formulation::displacement, Formulation::mean_dilatation,
                                              Formulation::incompressible};

TEST(SolidFrames, ACarriedSolidMovesTheSame) {
  std::mt19937 random(17);
  const test::RunSetup setup{.dt = 5e-3, .steps = 60, .step = {.tolerance = 1e-12}};
  double largest = 0.0;
  for (const Formulation formulation : kinds) {
    const test::SolidSystem here = footed(formulation);
    const auto model = test::make_model(here);
    const VectorXd q = final_positions(*model, test::moving_state(*model, setup.dt), setup);
    EXPECT_GT((q - here.solid.X).lpNorm<Eigen::Infinity>(), 1e-2) << "it moves";
    const multibody::Pose motion = test::random_pose(random, 10.0);
    test::SolidSystem there = here;
    carry(there.solid, motion);
    const auto carried = test::make_model(there);
    const VectorXd got = final_positions(*carried, test::moving_state(*carried, setup.dt), setup);
    for (Eigen::Index k = 0; k < q.size(); k += 3) {
      const Vector3d expected = motion.point(Vector3d(q.segment<3>(k)));
      largest = std::max(largest, (got.segment<3>(k) - expected).lpNorm<Eigen::Infinity>());
    }
  }
  test::record_figure("1", "solid carried by a rigid motion, largest error (mm of a cube of 1 mm)", largest, 1e-9);
}

TEST(SolidFrames, AMuscleOnBodiesThatIsCarriedMovesTheSame) {
  std::mt19937 random(18);
  const double eps = 3.0 * test::eps0_si;
  test::TiedSystem here = test::hinge_with_muscle({.viscosity = 0.05, .field = 0, .permittivity = eps});
  here.rigid.controls = {{.name = "field", .unit = {}, .function = 2e4}};
  const multibody::Pose motion = test::random_pose(random, 50.0);
  test::TiedSystem there = here;
  there.rigid = here.rigid.moved(motion);
  for (SolidDescription& solid : there.solids) carry(solid, motion);
  const auto model = test::make_model(here);
  const auto carried = test::make_model(there);
  const test::RunSetup setup{.dt = 0.2, .steps = 60, .step = {.tolerance = 1e-12}};
  const test::Run one = test::run(*model, test::tied_state(*model, setup.dt, VectorXd::Zero(1)), setup);
  const test::Run other = test::run(*carried, test::tied_state(*carried, setup.dt, VectorXd::Zero(1)), setup);
  ASSERT_EQ(one.result.status, variational::Status::completed) << one.result.sentence;
  ASSERT_EQ(other.result.status, variational::Status::completed) << other.result.sentence;
  EXPECT_GT(std::abs(one.state.x[0]), 1e-3);
  const Eigen::Index first = test::solid_of(*model, 0).q_slice().first;
  double largest = std::abs(one.state.x[0] - other.state.x[0]);
  for (Eigen::Index k = first; k < one.state.q.size(); k += 3) {
    const Vector3d expected = motion.point(Vector3d(one.state.q.segment<3>(k)));
    largest = std::max(largest, (other.state.q.segment<3>(k) - expected).lpNorm<Eigen::Infinity>());
  }
  test::record_figure("1", "muscle on a body carried by a rigid motion, largest error (mm of 8 mm, rad)", largest,
                      1e-9);
}

TEST(SolidFrames, AFreeSolidInAMovingRoomMovesTheSame) {
  const Vector3d drift(3.0, -1.0, 2.0);
  const test::RunSetup setup{.dt = 5e-3, .steps = 100, .step = {.tolerance = 1e-12}};
  double largest = 0.0;
  for (const Formulation formulation : kinds) {
    test::SolidSystem system = footed(formulation);
    system.solid.displacements.clear();
    system.solid.gravity.setZero();
    const auto model = test::make_model(system);
    const VectorXd spin = test::spin(system, {0.5, -1.0, 0.7});
    const VectorXd boosted = spin + drift.replicate(system.n_nodes(), 1);
    const VectorXd at_rest = final_positions(*model, test::moving_state(*model, setup.dt, spin), setup);
    const VectorXd moving = final_positions(*model, test::moving_state(*model, setup.dt, boosted), setup);
    const Vector3d way = static_cast<double>(setup.steps) * setup.dt * drift;
    largest = std::max(largest, (moving - at_rest - way.replicate(system.n_nodes(), 1)).lpNorm<Eigen::Infinity>());
  }
  test::record_figure("1", "solid in a room that moves, largest error (mm of a cube of 1 mm)", largest, 1e-9);
}

TEST(SolidUnits, GiveTheSameResultsWithTheSameIterations) {
  const UnitSystem si{.length = 1e-3, .mass = 1e-3, .time = 1e-3, .current = 1.0};
  const UnitSystem micro{.length = 1e3, .mass = 1e6, .time = 1e3, .current = 1e3};  // um, ug, us, mA
  EXPECT_NEAR(si.permittivity(), 1.0, 1e-12);
  double largest = 0.0;
  for (const Formulation formulation : kinds) {
    VectorXd expected;
    std::vector<int> iterations;
    for (const UnitSystem& in : {UnitSystem{}, si, micro}) {
      const auto model = test::make_model(footed(formulation, in));
      const double dt = 5e-3 * in.time;
      std::vector<int> counts;
      const test::Run done =
          test::run(*model, test::moving_state(*model, dt), {.dt = dt, .steps = 60},
                    [&](const variational::NodeRecord& node) { counts.push_back(node.report.iterations); });
      ASSERT_EQ(done.result.status, variational::Status::completed) << done.result.sentence;
      const VectorXd q = done.state.q / in.length;
      if (expected.size() == 0) {
        expected = q;
        iterations = counts;
      }
      EXPECT_EQ(counts, iterations);
      largest = std::max(largest, (q - expected).lpNorm<Eigen::Infinity>());
    }
  }
  test::record_figure("17", "solids in SI and in um, ug, us, mA against mm, g, ms, A, dimensionless", largest, 1e-9);
}

}  // namespace
}  // namespace muldi::fem
