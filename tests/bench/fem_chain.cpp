/// Time of a step of a chain of hinged bodies with twelve finite-element muscles, the task of the trunk (performance 0,
/// 6): exactly incompressible, ideal dielectric, viscous, fields that jump.
#include <chrono>
#include <cstdlib>
#include <iostream>

#include "base/parallel.hpp"
#include "support/tied_system.hpp"
#include "variational/node_values.hpp"
#include "variational/stepper.hpp"

namespace {

using Clock = std::chrono::steady_clock;
using namespace muldi;

double milliseconds(Clock::time_point since) {
  return std::chrono::duration<double, std::milli>(Clock::now() - since).count();
}

}  // namespace

/// fem_chain [steps [threads [dt [field]]]]
int main(int argc, char** argv) {
  const auto argument = [&](int i, double otherwise) { return i < argc ? std::atof(argv[i]) : otherwise; };
  const long steps = static_cast<long>(argument(1, 200));
  base::set_threads(static_cast<int>(argument(2, 1)));
  const double dt = argument(3, 1.0);
  const double field = argument(4, 2e4);
  test::TiedSystem system = test::chain_with_muscles(
      6, {.cells = {4, 4, 18}, .side = 10.0, .viscosity = argument(6, 0.1), .permittivity = 3 * 8.8542e-12});
  system.rigid.controls = {{.name = "right", .unit = {}, .function = field},
                           {.name = "left", .unit = {}, .function = 0.0}};
  const auto model = test::make_model(system);
  {
    statics::EquilibriumSolver solver(*model, {});
    statics::StaticState at = test::static_start(*model);
    model->manifold->configuration(at.x, at.q);
    for (const auto& part : model->substructures) part->start(at.q, at.y);
    const auto begin = Clock::now();
    const auto report = solver.solve(at, std::vector<double>{field, 0.0});
    std::cout << "equilibrium: ms " << milliseconds(begin) << ", iterations " << report.iterations << ", converged "
              << report.converged << ", residual " << report.residual << '\n';
  }
  variational::State state = test::tied_state(*model, dt, Eigen::VectorXd::Zero(model->manifold->n_v()));
  variational::Stepper stepper(*model, dt, {});
  const std::vector<double> u = {field, 0.0};
  long iterations = 0;
  long factorisations = 0;
  double largest = 0.0;
  const auto start = Clock::now();
  for (long step = 0; step < steps; ++step) {
    const auto report = stepper.advance(state, u);
    if (report.status != variational::Status::running) {
      std::cout << "failed at step " << step << ": " << report.sentence << '\n';
      return 1;
    }
    if (argc > 6) {
      static Eigen::VectorXd q1, q2;
      if (q2.size() > 0) {
        const Eigen::VectorXd zig = state.q - 2 * q1 + q2;
        std::cout << step << " zigzag";
        for (const auto& part : model->substructures) {
          Eigen::Index where = 0;
          const double most = zig.segment(part->q_slice().first, part->q_slice().size).cwiseAbs().maxCoeff(&where);
          std::cout << "  " << most << "@" << where / 75 << "." << (where / 3) % 25 << "." << where % 3;
        }
        std::cout << '\n';
      }
      q2 = q1;
      q1 = state.q;
    }
    iterations += report.iterations;
    factorisations += report.factorisations;
    largest = std::max(largest, state.x.lpNorm<Eigen::Infinity>());
    if (argc > 5)
      std::cout << step << ' ' << report.iterations << ' ' << report.factorisations << ' ' << state.x.transpose()
                << '\n';
  }
  const double time = milliseconds(start) / static_cast<double>(steps);
  variational::NodeEvaluator nodes(*model, "auto");
  variational::NodeValues values;
  nodes.evaluate(state, u, u, values);
  const auto begin = Clock::now();
  nodes.evaluate(state, u, u, values);
  std::cout << "ms a step " << time << ", iterations " << static_cast<double>(iterations) / static_cast<double>(steps)
            << ", factorisations " << factorisations << ", ms a node " << milliseconds(begin) << ", largest angle "
            << largest << ", last " << state.x.transpose() << '\n';
}
