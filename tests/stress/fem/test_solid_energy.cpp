/// Energy of undamped solids whose volume waves a step does not resolve: bounded by a constant times dt^2 (numerics 5
/// no. 1b).
#include <gtest/gtest.h>

#include <vector>

#include "support/figure.hpp"
#include "support/solid_system.hpp"
#include "support/trajectory.hpp"

namespace muldi::fem {
namespace {

constexpr double mu = 0.233;
constexpr double lambda = 999.8;  // c_P = 1000 mm/ms: a cell of 0.5 mm takes 5e-4 ms

/// A cube of 1 mm on rollers, stretched along z to begin with and let go.
struct Swing {
  double band = 0.0;   ///< max |H - H0| over H0
  double early = 0.0;  ///< over the first tenth
  double late = 0.0;   ///< over the last
};

Swing swing(Formulation formulation, double dt, long steps) {
  test::SolidSystem system = test::solid_box({2, 2, 2}, {0, 0, 0}, {1, 1, 1});
  system.hold_lower_faces();
  system.fill(test::rubber(mu, lambda, formulation), mu, formulation);
  const auto model = test::make_model(system);
  // A velocity without change of volume: the motion is smooth.
  Eigen::VectorXd v(system.solid.X.size());
  for (int n = 0; n < system.n_nodes(); ++n) {
    const Eigen::Vector3d X = system.node(n);
    v.segment<3>(3 * n) = Eigen::Vector3d(-0.5 * X[0], -0.5 * X[1], X[2]) * 2.0;
  }
  test::Band band;
  double H0 = 0.0;
  const test::Run done = test::run(*model, test::moving_state(*model, dt, v), {.dt = dt, .steps = steps},
                                   [&](const variational::NodeRecord& node) {
                                     const double H = node.values.total.kinetic + node.values.total.potential();
                                     if (node.step == 0) H0 = H;
                                     band.add(H - H0, node.step, steps);
                                   });
  EXPECT_EQ(done.result.status, variational::Status::completed) << done.result.sentence;
  return {.band = band.all / H0, .early = band.first_tenth / H0, .late = band.last_tenth / H0};
}

TEST(SolidEnergy, IsBoundedByTheSquareOfAStepThatResolvesNoWaveOfVolume) {
  for (const Formulation formulation :
       {Formulation::displacement, Formulation::mean_dilatation, Formulation::incompressible}) {
    const char* names[] = {"displacements", "mean dilatation", "exact incompressibility"};
    const std::string of = std::string(", ") + names[static_cast<int>(formulation)];
    // Displacements alone see a change of volume in the middle of a step that turns or stretches a cell (numerics C5).
    const double bound = formulation == Formulation::displacement ? 100.0 : 10.0;
    double largest = 0.0;
    double growth = 0.0;
    for (const double dt : {8e-3, 4e-3, 2e-3}) {
      const Swing at = swing(formulation, dt, static_cast<long>(4.0 / dt));
      largest = std::max(largest, at.band / (dt * dt));
      growth = std::max(growth, at.late / at.early);
    }
    test::record_figure("1b", "max |H - H0| / H0 over dt^2 (1/ms^2) at steps of 4 to 16 crossings of a cell" + of,
                        largest, bound);
    test::record_figure("1b", "energy band of the last tenth over that of the first" + of, growth, 2.0);
  }
}

}  // namespace
}  // namespace muldi::fem
