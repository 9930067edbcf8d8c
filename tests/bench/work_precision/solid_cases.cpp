#include "bench/work_precision/solid_cases.hpp"

#include <cmath>

#include "bench/work_precision/peer_run.hpp"
#include "bench/work_precision/published_systems.hpp"
#include "bench/work_precision/scene_motion.hpp"
#include "bench/work_precision/static_run.hpp"

namespace muldi::bench {
namespace {

const std::string ours = "muldi-sim";
const std::string dealii = "deal.II 9.4";

std::string step_text(double step) { return "dt " + short_number(step) + " ms"; }
std::string cells_text(int n) { return std::to_string(n) + "^3 cells"; }
std::string cells_override(const std::string& solid, int n) {
  const std::string side = std::to_string(n);
  return "solids." + solid + ".mesh.box.cells=[" + side + ", " + side + ", " + side + "]";
}

/// A scalar observable of a state; those of positions need nothing else.
Read read_observable(const ReadyScene& ready, const std::string& path) {
  const model::Observable* found = nullptr;
  for (const model::Observable& observable : ready.built.model->observables) {
    if (observable.path == path) found = &observable;
  }
  MULDI_EXPECT(found != nullptr && found->size() == 1, "a scalar observable");
  const Eigen::VectorXd zero_q = Eigen::VectorXd::Zero(ready.state.q.size());
  const Eigen::VectorXd zero_v = Eigen::VectorXd::Zero(ready.built.model->manifold->n_v());
  return [found, zero_q, zero_v](const variational::State& state, std::vector<double>& row) {
    double value = 0.0;
    found->evaluate({.t = state.t,
                     .x = state.x,
                     .rate = zero_v,
                     .q = state.q,
                     .v = zero_q,
                     .constraint_force = zero_q,
                     .multipliers = state.multipliers,
                     .y = state.y,
                     .u = {}},
                    {&value, 1});
    row.push_back(value);
  };
}

struct Timed {
  Motion motion;
  double seconds = 0.0;
};

Timed timed(const ReadyScene& ready, const Grid& grid, const variational::StepOptions& options, const Read& read,
            double budget) {
  Timed result;
  result.seconds = least_seconds(budget, [&] { result.motion = march(ready, grid, options, read); });
  return result;
}

/// Height of the cube at the end of a run.
class Cube {
 public:
  Cube(int cells, double budget)
      : ready_(scene::read_scene(scene_path("cube"), {cells_override("cube", cells)})),
        read_(read_observable(ready_, "probes/height")),
        budget_(budget) {}

  StaticEnd run(double step, double end, const variational::StepOptions& options) const {
    const Timed result = timed(ready_, {.step = step, .sample = end, .end = end}, options, read_, budget_);
    return {.value = result.motion.rows.empty() ? std::nan("") : result.motion.rows[0][0], .seconds = result.seconds};
  }

 private:
  ReadyScene ready_;
  Read read_;
  double budget_;
};

/// deal.II on the scene of cube.yaml.
std::optional<StaticEnd> peer_cube(int cells, double step, double end) {
  const std::string arguments =
      std::to_string(cells) + " 1 " + short_number(step) + " " + std::to_string(std::lround(end / step)) + " 0.05";
  const auto numbers = run_peer("peer_dealii", arguments, 8);
  if (!numbers) return std::nullopt;
  return StaticEnd{.value = (*numbers)[6], .seconds = (*numbers)[7]};
}

constexpr double cube_edge = 2.0;

}  // namespace

void sweep_cube(WorkReport& report, const Effort& effort) {
  const std::string scene = "cube, 4^3 cells";
  constexpr double end = 0.1;
  const Cube cube(4, effort.budget);
  const double finest = effort.quick ? 1e-4 : 2.5e-5;
  const double fine = cube.run(finest, end, {}).value;
  const double coarse = cube.run(2.0 * finest, end, {}).value;
  const double reference = fine + (fine - coarse) / 3.0;
  const double change = std::abs(reference - cube_edge);
  report.add(Reference{.scene = scene,
                       .measure = "height after 0.1 ms, relative to its change",
                       .how = "our own runs with dt " + short_number(2.0 * finest) + " and " + short_number(finest) +
                              " ms, extrapolated (Richardson); deal.II converges to it too",
                       .uncertainty = std::abs(fine - coarse) / (3.0 * change)});
  const auto error = [&](double value) { return std::abs(value - reference) / change; };
  for (const double step : {1e-2, 5e-3, 2e-3, 1e-3, 5e-4, 2e-4}) {
    const StaticEnd mine = cube.run(step, end, {});
    report.add(WorkPoint{scene, "step", ours, step_text(step), mine.seconds, error(mine.value)});
    if (step < (effort.quick ? 2e-3 : 5e-4)) continue;
    if (const auto theirs = peer_cube(4, step, end)) {
      report.add(WorkPoint{scene, "step", dealii, step_text(step), theirs->seconds, error(theirs->value)});
    }
  }
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    const StaticEnd mine = cube.run(1e-3, end, {.tolerance = tolerance});
    report.add(WorkPoint{scene, "tolerance", ours + ", dt 0.001 ms", "tol " + short_number(tolerance), mine.seconds,
                         error(mine.value)});
  }

  const std::string meshes = "cube, meshes";
  constexpr double short_end = 0.02;
  constexpr double step = 1e-3;
  const int finest_mesh = effort.quick ? 12 : 24;
  const double finest_height = Cube(finest_mesh, 0.0).run(step, short_end, {}).value;
  const double finer_change = std::abs(finest_height - cube_edge);
  report.add(
      Reference{.scene = meshes,
                .measure = "height after 0.02 ms with dt 0.001 ms, relative to its change",
                .how = "our own run on " + cells_text(finest_mesh) +
                       "; the field is singular at the edge of the electrode, so that errors fall slowly and may "
                       "change their sign on the way: the comparison of equal meshes is what counts",
                .uncertainty = std::nan("")});
  const auto mesh_error = [&](double value) { return std::abs(value - finest_height) / finer_change; };
  for (const int n : {4, 8, 16}) {
    if (n >= finest_mesh) continue;
    const Cube other(n, effort.budget);
    for (const std::string solver : {"direct", "iterative"}) {
      const StaticEnd mine = other.run(step, short_end, {.substructures = solver});
      report.add(WorkPoint{meshes, "mesh", ours + ", " + solver, cells_text(n), mine.seconds, mesh_error(mine.value)});
    }
    if (const auto theirs = peer_cube(n, step, short_end)) {
      report.add(WorkPoint{meshes, "mesh", dealii, cells_text(n), theirs->seconds, mesh_error(theirs->value)});
    }
  }
}

namespace {

/// The block of tests/bench/peer_dealii_q1p0.cpp.
scene::Scene block_scene(int cells, const std::string& formulation) {
  const std::string side = std::to_string(cells);
  return scene::read_scene_text(
      "muldi: 1\n"
      "materials: {rubber: {density: 1.0e-3, elastic: {model: neo_hookean, mu: 0.233, kappa: 1000}}}\n"
      "controls: {shear: {pressure: 0.01}}\n"
      "solids:\n"
      "  block:\n"
      "    mesh: {box: {size: [10, 10, 10], cells: [" +
          side + ", " + side + ", " + side +
          "], centre: [5, 5, 5]}}\n"
          "    material: rubber\n"
          "    formulation: " +
          formulation +
          "\n"
          "    conditions:\n"
          "      - {where: z-, displacement: [0, 0, 0]}\n"
          "      - {where: z+, traction: [{control: shear}, 0, 0]}\n"
          "statics: {control: shear, from: 0, to: 0.01, steps: 10}\n"
          "record: {probes: {corner: {point: \"block@[10, 10, 10]\", of: displacement, along: [1, 0, 0]}}}\n",
      "block.yaml");
}

}  // namespace

void sweep_block(WorkReport& report, const Effort& effort) {
  const std::string scene = "sheared block";
  const int finest = effort.quick ? 12 : 16;
  const double fine = static_end(block_scene(finest, "mean_dilatation"), "probes/corner", 0.0).value;
  const double coarse = static_end(block_scene(finest / 2, "mean_dilatation"), "probes/corner", 0.0).value;
  const double reference = fine + (fine - coarse) / 3.0;
  report.add(Reference{.scene = scene,
                       .measure = "horizontal displacement of an upper corner, relative to itself",
                       .how = "our own runs on " + cells_text(finest / 2) + " and " + cells_text(finest) +
                              ", extrapolated with order 2; kappa/mu = 4300, load in ten steps, with fewer of which "
                              "plain Newton fails in deal.II",
                       .uncertainty = std::abs(fine - coarse) / 3.0 / std::abs(reference)});
  const auto error = [&](double value) { return std::abs(value - reference) / std::abs(reference); };
  for (const int n : {2, 4, 6, 8, 12}) {
    if (effort.quick && n > 8) continue;
    for (const std::string formulation : {"displacement", "mean_dilatation"}) {
      const StaticEnd mine = static_end(block_scene(n, formulation), "probes/corner", effort.budget);
      report.add(WorkPoint{scene, "mesh", ours + ", " + formulation, cells_text(n), mine.seconds, error(mine.value)});
    }
    if (const auto numbers = run_peer("peer_dealii_q1p0", std::to_string(n) + " 10 0.01 0.233 1000", 3)) {
      report.add(WorkPoint{scene, "mesh", dealii + ", Q1-P0", cells_text(n), (*numbers)[2], error((*numbers)[0])});
    }
  }
}

void sweep_boxed_cube(WorkReport& report, const Effort& effort) {
  const std::string scene = "boxed cube";
  const auto height = [](const std::string& file, int cells, double budget) {
    const std::vector<std::string> overrides{cells_override("cube", cells)};
    scene::Scene read = scene::read_scene(scene_path(file), overrides);
    read.dynamics.reset();
    return static_end(read, "probes/height", budget);
  };
  const int finest = effort.quick ? 8 : 12;
  const double reference = height("boxed_cube_III", finest, 0.0).value;
  constexpr double edge = 50.0;
  const double change = std::abs(reference - edge);
  report.add(Reference{
      .scene = scene,
      .measure = "static height under the electrode, relative to its change",
      .how = "our own run of the exactly incompressible formulation on " + cells_text(finest) +
             "; the others have nu = 0.4999 and so differ from it by about 1e-4 at best. Compare at one mesh: "
             "at the edge of the electrode the field is singular, so that heights do not converge "
             "with the mesh, and 10^3 cells lose their equilibrium there",
      .uncertainty = std::nan("")});
  for (const std::string kind : {"I", "II", "III", "IV"}) {
    for (const int n : {4, 6, 8}) {
      if (n >= finest) continue;
      const StaticEnd mine = height("boxed_cube_" + kind, n, effort.budget);
      report.add(WorkPoint{scene, "formulation", ours + ", formulation " + kind, cells_text(n), mine.seconds,
                           std::abs(mine.value - reference) / change});
    }
  }
}

void sweep_membrane(WorkReport& report, const Effort& effort) {
  const std::string scene = "membrane, one finite element";
  const Grid samples{.step = 2.5e-4, .sample = 0.1, .end = 5.0};
  const auto system = lumped_membrane();
  const Samples exact = integrate(*system, Method::runge_kutta_4, samples);
  std::vector<std::vector<double>> reference;
  for (const Coordinates& x : exact.x) reference.push_back({0.5 * x[0]});
  report.add(
      Reference{.scene = scene,
                .measure = "largest difference of the half thickness at samples every 0.1 ms over 5 ms, relative to "
                           "the largest motion",
                .how = "the lumped equation of motion, Runge-Kutta 4 with dt 0.00025 ms (independent of lib/): the "
                       "exactly incompressible element has the same field of deformation",
                .uncertainty = 1e-11});
  for (const std::string formulation : {"incompressible", "incompressible_direct"}) {
    const ReadyScene ready(
        scene::read_scene(scene_path("membrane_fe"), {"solids.membrane.formulation=" + formulation}));
    const Read read = read_observable(ready, "probes/half_thickness");
    for (const double step : {0.05, 0.02, 0.01, 0.005, 0.0025}) {
      const Grid grid{.step = step, .sample = 0.1, .end = 5.0};
      const Timed mine = timed(ready, grid, {}, read, effort.budget);
      report.add(WorkPoint{scene, "step", ours + ", " + formulation, step_text(step), mine.seconds,
                           motion_error(mine.motion.rows, reference, {0.5})});
    }
  }
}

namespace {

scene::Scene joint_scene(const std::string& formulation, int layers, int section_cells) {
  std::vector<std::string> overrides;
  for (const std::string muscle : {"upper", "lower"}) {
    overrides.push_back("muscles." + muscle + ".fe.formulation=" + formulation);
    overrides.push_back("muscles." + muscle + ".fe.layers=" + std::to_string(layers));
    overrides.push_back("muscles." + muscle + ".fe.section_cells=" + std::to_string(section_cells));
  }
  if (formulation == "mean_dilatation") overrides.emplace_back("materials.silicone.elastic.poisson=0.4999");
  return scene::read_scene(scene_path("revolute_joint_twin"), overrides);
}

void sweep_joint_steps(WorkReport& report, const Effort& effort) {
  const std::string scene = "FE joint, 2 x 92 cells";
  const double end = effort.quick ? 100.0 : 200.0;
  for (const std::string formulation : {"incompressible", "mean_dilatation"}) {
    const ReadyScene ready(joint_scene(formulation, 23, 4));
    const Read read = read_observable(ready, "joints/hinge/coordinate");
    const auto grid = [&](double step) { return Grid{.step = step, .sample = 20.0, .end = end}; };
    const double finest = effort.quick ? 0.2 : 0.1;
    const Motion fine = march(ready, grid(finest), {}, read);
    const Motion coarse = march(ready, grid(2.0 * finest), {}, read);
    const std::vector<std::vector<double>> reference = extrapolated(fine, coarse);
    if (formulation == "incompressible") {
      report.add(Reference{.scene = scene,
                           .measure = "largest difference of the angle at samples every 20 ms over " +
                                      short_number(end) + " ms, relative to the largest angle",
                           .how = "our own runs of the same formulation and mesh with dt " +
                                  short_number(2.0 * finest) + " and " + short_number(finest) +
                                  " ms, extrapolated (Richardson)",
                           .uncertainty = motion_error(fine.rows, reference, {0.0})});
    }
    for (const double step : {10.0, 5.0, 2.0, 1.0, 0.5}) {
      const Timed mine = timed(ready, grid(step), {}, read, effort.budget);
      report.add(WorkPoint{scene, "step", ours + ", " + formulation, step_text(step), mine.seconds,
                           motion_error(mine.motion.rows, reference, {0.0})});
    }
    if (formulation != "incompressible") continue;
    for (const double tolerance : {1e-3, 1e-4, 1e-6, 1e-8, 1e-10}) {
      const Timed mine = timed(ready, grid(2.0), {.tolerance = tolerance}, read, effort.budget);
      report.add(WorkPoint{scene, "tolerance", ours + ", dt 2 ms", "tol " + short_number(tolerance), mine.seconds,
                           motion_error(mine.motion.rows, reference, {0.0})});
    }
  }
}

void sweep_joint_meshes(WorkReport& report, const Effort& effort) {
  const std::string scene = "FE joint, static angle";
  const auto angle = [&](const std::string& formulation, int layers, int cells, double budget) {
    scene::Scene read = joint_scene(formulation, layers, cells);
    read.dynamics.reset();
    return static_end(read, "joints/hinge/coordinate", budget);
  };
  const int finest_layers = 46;
  const int finest_cells = effort.quick ? 16 : 64;
  const double reference = angle("incompressible", finest_layers, finest_cells, 0.0).value;
  report.add(Reference{.scene = scene,
                       .measure = "static angle under 30 kV/mm, relative to itself",
                       .how = "our own run, exactly incompressible, " + std::to_string(finest_layers) + " layers of " +
                              std::to_string(finest_cells) +
                              " cells; the round section has its published octagonal rim in every mesh",
                       .uncertainty = std::nan("")});
  for (const std::string formulation : {"incompressible", "mean_dilatation"}) {
    for (const auto& [layers, cells] : {std::pair(6, 4), {12, 4}, {23, 4}, {23, 16}}) {
      if (layers >= finest_layers) continue;
      const StaticEnd mine = angle(formulation, layers, cells, effort.budget);
      report.add(WorkPoint{scene, "mesh", ours + ", " + formulation,
                           std::to_string(layers) + " layers of " + std::to_string(cells) + " cells", mine.seconds,
                           std::abs(mine.value - reference) / std::abs(reference)});
    }
  }
}

}  // namespace

void sweep_finite_element_joint(WorkReport& report, const Effort& effort) {
  sweep_joint_steps(report, effort);
  sweep_joint_meshes(report, effort);
}

}  // namespace muldi::bench
