/// Time of a step of one finite-element muscle, what the formulations cost against each other, and what a solid pays
/// for a field and for viscosity that it has (performance 7; the bounds).
#include <chrono>
#include <ctime>
#include <iostream>

#include "base/parallel.hpp"
#include "bench/bench_report.hpp"
#include "support/solid_system.hpp"
#include "variational/stepper.hpp"

namespace {

using namespace muldi;

using Clock = std::chrono::steady_clock;

constexpr double mu = 0.7 / 3.0;
constexpr double dt = 1.0;  // ms
constexpr int n_warm = 20;
constexpr int n_steps = 400;

struct Bar {
  std::array<int, 3> cells;
  fem::Formulation formulation = fem::Formulation::incompressible;
  bool charged = true;
  bool viscous = true;
  /// Potentials of all nodes prescribed, as a stack's are; else of the ends only.
  bool layered = true;
  double field = 2e4;  ///< V/mm
};

/// 100 mm long, held at one end, with its field from t = 0 on.
test::SolidSystem system_of(const Bar& bar) {
  test::SolidSystem system = test::solid_box(bar.cells, {0, 0, 0}, {10, 10, 100});
  for (int i = 0; i < 3; ++i) system.hold(test::plane(2, 0.0), i);
  const double layer = 100.0 / bar.cells[2];
  if (bar.charged && bar.layered) {
    const auto is_odd = [layer](const Eigen::Vector3d& X) { return std::lround(X[2] / layer) % 2 != 0; };
    system.set_potential([&](const Eigen::Vector3d& X) { return !is_odd(X); }, {});
    system.set_potential(is_odd, {.constant = bar.field * layer});
  } else if (bar.charged) {
    system.set_potential(test::plane(2, 0.0), {});
    system.set_potential(test::plane(2, 100.0), {.constant = 100.0 * bar.field});
  }
  fem::Material material = test::rubber(mu, 1000.0 * mu, bar.formulation);
  if (bar.charged) material.electric = fem::IdealDielectric{.permittivity = 3.1 * 8.8542e-12};
  if (bar.viscous) material.viscous = fem::KelvinVoigt{.viscosity = 10.0};
  system.fill(material, mu, bar.formulation);
  return system;
}

struct Stepping {
  double ms = 0.0;         ///< a step
  double processor = 0.0;  ///< ms of all cores a step: on a busy machine the more telling number
  double iterations = 0.0;
  long factorisations = 0;
  double amplitude = 0.0;  ///< mm, norm of the displacements of all nodes, its mean over the steps
};

Stepping stepping(const Bar& bar, double step = dt) {
  const auto model = test::make_model(system_of(bar));
  variational::State state = test::moving_state(*model, step);
  variational::Stepper stepper(*model, step, {});
  const Eigen::VectorXd at_rest = state.q;
  Stepping found;
  Clock::time_point start;
  std::clock_t begin = 0;
  for (int k = 0; k < n_warm + n_steps; ++k) {
    if (k == n_warm) {
      start = Clock::now();
      begin = std::clock();
    }
    const variational::StepReport report = stepper.advance(state, {});
    if (report.status != variational::Status::running) {
      std::cerr << "step " << k << ": " << report.sentence << '\n';
      return {.ms = std::nan(""), .processor = std::nan("")};
    }
    if (k < n_warm) continue;
    found.iterations += static_cast<double>(report.iterations) / n_steps;
    found.factorisations += report.factorisations;
    found.amplitude += (state.q - at_rest).norm() / n_steps;
  }
  found.processor = 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / n_steps;
  found.ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count() / n_steps;
  return found;
}

/// Time of a new factor over that of an iteration with an old one: forces, residual and the two triangular solves.
double factor_over_iteration(const Bar& bar) {
  const auto model = test::make_model(system_of(bar));
  variational::State state = test::moving_state(*model, dt);
  variational::Stepper stepper(*model, dt, {});
  for (int k = 0; k < n_warm; ++k) {
    if (stepper.advance(state, {}).status != variational::Status::running) return std::nan("");
  }
  const Eigen::VectorXd q1 = state.q + state.advance, q = state.q + 0.5 * state.advance, v = state.advance / dt;
  const model::IntervalPoint at{.q0 = state.q, .q1 = q1, .q = q, .v = v, .u = {}, .dt = dt, .y = &state.y};
  const Eigen::VectorXd zero_q = Eigen::VectorXd::Zero(model->n_q()), zero_y = Eigen::VectorXd::Zero(model->n_y());
  model::IntervalForces forces{.force = zero_q, .momentum = zero_q, .begin = zero_q, .end = zero_q, .stage = zero_y};
  const auto solver = model->substructures.front()->make_solver(model::Linearisation::step, "auto");
  Eigen::VectorXd bracket = zero_q, dq = zero_q, dy = zero_y;
  const double factor = bench::median_seconds(51, [&] { solver->factorise(at); });
  const double iteration = bench::median_seconds(201, [&] {
    model->forces(at, forces);
    bracket = state.p + 0.5 * dt * forces.force - forces.momentum + forces.begin;
    model->substructures.front()->keep_free(bracket);
    solver->reduce(bracket, forces.stage);
    dq.setZero();
    solver->expand(dq, dy);
  });
  return factor / iteration;
}

}  // namespace

int main() {
  using fem::Formulation;
  base::set_threads(2);
  bench::BenchReport report("fem_muscle");
  struct Wanted {
    std::array<int, 3> cells;
    double bound;
    double aim;
  };
  for (const auto& [cells, bound, aim] : {Wanted{{2, 2, 23}, 1.0, 0.5}, {{4, 4, 32}, 5.0, 2.0}}) {
    const std::string name = "one muscle, " + std::to_string(cells[0] * cells[1] * cells[2]) + " cells, ";
    const Stepping found = stepping({.cells = cells});
    report.add({name + "a step", found.ms, "ms", bound, aim});
    report.add({name + "processor time of a step", found.processor, "ms"});
    report.add({name + "iterations a step", found.iterations, "1"});
    report.add({name + "factorisations in 400 steps", static_cast<double>(found.factorisations), "1"});
    report.add(
        {name + "a factorisation over an iteration (FactorUse takes 6)", factor_over_iteration({.cells = cells}), "1"});
  }
  // The same mesh and step throughout; a short step, which plain displacements need.
  const std::array<int, 3> cells = {4, 4, 32};
  const double step = 0.1;
  const Stepping I = stepping({.cells = cells, .formulation = Formulation::displacement}, step);
  const Stepping II = stepping({.cells = cells, .formulation = Formulation::mean_dilatation}, step);
  const double III = stepping({.cells = cells}, step).processor;
  report.add({"512 cells, plain displacements, processor time of a step", I.processor, "ms"});
  report.add({"mean dilatation over plain displacements (published 2.6)", II.processor / I.processor, "1", 1.3});
  // The rest of that cost is iterations, not a larger motion: see the weaker field below.
  report.add({"the same, an iteration", II.processor / II.iterations / (I.processor / I.iterations), "1", 1.3});
  // Maxwell's stress grows with the square of the field.
  const double weaker = 2e4 * std::sqrt(I.amplitude / II.amplitude);
  const Stepping alike = stepping({.cells = cells, .formulation = Formulation::mean_dilatation, .field = weaker}, step);
  report.add({"plain displacements, iterations a step", I.iterations, "1"});
  report.add({"mean dilatation, iterations a step", II.iterations, "1"});
  report.add({"mean dilatation, amplitude over that of plain displacements", II.amplitude / I.amplitude, "1"});
  report.add({"under a weaker field, amplitude over that of plain displacements", alike.amplitude / I.amplitude, "1"});
  report.add({"under a weaker field, iterations a step", alike.iterations, "1"});
  report.add({"under a weaker field, processor time over plain displacements", alike.processor / I.processor, "1"});
  report.add({"incompressible over plain displacements", III / I.processor, "1"});
  const double with_potential = stepping({.cells = cells, .layered = false}, step).processor;
  const double without_field = stepping({.cells = cells, .charged = false}, step).processor;
  const double without_viscosity = stepping({.cells = cells, .charged = false, .viscous = false}, step).processor;
  report.add({"unknown potentials over prescribed ones", with_potential / III, "1"});
  report.add({"without a field over prescribed potentials", without_field / III, "1"});
  report.add({"without viscosity either over without a field", without_viscosity / without_field, "1"});
  report.print();
}
