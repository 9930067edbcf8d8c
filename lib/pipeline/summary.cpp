#include "pipeline/summary.hpp"

#include <algorithm>

#include "base/text.hpp"
#include "pipeline/required_size.hpp"

namespace muldi::pipeline {
namespace {

std::string chains_text(const scene::Scene& scene, const build::BuiltModel& built) {
  const multibody::KinematicTree& tree = built.manifold->tree();
  std::string text;
  for (std::size_t c = 0; c < tree.chains.size(); ++c) {
    const multibody::Chain& chain = tree.chains[c];
    std::string order;
    const std::size_t shown = std::min<std::size_t>(chain.bodies.size(), 8);
    for (std::size_t i = 0; i < shown; ++i) {
      order += (i == 0 ? "" : " ") + scene.bodies[static_cast<std::size_t>(chain.bodies[i])].name;
    }
    if (shown < chain.bodies.size()) order += base::format(" and {} more", chain.bodies.size() - shown);
    text += base::format("  chain {}: {}, {} cut joint(s): {}\n", c + 1, chain.anchored ? "anchored" : "free",
                         chain.n_cut_joints, order);
  }
  for (const int cut : tree.cut_joints) {
    text += base::format("  cut joint: {}\n", tree.joints[static_cast<std::size_t>(cut)].name);
  }
  if (const int n_redundant = built.manifold->n_loop_rows() - built.manifold->n_c(); n_redundant > 0) {
    text += base::format("  redundant loop constraints left out: {}\n", n_redundant);
  }
  return text;
}

std::string yes_no(bool yes) { return yes ? "yes" : "no"; }

constexpr double mebi = 1048576.0;

/// The kinds of equations of a solid that a run solves.
std::vector<model::Linearisation> linearisations(const scene::Scene& scene) {
  using model::Linearisation;
  std::vector<Linearisation> kinds;
  if (scene.dynamics) kinds.insert(kinds.end(), {Linearisation::step, Linearisation::velocity});
  if (scene.statics || scene.initial.from.kind == scene::InitialFrom::Kind::static_equilibrium) {
    kinds.push_back(Linearisation::rest);
  }
  return kinds;
}

/// The largest solver of a solid, and the bytes of all of them.
model::SolverSize solver_size(const scene::Scene& scene, const fem::Solid& solid, const std::string& name) {
  model::SolverSize sum;
  double largest = 0.0;
  for (const model::Linearisation kind : linearisations(scene)) {
    const model::SolverSize one = solid.solver_size(kind, name);
    if (one.factor_bytes >= largest) sum.solver = one.solver;
    largest = std::max(largest, one.factor_bytes);
    sum.matrix_bytes += one.matrix_bytes;
    sum.factor_bytes += one.factor_bytes;
  }
  return sum;
}

std::string word_of(fem::Formulation formulation) {
  switch (formulation) {
    case fem::Formulation::displacement:
      return "displacement";
    case fem::Formulation::mean_dilatation:
      return "mean_dilatation";
    case fem::Formulation::incompressible:
      return "incompressible";
    case fem::Formulation::incompressible_direct:
      break;
  }
  return "incompressible_direct";
}

std::string potentials_text(const fem::SolidUnknowns& unknowns) {
  if (!unknowns.has_field()) return "no potentials (none is prescribed)";
  if (unknowns.n_free_potentials() == 0) return "no unknown potentials (all are prescribed)";
  return base::format("unknown potentials {}", unknowns.n_free_potentials());
}

/// Positions of a tied solid that are no unknowns.
std::string ties_text(const fem::Solid& solid) {
  const fem::SolidDescription& data = solid.data();
  std::string text;
  if (!data.bonds.empty()) text += base::format(", {} eliminated by attachment", 3 * data.bonds.size());
  if (data.ties.empty() && !data.tied_to_ground) return text;
  std::string hosts;
  for (const fem::Host& host : data.hosts) hosts += (hosts.empty() ? "" : " ") + host.name;
  if (!data.ties.empty()) text += base::format(", {} eliminated by ties to {}", 3 * data.ties.size(), hosts);
  if (!data.displacements.empty()) text += base::format(", {} prescribed", data.displacements.size());
  return text;
}

std::string solid_text(const scene::Scene& scene, const fem::Solid& solid, const model::SolverSize& size) {
  const fem::SolidUnknowns& unknowns = solid.unknowns();
  const std::size_t n_members = solid.members().size();
  const std::string kind = n_members > 1 ? base::format("{} solids attached to one another,", n_members)
                           : solid.part(solid.members().front()).starts_with("muscles/") ? "muscle"
                                                                                         : "solid";
  std::string text =
      base::format("  {} {}: {} nodes, {} cells, {}\n", kind, solid.data().name, solid.elements().n_nodes(),
                   solid.elements().n_cells(), word_of(solid.data().formulation));
  text +=
      base::format("    free positions {}{}, {}, element pressures {}\n", unknowns.n_free_positions(), ties_text(solid),
                   potentials_text(unknowns), solid.has_pressures() ? base::format("{}", solid.n_pressures()) : "no");
  text += base::format("    viscous terms {}, mass {}\n", yes_no(solid.is_viscous()),
                       scene.dynamics ? "yes" : "no (statics)");
  if (!size.solver.empty()) {
    text += base::format("    solver {}, matrices {:.1f} MiB, factors {:.1f} MiB\n", size.solver,
                         size.matrix_bytes / mebi, size.factor_bytes / mebi);
  }
  return text;
}

/// Sums over several solids, and what a formulation with potentials and three fields of every cell would carry.
std::string solids_text(const build::BuiltModel& built) {
  if (built.solids.size() < 2) return {};
  Eigen::Index nodes = 0, cells = 0, free = 0, tied = 0, prescribed = 0, potentials = 0, pressures = 0;
  bool fields = false;
  for (const fem::Solid* solid : built.solids) {
    nodes += solid->elements().n_nodes();
    cells += solid->elements().n_cells();
    free += solid->unknowns().n_free_positions();
    tied += 3 * static_cast<Eigen::Index>(solid->data().ties.size() + solid->data().bonds.size());
    prescribed += static_cast<Eigen::Index>(solid->data().displacements.size());
    potentials += solid->unknowns().n_free_potentials();
    pressures += solid->n_pressures();
    fields = fields || solid->unknowns().has_field();
  }
  std::string text = base::format(
      "  all {} meshes: {} nodes, {} cells; unknowns {} = {} positions + {} potentials + {} pressures; {} eliminated "
      "by "
      "ties, {} prescribed\n",
      built.solids.size(), nodes, cells, free + potentials + pressures, free, potentials, pressures, tied, prescribed);
  if (fields) {
    text += base::format("    with all positions, potentials and three fields a cell they would be {}\n",
                         4 * nodes + 3 * cells);
  }
  return text;
}

std::string muscles_text(const build::Assembled& assembled) {
  const std::size_t lumped = assembled.muscles - assembled.meshed_muscles;
  if (assembled.meshed_muscles == 0) return base::format("{} (lumped)", lumped);
  if (lumped == 0) return base::format("{} (fe)", assembled.meshed_muscles);
  return base::format("{} ({} lumped, {} fe)", assembled.muscles, lumped, assembled.meshed_muscles);
}

}  // namespace

std::string summary(const scene::Scene& scene, const build::BuiltModel& built) {
  const multibody::TreeManifold& manifold = *built.manifold;
  const build::Assembled& assembled = built.assembled;
  std::string text = base::format("{}\n", scene.title.empty() ? "(no title)" : scene.title);
  text +=
      base::format("  bodies {}, joints {}, muscles {}, isolated actuators {}, springs {}, loads {}, joint forces {}\n",
                   scene.bodies.size(), scene.joints.size(), muscles_text(assembled), assembled.free_actuators,
                   assembled.springs, assembled.loads, assembled.joint_forces);
  text += chains_text(scene, built);
  const bool mechanism = manifold.n_v() > 0 || built.solids.empty();
  if (mechanism) {
    text += base::format(
        "  degrees of freedom {}: {} minimal velocities less {} loop constraints; {} redundant coordinates\n",
        manifold.n_v() - manifold.n_c(), manifold.n_v(), manifold.n_c(), manifold.n_q());
  }
  text +=
      base::format("  assembled: gravity {}, damping {}, electric {}, finite elements {}\n", yes_no(assembled.gravity),
                   yes_no(assembled.damping), yes_no(assembled.electric), yes_no(!built.solids.empty()));
  double of_solids = 0.0;
  for (const fem::Solid* solid : built.solids) {
    const model::SolverSize size = solver_size(scene, *solid, built.solid_linear);
    text += solid_text(scene, *solid, size);
    of_solids += size.matrix_bytes + size.factor_bytes;
  }
  text += solids_text(built);
  if (mechanism) {
    text += base::format("  linear solver {}\n", manifold.make_solver(*built.model->pattern, built.linear)->name());
  }
  text +=
      base::format("  statics {}, dynamics {}\n", scene.statics ? base::format("{} steps", scene.statics->steps) : "no",
                   scene.dynamics ? base::format("{} steps", scene.dynamics->n_steps()) : "no");
  if (scene.optimal_control) {
    text += base::format("  optimal control: {} steps, {} controls sought\n", scene.optimal_control->n_steps(),
                         scene.optimal_control->controls.size());
  }
  text += base::format("  estimated memory {:.1f} MiB, results {:.1f} MiB\n",
                       (memory_bytes(scene, built) + of_solids) / mebi, result_bytes(scene, built) / mebi);
  return text;
}

}  // namespace muldi::pipeline
