#include "build/built_model.hpp"

#include "base/error.hpp"
#include "base/text.hpp"
#include "build/build_joints.hpp"
#include "build/build_solids.hpp"
#include "build/build_terms.hpp"
#include "build/place_bodies.hpp"
#include "multibody/rigid_body.hpp"

namespace muldi::build {
namespace {

std::vector<multibody::RigidBody> rigid_bodies(const scene::Scene& scene) {
  std::vector<multibody::RigidBody> bodies;
  for (const auto& entry : scene.bodies) {
    multibody::RigidBody body{.name = entry.name, .mass = entry.value.mass};
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        body.inertia(row, column) =
            entry.value.inertia.tensor[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
      }
    }
    bodies.push_back(std::move(body));
  }
  return bodies;
}

/// Loop-closing joints must close in the scene pose.
void check_loops(const scene::Scene& scene, const multibody::TreeManifold& manifold, double size,
                 std::vector<base::Diagnostic>& errors) {
  Eigen::VectorXd q(manifold.n_q());
  manifold.configuration(manifold.reference(), q);
  for (const int cut : manifold.tree().cut_joints) {
    const auto at = static_cast<std::size_t>(cut);
    double gap = 0.0;
    for (const model::Bilinear& row : multibody::constraint_rows(manifold.tree().joints[at], size)) {
      gap = std::max(gap, std::abs(row.value(q)));
    }
    if (gap <= closing_tolerance) continue;
    errors.push_back(scene::error_at(
        scene.joints[at].origin,
        base::format("the loop does not close at this joint: gap {:.6g} {}", gap * size, scene.units.length())));
  }
}

void add_multibody_observables(const scene::Scene& scene, BuiltModel& built) {
  auto& observables = built.model->observables;
  const auto add = [&](std::vector<model::Observable> more) {
    for (model::Observable& observable : more) observables.push_back(std::move(observable));
  };
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    add(multibody::body_observables(scene.bodies[i].name, static_cast<int>(i)));
  }
  if (!scene.joints.empty()) {
    built.joint_records = std::make_unique<multibody::JointRecords>(*built.manifold);
    add(built.joint_records->observables());
  }
  for (const scene::RecordedPoint& point : scene.record.points) {
    const std::string label = point.body.name + "." + point.point.name;
    observables.push_back(
        multibody::point_observable(label, body_index(scene, point.body.name), to_eigen(point.point.position)));
  }
}

void make_manifold(const scene::Scene& scene, const std::vector<multibody::Pose>& poses, double size,
                   BuiltModel& built) {
  std::vector<base::Diagnostic> errors;
  std::vector<multibody::Joint> joints = build_joints(scene, poses, size, {errors, built.notes});
  if (!errors.empty()) throw base::InputError(std::move(errors));
  auto tree = multibody::build_tree(static_cast<int>(scene.bodies.size()), std::move(joints));
  auto manifold = std::make_unique<multibody::TreeManifold>(std::move(tree), poses, free_lengths(scene), size);
  check_loops(scene, *manifold, size, errors);
  if (!errors.empty()) throw base::InputError(std::move(errors));
  built.manifold = manifold.get();
  built.model->manifold = std::move(manifold);
}

/// Refuses a solver with the words of its own error, at the place of the scene.
template <class Try>
void try_solver(const scene::Scene& scene, const Try& attempt) {
  try {
    attempt();
  } catch (const base::InputError& error) {
    std::vector<base::Diagnostic> errors = error.diagnostics();
    for (base::Diagnostic& found : errors) found.place = scene.origin.place;
    throw base::InputError(std::move(errors));
  }
}

/// The words of the wanted linear solvers, of bodies and of solids.
void choose_linear_solvers(const scene::Scene& scene, BuiltModel& built) {
  using scene::LinearSolver;
  const LinearSolver wanted = scene.solver.linear;
  std::string word = "auto";
  for (const auto& each : scene::words(wanted)) {
    if (each.value == wanted) word = each.word;
  }
  const bool of_solids = scene::is_of_solids(wanted);
  if (of_solids && built.solids.empty()) {
    base::Diagnostic wrong;
    wrong.place = scene.origin.place;
    wrong.path = "solver.linear";
    wrong.message = base::format(
        "'{}' is a solver of finite-element solids, and the scene has none: bodies take auto, dense, tree or bordered",
        word);
    throw base::InputError({wrong});
  }
  if (of_solids || wanted == LinearSolver::direct) {
    built.solid_linear = word;
    for (const fem::Solid* solid : built.solids) {
      try_solver(scene, [&] { solid->check_solver(word); });
    }
  } else if (wanted != LinearSolver::automatic) {
    built.linear = word;
    try_solver(scene, [&] { built.manifold->make_solver(*built.model->pattern, word); });
  }
}

}  // namespace

const multibody::TreeLink* BuiltModel::link_of_joint(std::size_t scene_index) const {
  for (const multibody::TreeLink& link : manifold->tree().links) {
    if (link.joint == static_cast<int>(scene_index)) return &link;
  }
  return nullptr;
}

BuiltModel build_model(const scene::Scene& scene) {
  BuiltModel built;
  built.model = std::make_unique<model::Model>();
  std::vector<base::Diagnostic> errors;
  const std::vector<multibody::Pose> poses = place_bodies(scene, errors);
  if (!errors.empty()) throw base::InputError(std::move(errors));
  const double size = scene_size(scene, poses);
  make_manifold(scene, poses, size, built);
  built.model->node_sizes.assign(scene.bodies.size(), 12);
  for (const auto& entry : scene.bodies) built.model->body_names.push_back(entry.name);
  built.model->node_sizes.resize(scene.bodies.size() + static_cast<std::size_t>(built.manifold->n_plain()), 1);

  ControlTable controls(scene);
  built.n_named_controls = controls.n_named();
  if (!scene.bodies.empty()) {
    built.model->terms.push_back(
        std::make_unique<multibody::RigidBodies>(rigid_bodies(scene), to_eigen(scene.gravity)));
  }
  built.assembled.gravity = scene.gravity != base::Vec3{};
  add_multibody_observables(scene, built);
  TermContext context{scene, poses, controls, built};
  add_muscles(context);
  add_springs(context);
  add_joint_forces(context);
  add_loads(context);
  add_solids(context);
  add_meshed_muscles(context);
  add_guards(context);
  model::add_supply_totals(electric_record(scene), *built.model);
  add_field_histories(scene, built);
  built.model->controls = controls.take();
  note_strong_fields(scene, built);
  built.model->bind();
  choose_linear_solvers(scene, built);
  return built;
}

}  // namespace muldi::build
