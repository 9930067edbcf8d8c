#include "fem/solid/step_bound.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace muldi::fem {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int edges_of_cell[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                      {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
/// Growth a step that a run does not live to see.
constexpr double slow_growth = 0.01;
/// Of its edge: a cell that is shorter pulls in or is crushed, whatever the step.
constexpr double crushed = 0.5;

double shortest_edge(const std::array<int, 8>& cell, const Eigen::Ref<const VectorXd>& x) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& edge : edges_of_cell) {
    const Index a = 3 * static_cast<Index>(cell[static_cast<std::size_t>(edge[0])]);
    const Index b = 3 * static_cast<Index>(cell[static_cast<std::size_t>(edge[1])]);
    least = std::min(least, (x.segment<3>(a) - x.segment<3>(b)).squaredNorm());
  }
  return std::sqrt(least);
}

const Material& material_of(const Solid& solid, int cell) {
  const auto at = static_cast<std::size_t>(solid.data().material_of_cell[static_cast<std::size_t>(cell)]);
  return solid.data().materials[at];
}

double pressure_of(const Solid& solid, int cell, const VectorXd& q, const VectorXd& y) {
  if (solid.is_incompressible()) return -solid.pressures(y)[cell];
  return -solid.dilation(cell, solid.volumes_at(solid.positions(q)).J[cell]).pressure;
}

StepBound bound_of_cells(const Solid& solid, const VectorXd& q, const VectorXd& y) {
  const ElementSet& elements = solid.elements();
  const auto x = solid.positions(q);
  StepBound least;
  for (int cell = 0; cell < elements.n_cells(); ++cell) {
    const double stress = std::abs(pressure_of(solid, cell, q, y));
    if (stress == 0.0) continue;
    const std::array<int, 8>& nodes = elements.cells()[static_cast<std::size_t>(cell)];
    const double edge = shortest_edge(nodes, x);
    if (edge < crushed * shortest_edge(nodes, elements.reference())) continue;
    const double step = edge * std::sqrt(material_of(solid, cell).density / stress);
    // Round-off does not choose between equal cells.
    constexpr double clearly = 1.0 - 1e-6;
    if (step < clearly * least.step) least = {.cell = cell, .step = step, .length = edge, .stress = stress};
  }
  return least;
}

/// An alternating error of the size of a cell grows by delta a step, C dt delta = 4 M ((dt/bound)^2 - 1), with the rate
/// C/M = (eta/2 rho) (pi/h)^2 of the shear viscosity.
bool is_braked(const Solid& solid, const StepBound& bound, double dt) {
  const Material& material = material_of(solid, bound.cell);
  if (!material.viscous) return false;
  const double wave = std::numbers::pi / bound.length;
  const double rate = 0.5 * std::get<KelvinVoigt>(*material.viscous).viscosity / material.density * wave * wave;
  const double excess = dt / bound.step * dt / bound.step - 1.0;
  return 4.0 * excess < slow_growth * rate * dt;
}

/// Edge of the square whose second moment is the least of the reference volume.
double thickness(const std::vector<PointValues>& points) {
  double volume = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const PointValues& point : points) {
    const Eigen::Map<const Eigen::Vector3d> X(point.X);
    volume += point.volume;
    first += point.volume * X;
    second += point.volume * X * X.transpose();
  }
  const Eigen::Matrix3d moments = second / volume - first * first.transpose() / (volume * volume);
  return std::sqrt(12.0 * std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvalues()[0]));
}

/// Means over the solid: the larger one of Maxwell's stress e.d and twice the pressure.
StepBound bound_of_thickness(const Solid& solid, const VectorXd& q, const VectorXd& y, int cell) {
  const ElementSet& elements = solid.elements();
  ElementFields fields{.x = solid.positions(q).data()};
  VectorXd phi;
  if (solid.unknowns().has_field()) {
    phi = solid.potentials(y);
    fields.phi = phi.data();
  }
  std::vector<PointValues> points(8 * static_cast<std::size_t>(elements.n_cells()));
  elements.point_values(fields, points.data());
  double maxwell = 0.0;
  double pressure = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PointValues& point = points[i];
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> F(point.F);
    const Eigen::Map<const Eigen::Vector3d> e(point.field);
    const Eigen::Map<const Eigen::Vector3d> D(point.D);
    maxwell += point.volume * e.dot(F * D) / point.J;
    pressure += point.volume * std::abs(pressure_of(solid, static_cast<int>(i / 8), q, y));
  }
  const double stress = std::max(maxwell, 2.0 * pressure) / solid.cell_volumes().sum();
  const double length = thickness(points);
  return {.cell = cell,
          .step = length * std::sqrt(material_of(solid, cell).density / stress),
          .length = length,
          .stress = stress};
}

}  // namespace

StepBound exceeded_bound(const Solid& solid, const VectorXd& q, const VectorXd& y, double dt) {
  if (!solid.has_pressures()) return {};
  StepBound bound = bound_of_cells(solid, q, y);
  if (bound.cell >= 0 && dt > bound.step && is_braked(solid, bound, dt)) {
    bound = bound_of_thickness(solid, q, y, bound.cell);
  }
  return dt > bound.step ? bound : StepBound{};
}

}  // namespace muldi::fem
