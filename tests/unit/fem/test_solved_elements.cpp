/// Small systems of elements solved by Newton: the coupled patch test and homogeneous closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "support/fem_patch.hpp"

namespace muldi {
namespace {

using test::FemState;
using test::FemSystem;

/// Newton on the free unknowns (4 k + i) until the residual stops to fall; its last norm, in units of mu and eps E.
double solve(const FemSystem& system, const std::vector<int>& free, FemState& state) {
  const Eigen::Index n = static_cast<Eigen::Index>(free.size());
  double norm = 0.0;
  for (int iteration = 0; iteration < 12; ++iteration) {
    const test::FemForces forces = system.forces(state);
    const Eigen::VectorXd all = test::joined(forces.force, forces.charge);
    const Eigen::MatrixXd K = system.tangent(state, {});
    Eigen::VectorXd r(n);
    Eigen::MatrixXd A(n, n);
    for (Eigen::Index a = 0; a < n; ++a) {
      const int row = free[static_cast<std::size_t>(a)];
      const double row_size = row % 4 == 3 ? 1e4 : 1.0;
      r[a] = row_size * all[row];
      for (Eigen::Index b = 0; b < n; ++b) {
        const int column = free[static_cast<std::size_t>(b)];
        A(a, b) = row_size * K(row, column) * (column % 4 == 3 ? 1e4 : 1.0);
      }
    }
    norm = r.cwiseAbs().maxCoeff();
    const Eigen::VectorXd step = A.partialPivLu().solve(r);
    for (Eigen::Index a = 0; a < n; ++a) {
      const int unknown = free[static_cast<std::size_t>(a)];
      if (unknown % 4 == 3) {
        state.phi[unknown / 4] -= 1e4 * step[a];
      } else {
        state.x[3 * (unknown / 4) + unknown % 4] -= step[a];
      }
    }
  }
  return norm;
}

TEST(PatchTest, DistortedElementsKeepAHomogeneousCoupledState) {
  for (const base::VariantOf<fem::ElectricLaws>& electric :
       {base::VariantOf<fem::ElectricLaws>(fem::IdealDielectric{.permittivity = 3.7 * test::eps0_si}),
        base::VariantOf<fem::ElectricLaws>(fem::Vu{.c1 = 5e-8, .c2 = 1e-9, .eps0 = test::eps0_si})}) {
    const FemSystem system(test::seven_elements(),
                           {.elastic = fem::BonetWood{.mu = 0.233, .lambda = 10.0}, .electric = electric});
    Eigen::Matrix3d F;
    F << 1.05, 0.04, 0.0, -0.03, 0.97, 0.05, 0.02, 0.0, 1.03;
    const Eigen::Vector3d E(1e3, -5e2, 5e3);
    FemState exact{.x = Eigen::VectorXd(48), .v = {}, .phi = Eigen::VectorXd(16), .pressure = {}};
    for (int k = 0; k < 16; ++k) {
      exact.x.segment<3>(3 * k) = F * system.patch().node(k);
      exact.phi[k] = -E.dot(system.patch().node(k));
    }
    const test::FemForces forces = system.forces(exact);
    EXPECT_LE(forces.force.tail(24).cwiseAbs().maxCoeff(), 1e-14 * forces.force.cwiseAbs().maxCoeff() + 1e-15);
    EXPECT_LE(forces.charge.tail(8).cwiseAbs().maxCoeff(), 1e-13 * forces.charge.cwiseAbs().maxCoeff());

    std::mt19937 random(1);
    FemState state = exact;
    state.x.tail(24) += test::random_values(random, 24, 0.02);
    state.phi.tail(8) += test::random_values(random, 8, 100.0);
    std::vector<int> inner;
    for (int unknown = 32; unknown < 64; ++unknown) inner.push_back(unknown);
    solve(system, inner, state);
    EXPECT_LE((state.x - exact.x).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LE((state.phi - exact.phi).cwiseAbs().maxCoeff(), 1e-12 * 5e3);

    // The reactions on a face are P N A: face x = 1 has the nodes 1, 2, 5, 6.
    std::vector<fem::PointValues> points(56);
    system.each([&](const auto& range) {
      system.kernels().point_values(system.laws(), range, exact.fields(system.patch()), points.data());
    });
    const Eigen::Vector3d opposite = forces.force.segment<3>(0) + forces.force.segment<3>(9) +
                                     forces.force.segment<3>(12) + forces.force.segment<3>(21);
    const Eigen::Vector3d face = forces.force.segment<3>(3) + forces.force.segment<3>(6) + forces.force.segment<3>(15) +
                                 forces.force.segment<3>(18);
    EXPECT_LE((face + opposite).norm(), 1e-14);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(face[i], points[0].P[3 * i], 1e-13);
  }
}

struct Homogeneous {
  std::string name;
  double lambda;
  double field;
  bool legacy;
  double stretch;
  double side;
};

class FreeCube : public testing::TestWithParam<Homogeneous> {};
// numerics 3.1: Bonet-Wood, mu = .233, eps_r = 3.7 or the law of the thesis with c2 = 1e-9.
INSTANTIATE_TEST_SUITE_P(Published, FreeCube,
                         testing::Values(Homogeneous{"Soft10", 10.0, 1e4, false, 0.995286518416, 1.00239205086},
                                         Homogeneous{"Soft30", 10.0, 3e4, false, 0.953815631753, 1.02417056003},
                                         Homogeneous{"Stiff10", 999.8, 1e4, false, 0.99526877817, 1.00237431197},
                                         Homogeneous{"Stiff30", 999.8, 3e4, false, 0.953656047401, 1.02401231034},
                                         Homogeneous{"LegacySoft", 10.0, 6e3, true, 0.913042644524, 1.04541474562},
                                         Homogeneous{"LegacyStiff", 999.8, 6e3, true, 0.913689475368, 1.04615479775}),
                         [](const auto& of) { return of.param.name; });

TEST_P(FreeCube, ContractsAsTheClosedForm) {
  const Homogeneous& of = GetParam();
  fem::Material material{.elastic = fem::BonetWood{.mu = 0.233, .lambda = of.lambda}};
  if (of.legacy) {
    material.electric = fem::Vu{.c1 = 5e-8, .c2 = 1e-9, .eps0 = test::eps0_si};
  } else {
    material.electric = fem::IdealDielectric{.permittivity = 3.7 * test::eps0_si};
  }
  const FemSystem system(test::unit_cube(), material);
  FemState state{.x = system.patch().X, .v = {}, .phi = Eigen::VectorXd(8), .pressure = {}};
  std::vector<int> free;
  for (int k = 0; k < 8; ++k) {
    // Rollers on the faces x = 0, y = 0, z = 0; the rest is free, the potential given.
    for (int i = 0; i < 3; ++i) {
      if (system.patch().node(k)[i] > 0.5) free.push_back(4 * k + i);
    }
  }
  for (int step = 1; step <= 4; ++step) {
    for (int k = 0; k < 8; ++k) state.phi[k] = -0.25 * step * of.field * system.patch().node(k)[2];
    EXPECT_LE(solve(system, free, state), 1e-12);
  }
  // Twelve printed digits.
  EXPECT_NEAR(state.x[3 * 6 + 2], of.stretch, 1e-11);
  EXPECT_NEAR(state.x[3 * 6], of.side, 1e-11);
  EXPECT_NEAR(state.x[3 * 6 + 1], of.side, 1e-11);
}

}  // namespace
}  // namespace muldi
