#include "pipeline/summary.hpp"

#include <algorithm>

#include "base/text.hpp"

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

/// Doubles of the results, of the tangent and of the states.
double memory_bytes(const scene::Scene& scene, const build::BuiltModel& built) {
  const double tangent = static_cast<double>(built.model->pattern->n_values());
  const double states = 40.0 * (built.manifold->n_q() + built.manifold->n_v());
  double dense = 0.0;
  if (scene.statics) dense = 4.0 * built.manifold->n_v() * built.manifold->n_v();
  return 8.0 * (2.0 * tangent + states + dense);
}

double result_bytes(const scene::Scene& scene, const build::BuiltModel& built) {
  double row = 32.0;
  for (const model::Observable& observable : built.model->observables) row += static_cast<double>(observable.size());
  row += 4.0 * static_cast<double>(built.model->parts().size());
  double rows = 0.0;
  if (scene.statics) rows += scene.statics->steps + 1.0;
  if (scene.dynamics) rows += static_cast<double>(scene.dynamics->n_steps()) / scene.record.every + 1.0;
  return 8.0 * row * rows;
}

}  // namespace

std::string summary(const scene::Scene& scene, const build::BuiltModel& built) {
  const multibody::TreeManifold& manifold = *built.manifold;
  const build::Assembled& assembled = built.assembled;
  std::string text = base::format("{}\n", scene.title.empty() ? "(no title)" : scene.title);
  text += base::format(
      "  bodies {}, joints {}, muscles {} (lumped), isolated actuators {}, springs {}, loads {}, joint forces {}\n",
      scene.bodies.size(), scene.joints.size(), assembled.muscles, assembled.free_actuators, assembled.springs,
      assembled.loads, assembled.joint_forces);
  text += chains_text(scene, built);
  text += base::format(
      "  degrees of freedom {}: {} minimal velocities less {} loop constraints; {} redundant coordinates\n",
      manifold.n_v() - manifold.n_c(), manifold.n_v(), manifold.n_c(), manifold.n_q());
  text += base::format("  assembled: gravity {}, damping {}, electric {}, finite elements no\n",
                       yes_no(assembled.gravity), yes_no(assembled.damping), yes_no(assembled.electric));
  text += base::format("  linear solver {}\n", manifold.make_solver(*built.model->pattern, built.linear)->name());
  text +=
      base::format("  statics {}, dynamics {}\n", scene.statics ? base::format("{} steps", scene.statics->steps) : "no",
                   scene.dynamics ? base::format("{} steps", scene.dynamics->n_steps()) : "no");
  text += base::format("  estimated memory {:.1f} MiB, results {:.1f} MiB\n", memory_bytes(scene, built) / 1048576.0,
                       result_bytes(scene, built) / 1048576.0);
  return text;
}

}  // namespace muldi::pipeline
