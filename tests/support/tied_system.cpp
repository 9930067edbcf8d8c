#include "support/tied_system.hpp"

#include <algorithm>

#include "math/rotation.hpp"
#include "multibody/registry.hpp"
#include "variational/node_values.hpp"

namespace muldi::test {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using multibody::ground;

bool is_held(const fem::SolidDescription& solid, int node) {
  return std::any_of(solid.displacements.begin(), solid.displacements.end(),
                     [node](const auto& said) { return said.node == node; }) ||
         std::any_of(solid.ties.begin(), solid.ties.end(), [node](const auto& tie) { return tie.node == node; });
}

}  // namespace

void TiedSystem::tie(fem::SolidDescription& solid, const Where& where, int body) const {
  int host = -1;
  if (body == ground) {
    solid.tied_to_ground = true;
  } else {
    host = static_cast<int>(solid.hosts.size());
    solid.hosts.push_back(
        {.name = rigid.bodies[static_cast<std::size_t>(body)].name, .pattern_node = body, .first = 12 * body});
  }
  for (int node = 0; node < static_cast<int>(solid.X.size() / 3); ++node) {
    const Vector3d X = solid.X.segment<3>(3 * static_cast<Eigen::Index>(node));
    if (!where(X) || is_held(solid, node)) continue;
    if (body != ground) {
      solid.ties.push_back({.node = node, .host = host, .xi = rigid.end_at(body, X).local});
      continue;
    }
    for (int i = 0; i < 3; ++i) solid.displacements.push_back({.node = node, .component = i});
  }
}

std::unique_ptr<model::Model> make_model(const TiedSystem& system) {
  auto model = unbound_model(system.rigid);
  for (const auto& solid : system.solids) model->substructures.push_back(std::make_unique<fem::Solid>(solid));
  model->bind();
  return model;
}

const fem::Solid& solid_of(const model::Model& model, std::size_t index) {
  return dynamic_cast<const fem::Solid&>(*model.substructures.at(index));
}

variational::State tied_state(const model::Model& model, double dt, const VectorXd& w, const VectorXd& v) {
  const model::Manifold& manifold = *model.manifold;
  variational::State state;
  state.x = manifold.reference();
  state.q = VectorXd::Zero(model.n_q());
  state.y = VectorXd::Zero(model.n_y());
  manifold.configuration(state.x, state.q);
  for (const auto& part : model.substructures) part->start(state.q, state.y);
  const auto frame = manifold.make_frame();
  manifold.update(state.x, state.q, *frame);
  VectorXd velocity = v.size() > 0 ? v : VectorXd(VectorXd::Zero(model.n_q()));
  velocity.head(manifold.n_q()).setZero();
  manifold.lift(*frame, w, velocity);
  for (const auto& part : model.substructures) part->follow({}, velocity);
  std::vector<double> u(model.controls.size());
  model.evaluate_controls(0.0, u);
  state.p = velocity;
  variational::NodeEvaluator(model, "auto").momentum_of(state.q, velocity, u, state.p);
  state.increment = dt * w;
  state.multipliers = VectorXd::Zero(manifold.n_loop_rows());
  state.advance = dt * velocity;
  return state;
}

fem::SolidDescription muscle(const std::string& name, const Muscle& how, double x0, std::array<double, 2> z) {
  const double half = 0.5 * how.side;
  SolidSystem box = solid_box(how.cells, Vector3d(x0 - half, -half, z[0]), Vector3d(x0 + half, half, z[1]));
  fem::Material material = rubber(how.mu, 10.0 * how.mu, how.formulation);
  if (how.viscosity > 0.0) material.viscous = fem::KelvinVoigt{.viscosity = how.viscosity};
  if (how.permittivity > 0.0) material.electric = fem::IdealDielectric{.permittivity = how.permittivity};
  box.fill(material, how.mu, how.formulation);
  const double layer = (z[1] - z[0]) / how.cells[2];
  for (int k = 0; k <= how.cells[2] && how.permittivity > 0.0; ++k) {
    fem::Value value;
    if (k % 2 == 1) value = {.control = how.field, .factor = layer};
    box.set_potential(plane(2, z[0] + k * layer), value);
  }
  box.solid.name = name;
  return box.solid;
}

TiedSystem hinge_with_muscle(const Muscle& how) {
  TiedSystem system;
  system.rigid.length = 20.0;
  system.rigid.add_body(2.0, Vector3d(60.0, 50.0, 40.0), {.position = Vector3d(0.0, 0.0, 14.0)});
  system.rigid.connect(multibody::Revolute::pattern, {ground, 0}, Vector3d(0.0, 0.0, 4.0),
                       math::triad_about(Vector3d::UnitY()));
  fem::SolidDescription bar = muscle("bar", how, 6.0, {0.0, 8.0});
  system.tie(bar, plane(2, 0.0), ground);
  system.tie(bar, plane(2, 8.0), 0);
  system.solids.push_back(bar);
  return system;
}

TiedSystem chain_with_muscles(int n_joints, Muscle how) {
  constexpr double length = 36.0;
  constexpr double period = 46.0;
  TiedSystem system;
  system.rigid.length = period * n_joints;
  for (int i = 0; i < n_joints; ++i) {
    const double foot = period * i;
    const int body = system.rigid.add_body(20.0, Vector3d(2500.0, 2500.0, 3000.0),
                                           {.position = Vector3d(0.0, 0.0, foot + length + 5.0)});
    system.rigid.connect(multibody::Revolute::pattern, {body - 1, body}, Vector3d(0.0, 0.0, foot + 0.5 * length),
                         math::triad_about(Vector3d::UnitY()));
  }
  for (int i = 0; i < n_joints; ++i) {
    const double foot = period * i;
    for (int side = 0; side < 2; ++side) {
      how.field = side;
      fem::SolidDescription bar = muscle((side == 0 ? "right" : "left") + std::to_string(i), how,
                                         side == 0 ? 12.0 : -12.0, {foot, foot + length});
      system.tie(bar, plane(2, foot), i - 1);
      system.tie(bar, plane(2, foot + length), i);
      system.solids.push_back(bar);
    }
  }
  return system;
}

}  // namespace muldi::test
