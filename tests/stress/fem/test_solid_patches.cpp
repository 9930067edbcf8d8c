/// Homogeneous coupled states on distorted cells: every law in every formulation (numerics 5 no. 11).
#include <gtest/gtest.h>

#include "support/figure.hpp"
#include "support/solid_system.hpp"

namespace muldi::fem {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double mu = 0.233;

std::vector<base::VariantOf<ElasticLaws>> elastic_laws() {
  return {NeoHookean{.mu = mu}, BonetWood{.mu = mu, .lambda = 10.0}, MooneyRivlin{.mu_1 = 0.2, .mu_2 = 0.033},
          Gent{.mu = mu, .J_m = 5.0}};
}

std::vector<base::VariantOf<ElectricLaws>> electric_laws() {
  const double eps = test::eps0_si;
  return {IdealDielectric{.permittivity = 3.7 * eps}, Vu{.c1 = 5e-8, .c2 = 1e-9, .eps0 = eps},
          Invariants{.c1 = -0.4 * eps, .c2 = -0.8 * eps, .c3 = 0.01 * eps, .eps0 = eps}};
}

/// Largest error inside a patch whose outside is put to x = F X, phi = -E.X: of positions (side 1) and of potentials
/// (relative).
double patch_error(const Material& material, Formulation formulation) {
  Matrix3d F;
  F << 1.05, 0.04, 0.0, -0.03, 0.97, 0.05, 0.02, 0.0, 1.03;
  if (formulation == Formulation::incompressible) F /= std::cbrt(F.determinant());
  const Vector3d E(1e3, -5e2, 5e3);
  test::SolidSystem system = test::solid_of(test::seven_elements());
  for (int n = 0; n < 8; ++n) {
    const Vector3d X = system.node(n);
    for (int i = 0; i < 3; ++i) {
      system.solid.displacements.push_back({.node = n, .component = i, .value = {.constant = (F * X - X)[i]}});
    }
    system.solid.potentials.push_back({.node = n, .value = {.constant = -E.dot(X)}});
  }
  system.fill(material, mu, formulation);
  const auto model = test::make_model(system);
  statics::StaticState state = test::static_start(*model);
  const statics::EquilibriumReport report = statics::EquilibriumSolver(*model, {.tolerance = 1e-12}).solve(state, {});
  EXPECT_TRUE(report.converged) << report.inadmissible;
  double error = 0.0;
  for (int n = 8; n < 16; ++n) {
    const Vector3d X = system.node(n);
    error = std::max({error, (state.q.segment<3>(3 * n) - F * X).lpNorm<Eigen::Infinity>(),
                      std::abs(state.y[n] + E.dot(X)) / E.norm()});
  }
  return error;
}

TEST(SolidPatches, KeepAHomogeneousStateUnderEveryLaw) {
  for (const Formulation formulation :
       {Formulation::displacement, Formulation::mean_dilatation, Formulation::incompressible}) {
    double largest = 0.0;
    for (const auto& elastic : elastic_laws()) {
      for (const auto& electric : electric_laws()) {
        Material material{.density = 1e-3, .elastic = elastic, .electric = electric};
        const bool has_volume = std::holds_alternative<BonetWood>(elastic);
        if (has_volume && formulation != Formulation::displacement) continue;
        if (!has_volume && formulation != Formulation::incompressible) material.volumetric = Quadratic{.kappa = 10.0};
        largest = std::max(largest, patch_error(material, formulation));
      }
    }
    const char* names[] = {"displacements", "mean dilatation", "exact incompressibility"};
    test::record_figure("11",
                        std::string("patch of distorted cells, all laws, ") + names[static_cast<int>(formulation)],
                        largest, 1e-12);
  }
}

}  // namespace
}  // namespace muldi::fem
