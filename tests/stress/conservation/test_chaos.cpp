/// The double pendulum at large angles is chaotic: energies can be compared, points cannot (numerics 5 no. 33).
#include <gtest/gtest.h>

#include <iostream>

#include "stress/energy_history.hpp"
#include "support/figure.hpp"
#include "support/systems.hpp"

namespace muldi {
namespace {

TEST(Chaos, KeepsTheEnergyInABandThatScalesWithTheStep) {
  const auto model = test::make_model(test::double_pendulum());
  const variational::State start = test::state_at_rest(*model);
  const test::EnergyHistory coarse = test::energy_history(*model, start, 5.0, 100'000);
  const test::EnergyHistory fine = test::energy_history(*model, start, 2.5, 200'000);
  std::cout << "band " << coarse.band().all / coarse.swing() << " of " << coarse.swing() << " mJ, last/first tenth "
            << coarse.band().last_tenth / coarse.band().first_tenth << ", ratio " << coarse.band().all / fine.band().all
            << ", violation " << coarse.violation() << '\n';
  // The largest error is that of the fastest moment met, which differs from run to run.
  test::record_figure("33", "chaotic pendulum, energy band of the last tenth over that of the first",
                      coarse.band().last_tenth / coarse.band().first_tenth, 2.0);
  test::record_near("33", "chaotic pendulum, energy band over that of half the step",
                    coarse.band().all / fine.band().all, 4.0, 1.0);
  EXPECT_LT(coarse.violation(), 1e-11);
}

TEST(Chaos, ForgetsItsStartButNotItsEnergy) {
  const auto model = test::make_model(test::double_pendulum());
  const auto end = [&](double offset, long steps) {
    const variational::State start = test::state_at(*model, Eigen::Vector2d(0.0, offset), Eigen::Vector2d::Zero());
    double energy = 0.0;
    const test::Run done = test::run(*model, start, {.dt = 5.0, .steps = steps}, [&](const auto& node) {
      energy = node.values.total.kinetic + node.values.total.potential();
    });
    return std::pair(done.state.q, energy);
  };
  const double short_time = (end(1e-10, 100).first - end(0.0, 100).first).norm();
  const auto [q, energy] = end(0.0, 8000);
  const auto [q_other, energy_other] = end(1e-10, 8000);
  std::cout << "apart " << short_time << " mm, then " << (q_other - q).norm() << " mm; energies " << energy << ' '
            << energy_other << '\n';
  EXPECT_LT(short_time, 1e-6);
  test::record_at_least("33", "chaotic pendulum, distance of two paths 1e-10 rad apart after 40 s (mm)",
                        (q_other - q).norm(), 1.0);
  // Swing of the potential: 2 m g l (1 + 3) with l = 46 mm, about 144 mJ.
  test::record_figure("33", "chaotic pendulum, difference of their energies over the swing",
                      std::abs(energy - energy_other) / 144.0, 0.01);
}

}  // namespace
}  // namespace muldi
