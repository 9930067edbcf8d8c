#include "support/solid_system.hpp"

#include <cmath>
#include <stdexcept>

#include "multibody/tree_manifold.hpp"
#include "variational/node_values.hpp"

namespace muldi::test {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

}  // namespace

Where plane(int component, double value) {
  return [component, value](const Vector3d& X) { return std::abs(X[component] - value) < 1e-9; };
}

std::vector<int> SolidSystem::nodes(const Where& where) const {
  std::vector<int> found;
  for (int n = 0; n < n_nodes(); ++n) {
    if (where(node(n))) found.push_back(n);
  }
  return found;
}

int SolidSystem::node_at(const Vector3d& X) const {
  const std::vector<int> found = nodes([&](const Vector3d& at) { return (at - X).norm() < 1e-9; });
  if (found.size() != 1) throw std::runtime_error("no single node at the position");
  return found[0];
}

void SolidSystem::hold(const Where& where, int component, fem::Value value) {
  for (const int n : nodes(where)) solid.displacements.push_back({.node = n, .component = component, .value = value});
}

void SolidSystem::hold_lower_faces() {
  const Eigen::Map<const Eigen::Matrix3Xd> X(solid.X.data(), 3, n_nodes());
  const Vector3d lower = X.rowwise().minCoeff();
  for (int i = 0; i < 3; ++i) hold(plane(i, lower[i]), i);
}

void SolidSystem::set_potential(const Where& where, fem::Value value) {
  for (const int n : nodes(where)) solid.potentials.push_back({.node = n, .value = value});
}

void SolidSystem::fill(const fem::Material& material, double shear_modulus, fem::Formulation formulation) {
  solid.materials = {material};
  solid.shear_moduli = {shear_modulus};
  solid.material_of_cell.assign(solid.cells.size(), 0);
  solid.formulation = formulation;
}

fem::Value SolidSystem::control(base::TimeFunction function) {
  controls.push_back({.name = "control", .unit = {}, .function = std::move(function)});
  return {.control = static_cast<int>(controls.size()) - 1};
}

SolidSystem solid_box(std::array<int, 3> cells, const Vector3d& lower, const Vector3d& upper) {
  SolidSystem system;
  const auto [nx, ny, nz] = cells;
  const auto index = [nx = nx, ny = ny](int i, int j, int k) { return (k * (ny + 1) + j) * (nx + 1) + i; };
  system.solid.name = "box";
  system.solid.X.resize(3 * static_cast<Eigen::Index>(nx + 1) * (ny + 1) * (nz + 1));
  const Vector3d sides = upper - lower;
  for (int k = 0; k <= nz; ++k) {
    for (int j = 0; j <= ny; ++j) {
      for (int i = 0; i <= nx; ++i) {
        const Vector3d at(static_cast<double>(i) / nx, static_cast<double>(j) / ny, static_cast<double>(k) / nz);
        system.solid.X.segment<3>(3 * static_cast<Eigen::Index>(index(i, j, k))) = lower + sides.cwiseProduct(at);
      }
    }
  }
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      for (int i = 0; i < nx; ++i) {
        const int a = index(i, j, k);
        const int b = index(i, j + 1, k);
        const int above = index(0, 0, 1);
        system.solid.cells.push_back({a, a + 1, b + 1, b, a + above, a + 1 + above, b + 1 + above, b + above});
      }
    }
  }
  return system;
}

SolidSystem solid_of(const FemPatch& patch) {
  SolidSystem system;
  system.solid.name = "patch";
  system.solid.X = patch.X;
  system.solid.cells = patch.elements;
  return system;
}

fem::Material rubber(double mu, double lambda, fem::Formulation formulation) {
  fem::Material material{.density = 1e-3, .elastic = fem::NeoHookean{.mu = mu}};
  if (formulation == fem::Formulation::displacement) material.elastic = fem::BonetWood{.mu = mu, .lambda = lambda};
  if (formulation == fem::Formulation::mean_dilatation) {
    material.volumetric = fem::Quadratic{.kappa = lambda + 2.0 / 3.0 * mu};
  }
  return material;
}

std::unique_ptr<model::Model> make_model(const SolidSystem& system) {
  auto model = std::make_unique<model::Model>();
  model->controls = system.controls;
  model->manifold = std::make_unique<multibody::TreeManifold>(
      multibody::build_tree(0, {}), std::vector<multibody::Pose>{}, std::vector<double>{}, 1.0);
  model->substructures.push_back(std::make_unique<fem::Solid>(system.solid));
  model->bind();
  return model;
}

const fem::Solid& solid_in(const model::Model& model) {
  return dynamic_cast<const fem::Solid&>(*model.substructures.at(0));
}

statics::StaticState static_start(const model::Model& model) {
  statics::StaticState state{.x = model.manifold->reference(),
                             .multipliers = VectorXd::Zero(model.manifold->n_loop_rows()),
                             .q = VectorXd::Zero(model.n_q()),
                             .y = VectorXd::Zero(model.n_y())};
  for (const auto& part : model.substructures) part->start(state.q, state.y);
  return state;
}

variational::State moving_state(const model::Model& model, double dt, const VectorXd& v) {
  const statics::StaticState rest = static_start(model);
  std::vector<double> u(model.controls.size());
  model.evaluate_controls(0.0, u);
  variational::State state;
  state.x = rest.x;
  state.q = rest.q;
  state.y = rest.y;
  state.p = VectorXd::Zero(model.n_q());
  state.advance = VectorXd::Zero(model.n_q());
  if (v.size() > 0) {
    state.advance = dt * v;
    variational::NodeEvaluator(model, "auto").momentum_of(state.q, v, u, state.p);
  }
  state.increment = VectorXd::Zero(model.manifold->n_v());
  state.multipliers = VectorXd::Zero(model.manifold->n_loop_rows());
  return state;
}

VectorXd spin(const SolidSystem& system, const Vector3d& omega) {
  VectorXd v(system.solid.X.size());
  for (int n = 0; n < system.n_nodes(); ++n)
    v.segment<3>(3 * static_cast<Eigen::Index>(n)) = omega.cross(system.node(n));
  return v;
}

}  // namespace muldi::test
