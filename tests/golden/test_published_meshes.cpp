/// Scenes of solids with the meshes of the published work, which take minutes (reference results C).
#include <gtest/gtest.h>

#include <cmath>

#include "scene_run.hpp"

namespace muldi::golden {
namespace {

TEST(RealGeometry, OnThePublishedMeshHasTheLengthOfTheStackAndAWaveOfNanometres) {
  // 95 layers of 0.4 um with 135 quadrilaterals, 12 825 cells, 60 288 unknowns; at 50 V.
  const std::string section = "solids.actuator.mesh.stack.section.cylinder.";
  const std::string layers = "solids.actuator.mesh.stack.layers";
  const SceneRun run("real_geometry", {section + "core=5", section + "rings=11", layers + "[0].cells=5",
                                       layers + "[1].cells=25", "statics.to=50", "statics.steps=1"});
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  // L^4 (1 + 2 f c2 E^2/mu) - L + f eps0 E^2/mu = 0 with the active part f = 30/38 and E = 50 V/10 um.
  const double f = 30.0 / 38.0, mu = 0.233, E = 5e3;
  const double a = 1.0 + 2.0 * f * 1e-9 * E * E / mu, b = f * 8.8542e-12 * E * E / mu;
  double L = 1.0;
  for (int k = 0; k < 50; ++k) L -= (a * std::pow(L, 4) - L + b) / (4.0 * a * std::pow(L, 3) - 1.0);
  EXPECT_NEAR(run.value("statics/probes/length") / 0.038, L, 2e-4);
  const double wave = run.value("statics/probes/silicone") - run.value("statics/probes/electrode");
  EXPECT_NEAR(wave, 4.7e-6, 0.06e-6);  // recorded; not resolved (surface_wave)
}

SceneRun cube(const std::string& viscous, const std::string& step) {
  return SceneRun("cube",
                  {"materials.polymer={density: 1 g/cm^3, elastic: {model: bonet_wood, mu: 0.233, lambda: 999.8}, "
                   "electric: {model: vu, c1: 5.0e-8, c2: 1.0e-9}" +
                       viscous + "}",
                   "dynamics.step=" + step, "record.every=1"});
}

TEST(Cube, UndampedKeepsItsEnergyAsPublished) {
  const auto band = [](const SceneRun& run) {
    const Eigen::VectorXd H = run.rows("energy/total").transpose();
    return (H.array() - H[0]).abs().maxCoeff() / H[0];
  };
  const double whole = band(cube("", "1.0e-3"));
  const double half = band(cube("", "0.5e-3"));
  EXPECT_NEAR(whole, 1.3e-6, 0.05e-6);
  // A quarter is not reached: a wave of volume crosses a cell in 2.5e-4 ms, which neither step resolves. Recorded, with
  // Newton's tolerance of no influence: 1.275e-6, 5.31e-7, at 2.5e-4 ms 2.40e-7.
  EXPECT_NEAR(whole / half, 2.40, 0.02);
}

TEST(Cube, AViscosityOfATwentiethIsAboutCritical) {
  const auto overshoot = [](const std::string& viscosity) {
    const SceneRun run = cube(", viscous: {model: kelvin_voigt, viscosity: " + viscosity + "}", "1.0e-3");
    const Eigen::VectorXd height = run.rows("probes/height").transpose();
    const double end = height[height.size() - 1];
    return (end - height.minCoeff()) / (2.0 - end);
  };
  EXPECT_GT(overshoot("0.004"), 0.3);
  EXPECT_LT(overshoot("0.05"), 1e-6);
  EXPECT_LT(overshoot("0.1"), 1e-6);
}

}  // namespace
}  // namespace muldi::golden
