/// A manufactured coupled solution (numerics 3.5): L2 rate 2, H1 rate 1, in positions and potential.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "statics/equilibrium.hpp"
#include "support/figure.hpp"
#include "support/solid_system.hpp"

namespace muldi::fem {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double a = 0.1;
constexpr double b = -2e4;
constexpr double mu = 0.233;
constexpr double lambda = 10.0;

Vector3d position(const Vector3d& X) { return X + a * Vector3d(X[1] * X[1], X[2] * X[2], X[0] * X[0]); }

double potential(const Vector3d& X) { return b * (X[2] + 0.5 * X[0] * X[0] + 0.25 * X[0] * X[1]); }

Matrix3d gradient(const Vector3d& X) {
  Matrix3d F = Matrix3d::Identity();
  F(0, 1) = 2.0 * a * X[1];
  F(1, 2) = 2.0 * a * X[2];
  F(2, 0) = 2.0 * a * X[0];
  return F;
}

Vector3d field(const Vector3d& X) { return -b * Vector3d(X[0] + 0.25 * X[1], 0.25 * X[0], 1.0); }

/// First Piola-Kirchhoff stress and nominal electric displacement, written down apart from the program's laws.
struct Response {
  Matrix3d P = Matrix3d::Zero();
  Vector3d D = Vector3d::Zero();
};

struct Law {
  double permittivity = 0.0;  ///< of the term -1/2 eps J E.C^-1.E
  double c1 = 0.0;
  double c2 = 0.0;

  Response at(const Vector3d& X) const {
    const Matrix3d F = gradient(X);
    const Vector3d E = field(X);
    const double J = F.determinant();
    const Matrix3d f = F.inverse();
    const Vector3d e = f.transpose() * E;
    Response response;
    response.P = mu * (F - f.transpose()) + lambda * std::log(J) * f.transpose() + 2.0 * c2 * (F * E) * E.transpose() +
                 permittivity * J * (e * (f * e).transpose() - 0.5 * e.squaredNorm() * f.transpose());
    response.D = -2.0 * c1 * E - 2.0 * c2 * F.transpose() * (F * E) + permittivity * J * (f * e);
    return response;
  }
  /// Body force -Div P and charge density Div D, by differences of order 4.
  Eigen::Vector4d sources(const Vector3d& X) const {
    constexpr double h = 2e-3;
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (int k = 0; k < 3; ++k) {
      for (const auto& [offset, weight] : {std::pair{-2, 1.0}, {-1, -8.0}, {1, 8.0}, {2, -1.0}}) {
        const Response there = at(X + offset * h * Vector3d::Unit(k));
        sum.head<3>() -= weight / (12.0 * h) * there.P.col(k);
        sum[3] += weight / (12.0 * h) * there.D[k];
      }
    }
    return sum;
  }
};

const Law ideal = {.permittivity = 3.7 * test::eps0_si};
const Law legacy = {.permittivity = test::eps0_si, .c1 = 5e-8, .c2 = 1e-9};

TEST(Manufactured, SourcesAreThePublishedOnes) {
  const Vector3d X(0.3, 0.5, 0.7);
  const Eigen::Vector4d of_ideal = ideal.sources(X);
  EXPECT_LT((of_ideal.head<3>() - Vector3d(-0.0778437339482, -0.06130653495, -0.0657068618744)).norm(), 1e-10);
  EXPECT_NEAR(of_ideal[3], 4.45327514322e-07, 1e-15);
  const Eigen::Vector4d of_legacy = legacy.sources(X);
  EXPECT_LT((of_legacy.head<3>() - Vector3d(-0.78586936211, -0.478056519044, -0.929842489568)).norm(), 1e-10);
  EXPECT_NEAR(of_legacy[3], -0.00205679164121, 1e-12);
}

/// The cube of n^3 cells under the manufactured sources, with the solution on its boundary.
test::SolidSystem cube(const test::FemPatch& patch, const Law& law) {
  test::SolidSystem system = test::solid_of(patch);
  Material material = test::rubber(mu, lambda, Formulation::displacement);
  if (law.c2 != 0.0) {
    material.electric = Vu{.c1 = law.c1, .c2 = law.c2, .eps0 = law.permittivity};
  } else {
    material.electric = IdealDielectric{.permittivity = law.permittivity};
  }
  system.fill(material, mu, Formulation::displacement);
  const auto on_boundary = [](const Vector3d& X) { return X.minCoeff() < 1e-9 || X.maxCoeff() > 1.0 - 1e-9; };
  for (const int n : system.nodes(on_boundary)) {
    const Vector3d X = system.node(n);
    const Vector3d moved = position(X) - X;
    for (int i = 0; i < 3; ++i) {
      system.solid.displacements.push_back({.node = n, .component = i, .value = {.constant = moved[i]}});
    }
    system.solid.potentials.push_back({.node = n, .value = {.constant = potential(X)}});
  }
  const ElementSet elements(system.solid.X, system.solid.cells, system.solid.material_of_cell, system.solid.materials);
  std::vector<PointValues> points(8 * system.solid.cells.size());
  elements.point_values({.x = system.solid.X.data()}, points.data());
  std::vector<double> at_points;
  for (const PointValues& point : points) {
    const Eigen::Vector4d sources = law.sources(Eigen::Map<const Vector3d>(point.X));
    at_points.insert(at_points.end(), sources.data(), sources.data() + 4);
  }
  Eigen::Matrix4Xd nodal = Eigen::Matrix4Xd::Zero(4, system.n_nodes());
  elements.loads(at_points.data(), 4, nodal.data());
  DeadLoad body{.nodes = {}, .unit = {}, .value = {.constant = 1.0}};
  SurfaceCharge charge{.nodes = {}, .unit = {}, .value = {.constant = 1.0}};
  for (int n = 0; n < system.n_nodes(); ++n) {
    body.nodes.push_back(n);
    body.unit.push_back(nodal.col(n).head<3>());
    charge.nodes.push_back(n);
    charge.unit.push_back(nodal(3, n));
  }
  system.solid.dead_loads.push_back(body);
  system.solid.surface_charges.push_back(charge);
  return system;
}

/// Errors of positions (mm) and potential (V): norms of the values and of the gradients.
struct Errors {
  double x = 0.0, phi = 0.0, gradient_x = 0.0, gradient_phi = 0.0;
};

/// Shape functions of the corners of a cell (VTK order) and their derivatives by xi in [-1, 1]^3.
void shapes(const Vector3d& xi, Eigen::Matrix<double, 8, 1>& N, Eigen::Matrix<double, 8, 3>& dN) {
  constexpr int sign[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                              {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
  for (int k = 0; k < 8; ++k) {
    const double u = 1 + sign[k][0] * xi[0];
    const double v = 1 + sign[k][1] * xi[1];
    const double w = 1 + sign[k][2] * xi[2];
    N[k] = u * v * w / 8;
    dN.row(k) << sign[k][0] * v * w / 8, sign[k][1] * u * w / 8, sign[k][2] * u * v / 8;
  }
}

/// 27 points a cell: at the eight points of the element the gradients are more accurate than elsewhere.
Errors errors_of(const test::SolidSystem& system, const Eigen::VectorXd& x, const Eigen::VectorXd& phi) {
  const double root = std::sqrt(0.6);
  const double at[3] = {-root, 0.0, root};
  const double weight[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
  Errors sum;
  Eigen::Matrix<double, 8, 1> N;
  Eigen::Matrix<double, 8, 3> dN;
  for (const auto& cell : system.solid.cells) {
    Eigen::Matrix<double, 8, 7> nodal;  // X, x, phi
    for (int k = 0; k < 8; ++k) {
      const int n = cell[static_cast<std::size_t>(k)];
      nodal.row(k) << system.node(n).transpose(), x.segment<3>(3 * n).transpose(), phi[n];
    }
    for (int point = 0; point < 27; ++point) {
      const int i = point % 3;
      const int j = point / 3 % 3;
      const int k = point / 9;
      shapes({at[i], at[j], at[k]}, N, dN);
      const Matrix3d jacobian = nodal.leftCols<3>().transpose() * dN;
      const Eigen::Matrix<double, 8, 3> by_X = dN * jacobian.inverse();
      const double dV = weight[i] * weight[j] * weight[k] * jacobian.determinant();
      const Eigen::Matrix<double, 7, 1> values = nodal.transpose() * N;
      const Vector3d X = values.head<3>();
      const Matrix3d F = nodal.middleCols<3>(3).transpose() * by_X;
      const Vector3d E = -by_X.transpose() * nodal.col(6);
      sum.x += dV * (values.segment<3>(3) - position(X)).squaredNorm();
      sum.phi += dV * std::pow(values[6] - potential(X), 2);
      sum.gradient_x += dV * (F - gradient(X)).squaredNorm();
      sum.gradient_phi += dV * (E - field(X)).squaredNorm();
    }
  }
  return {std::sqrt(sum.x), std::sqrt(sum.phi), std::sqrt(sum.gradient_x), std::sqrt(sum.gradient_phi)};
}

Errors solved(const test::FemPatch& patch, const Law& law) {
  const test::SolidSystem system = cube(patch, law);
  const auto model = test::make_model(system);
  statics::StaticState state = test::static_start(*model);
  for (int n = 0; n < system.n_nodes(); ++n) {
    state.q.segment<3>(3 * n) = position(system.node(n));
    state.y[n] = potential(system.node(n));
  }
  statics::EquilibriumSolver solver(*model, {});
  const statics::EquilibriumReport report = solver.solve(state, {});
  EXPECT_TRUE(report.converged) << report.inadmissible;
  return errors_of(system, solver.configuration(), solver.stage());
}

test::FemPatch regular(int n) {
  const test::SolidSystem box = test::solid_box({n, n, n}, {0, 0, 0}, {1, 1, 1});
  return {.elements = box.solid.cells, .X = box.solid.X};
}

void expect_rates(const Law& law) {
  const Errors coarse = solved(regular(5), law);
  const Errors fine = solved(regular(10), law);
  const auto rate = [&](double Errors::*of) { return std::log2(coarse.*of / fine.*of); };
  test::record_near("28", "manufactured solution, rate of positions", rate(&Errors::x), 2.0, 0.1);
  test::record_near("28", "manufactured solution, rate of potentials", rate(&Errors::phi), 2.0, 0.1);
  test::record_near("28", "manufactured solution, rate of gradients", rate(&Errors::gradient_x), 1.0, 0.1);
  test::record_near("28", "manufactured solution, rate of fields", rate(&Errors::gradient_phi), 1.0, 0.1);
  std::cout << "rates: x " << rate(&Errors::x) << ", phi " << rate(&Errors::phi) << ", F " << rate(&Errors::gradient_x)
            << ", E " << rate(&Errors::gradient_phi) << '\n';
}

TEST(Manufactured, ConvergesWithTheIdealDielectric) { expect_rates(ideal); }

TEST(Manufactured, ConvergesWithTheLegacyLaw) { expect_rates(legacy); }

// Nodes moved by up to a fifth of a side change the constant less than three times (numerics 5 no. 28).
TEST(Manufactured, ToleratesDistortedCells) {
  const Errors straight = solved(regular(6), ideal);
  const Errors distorted = solved(test::cube_of(6), ideal);
  for (const auto of : {&Errors::x, &Errors::phi, &Errors::gradient_x, &Errors::gradient_phi}) {
    test::record_figure("28", "20 % distortion, largest error over that of the straight mesh",
                        distorted.*of / straight.*of, 3.0);
    EXPECT_GT(distorted.*of, straight.*of);
    std::cout << "distorted over straight: " << distorted.*of / straight.*of << '\n';
  }
}

}  // namespace
}  // namespace muldi::fem
