/// What every element must do: volumes, masses, rigid motions, loads, values at points.
#include <gtest/gtest.h>

#include <cmath>

#include "support/allocation_count.hpp"
#include "support/fem_patch.hpp"

namespace muldi {
namespace {

using test::FemState;
using test::FemSystem;

Eigen::Matrix3d some_rotation() {
  return Eigen::AngleAxisd(0.7, Eigen::Vector3d(1.0, -2.0, 3.0).normalized()).toRotationMatrix();
}

/// x = A X + b at every node.
Eigen::VectorXd mapped(const test::FemPatch& patch, const Eigen::Matrix3d& A, const Eigen::Vector3d& b) {
  Eigen::VectorXd x(patch.X.size());
  for (int k = 0; k < patch.n_nodes(); ++k) x.segment<3>(3 * k) = A * patch.node(k) + b;
  return x;
}

TEST(Element, NodalVolumesSumToTheVolume) {
  const FemSystem system(test::seven_elements(), {});
  Eigen::VectorXd volumes = Eigen::VectorXd::Zero(16);
  system.each(
      [&](const auto& range) { system.kernels().loads(range, system.patch().X.data(), nullptr, 1, volumes.data()); });
  EXPECT_NEAR(volumes.sum(), 1.0, 1e-15);
}

TEST(Element, LoadsOfALinearDensityHaveItsForceAndMoment) {
  const FemSystem system(test::cube_of(2), {});
  const int n = system.patch().n_elements();
  std::vector<fem::PointValues> points(static_cast<std::size_t>(8 * n));
  const FemState state{.x = system.patch().X, .v = {}, .phi = {}, .pressure = {}};
  system.each([&](const auto& range) {
    system.kernels().point_values(system.laws(), range, state.fields(system.patch()), points.data());
  });
  std::vector<double> density;
  for (const fem::PointValues& point : points) {
    density.push_back(point.X[0]);
    density.push_back(1.0 - point.X[2]);
  }
  Eigen::VectorXd loads = Eigen::VectorXd::Zero(2 * system.patch().n_nodes());
  system.each([&](const auto& range) {
    system.kernels().loads(range, system.patch().X.data(), density.data(), 2, loads.data());
  });
  double moment = 0.0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int k = 0; k < system.patch().n_nodes(); ++k) {
    sum += loads.segment<2>(2 * k);
    moment += loads[2 * k] * system.patch().node(k)[1];
  }
  // Integrals over the unit cube of X, 1 - Z and X Y; inner cells are distorted, where the product rule with two points
  // still integrates polynomials of this degree.
  EXPECT_NEAR(sum[0], 0.5, 1e-14);
  EXPECT_NEAR(sum[1], 0.5, 1e-14);
  EXPECT_NEAR(moment, 0.25, 1e-3);
}

TEST(Element, RigidMotionGivesNoForce) {
  const FemSystem system(test::seven_elements(), test::full_material());
  const Eigen::Matrix3d Q = some_rotation();
  const Eigen::Vector3d omega(0.3, -0.1, 0.2);
  FemState state{.x = mapped(system.patch(), Q, {1.0, 2.0, 3.0}), .v = {}, .phi = {}, .pressure = {}};
  state.v.resize(state.x.size());
  for (int k = 0; k < system.patch().n_nodes(); ++k) {
    state.v.segment<3>(3 * k) = omega.cross(state.x.segment<3>(3 * k)) + Eigen::Vector3d(0.5, 0.0, -1.0);
  }
  state.phi = Eigen::VectorXd::Constant(16, 5e3);
  const test::FemForces forces = system.forces(state);
  // Round-off of F times the bulk modulus 10.
  EXPECT_LE(forces.force.cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_LE(forces.charge.cwiseAbs().maxCoeff(), 1e-20);
  EXPECT_NEAR(forces.least, 1.0, 1e-14);
  EXPECT_LE(system.energies(state).dissipation, 1e-28);
}

TEST(Element, DiscreteRotationOfADeformedStateDissipatesNothing) {
  const FemSystem system(test::seven_elements(), test::full_material());
  std::mt19937 random(4);
  const Eigen::VectorXd x0 = test::random_state(system.patch(), random).x;
  Eigen::VectorXd x1(x0.size());
  for (int k = 0; k < system.patch().n_nodes(); ++k) x1.segment<3>(3 * k) = some_rotation() * x0.segment<3>(3 * k);
  const FemState still{.x = 0.5 * (x0 + x1), .v = {}, .phi = {}, .pressure = {}};
  FemState turning = still;
  turning.v = x1 - x0;
  EXPECT_LE(system.energies(turning).dissipation, 1e-28);
  EXPECT_LE((system.forces(turning).force - system.forces(still).force).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Element, MassCarriesMomentumAndKineticEnergy) {
  const FemSystem system(test::seven_elements(), test::full_material());
  FemState state{.x = system.patch().X, .v = Eigen::VectorXd(48), .phi = {}, .pressure = {}};
  for (int k = 0; k < 16; ++k) state.v.segment<3>(3 * k) = Eigen::Vector3d(1.0, 2.0, -3.0);
  const test::FemForces forces = system.forces(state);
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();
  for (int k = 0; k < 16; ++k) momentum += forces.momentum.segment<3>(3 * k);
  EXPECT_LE((momentum - 1e-3 * Eigen::Vector3d(1.0, 2.0, -3.0)).norm(), 1e-17);
  EXPECT_NEAR(system.energies(state).kinetic, 0.5e-3 * 14.0, 1e-17);
  std::vector<double> blocks(64 * 7);
  system.each([&](const auto& range) { system.kernels().mass(range, system.patch().X.data(), blocks.data()); });
  const Eigen::MatrixXd M = system.tangent(state, {.mass = 1.0, .stiffness = 0.0, .x_phi = 0.0, .phi_phi = 0.0});
  Eigen::MatrixXd assembled = Eigen::MatrixXd::Zero(16, 16);
  for (std::size_t e = 0; e < 7; ++e) {
    for (std::size_t ab = 0; ab < 64; ++ab) {
      assembled(system.patch().elements[e][ab / 8], system.patch().elements[e][ab % 8]) += 1e-3 * blocks[64 * e + ab];
    }
  }
  for (int a = 0; a < 16; ++a)
    for (int b = 0; b < 16; ++b) EXPECT_NEAR(M(4 * a + 1, 4 * b + 1), assembled(a, b), 1e-19);
}

TEST(Element, InversionIsReportedAndForcesStayFinite) {
  const FemSystem system(test::seven_elements(), test::full_material());
  FemState state{.x = system.patch().X, .v = {}, .phi = {}, .pressure = {}};
  state.x.segment<3>(24) << 0.9, 0.9, 0.9;
  const test::FemForces forces = system.forces(state);
  EXPECT_LT(forces.least, 0.0);
  EXPECT_EQ(forces.least, forces.least_J.minCoeff());
  EXPECT_LT(forces.least_J[0], 0.0);
  EXPECT_TRUE(forces.force.allFinite());
  state.x[5] = std::nan("");
  EXPECT_FALSE(system.forces(state).least > 0.0);
}

TEST(Element, PointValuesOfAHomogeneousStateAreThatState) {
  const fem::Material material{.elastic = fem::BonetWood{.mu = 0.233, .lambda = 10.0},
                               .electric = fem::IdealDielectric{.permittivity = 3.7 * test::eps0_si}};
  const FemSystem system(test::seven_elements(), material);
  Eigen::Matrix3d F;
  F << 1.1, 0.1, 0.0, -0.05, 0.95, 0.2, 0.0, 0.1, 1.2;
  const Eigen::Vector3d E(1e3, -2e3, 2e4);
  FemState state{.x = mapped(system.patch(), F, {1.0, 0.0, 2.0}), .v = {}, .phi = Eigen::VectorXd(16), .pressure = {}};
  for (int k = 0; k < 16; ++k) state.phi[k] = -E.dot(system.patch().node(k));
  state.pressure = Eigen::VectorXd::Constant(7, 0.3);
  std::vector<fem::PointValues> points(56);
  system.each([&](const auto& range) {
    system.kernels().point_values(system.laws(), range, state.fields(system.patch()), points.data());
  });
  const double J = F.determinant();
  const Eigen::Vector3d e = F.inverse().transpose() * E;
  const double eps = 3.7 * test::eps0_si;
  // Cauchy stress of Bonet and Wood, Maxwell's, and the element's pressure.
  const Eigen::Matrix3d cauchy =
      0.233 / J * (F * F.transpose() - Eigen::Matrix3d::Identity()) +
      (10.0 * std::log(J) / J + 0.3 - 0.5 * eps * e.squaredNorm()) * Eigen::Matrix3d::Identity() +
      eps * e * e.transpose();
  double volume = 0.0;
  for (const fem::PointValues& point : points) {
    volume += point.volume;
    EXPECT_NEAR(point.J, J, 1e-14);
    EXPECT_NEAR(point.cauchy[0], cauchy(0, 0), 1e-13);
    EXPECT_NEAR(point.cauchy[2], cauchy(2, 2), 1e-13);
    EXPECT_NEAR(point.cauchy[3], cauchy(1, 2), 1e-13);
    EXPECT_NEAR(point.cauchy[4], cauchy(0, 2), 1e-13);
    EXPECT_NEAR(point.cauchy[5], cauchy(0, 1), 1e-13);
    const Eigen::Matrix3d P = J * cauchy * F.inverse().transpose();
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(point.field[i], e[i], 1e-10);
      EXPECT_NEAR(point.D[i], eps * J * (F.inverse() * e)[i], 1e-20);
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(point.F[3 * i + k], F(i, k), 1e-14);
        EXPECT_NEAR(point.P[3 * i + k], P(i, k), 1e-13);
      }
    }
  }
  EXPECT_NEAR(volume, 1.0, 1e-15);
  const fem::PointValues mean = fem::mean_of(std::span<const fem::PointValues, 8>(points.data(), 8));
  EXPECT_NEAR(mean.cauchy[4], cauchy(0, 2), 1e-13);
  EXPECT_NEAR(mean.volume,
              points[0].volume + points[1].volume + points[2].volume + points[3].volume + points[4].volume +
                  points[5].volume + points[6].volume + points[7].volume,
              1e-16);
}

TEST(ElementKernels, AllocateNothing) {
  const FemSystem system(test::cube_of(3), test::full_material());
  std::mt19937 random(1);
  const FemState state = test::random_state(system.patch(), random);
  const fem::ElementFields fields = state.fields(system.patch());
  Eigen::VectorXd force = Eigen::VectorXd::Zero(3 * system.patch().n_nodes());
  std::vector<double> matrices(1024 * system.patch().elements.size());
  const fem::MaterialLaws laws = system.laws();
  const long before = test::n_allocations();
  for (const fem::ElementOrder::Chunk& chunk : system.order().chunks()) {
    const auto range = system.order().range(chunk);
    system.kernels().forces(laws, range, fields, {.force = force.data()});
    system.kernels().action(laws, range, fields, state.directions(), {.force = force.data()});
    system.kernels().dense(laws, range, fields, {}, matrices.data());
    static_cast<void>(system.kernels().energies(laws, range, fields));
  }
  EXPECT_EQ(test::n_allocations(), before);
}

}  // namespace
}  // namespace muldi
