/// Fields, probes and electrodes of solids against closed forms.
#include <gtest/gtest.h>

#include "unit/pipeline/solid_scene.hpp"

namespace muldi {
namespace {

using golden::SceneRun;
using test::cube;
using test::eps0;
using test::last_field;
using test::on_rollers;

const std::string dielectric =
    "elastic: {model: neo_hookean, mu: 0.2, poisson: 0.5}, electric: {model: ideal_dielectric, relative_permittivity: "
    "3}";
const std::string three_electrodes =
    "    electrodes:\n"
    "      low: {where: y-, potential: 0}\n"
    "      high: {where: y+, potential: 20 kV}\n"
    "      middle: {where: {plane: {y: 0}}, charge: 0}\n";

TEST(SolidRecords, PlateCapacitorHasTheChargeOfTheClosedForm) {
  const SceneRun run(cube(dielectric,
                          "    conditions:\n      - {where: all, displacement: [0, 0, 0]}\n" + three_electrodes,
                          "statics: {steps: 2}\n"
                          "record:\n"
                          "  fields: {cube: [potential, field, true_field, stress]}\n"
                          "  probes:\n"
                          "    charge: {charge: cube.high}\n"
                          "    between: {point: \"cube@[0, 0, 0]\", of: potential}\n"
                          "    mean: {average: cube@x+, of: potential}\n"));
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  // Q = eps A E with A = 4 mm^2, E = 20 kV / 2 mm.
  const double charge = 3 * eps0 * 4 * 1e4;
  EXPECT_NEAR(run.value("statics/electrodes/cube.high/charge"), charge, 1e-12 * charge);
  EXPECT_NEAR(run.value("statics/electrodes/cube.low/charge"), -charge, 1e-12 * charge);
  EXPECT_NEAR(run.value("statics/electrodes/cube.middle/charge"), 0.0, 1e-12 * charge);
  EXPECT_NEAR(run.value("statics/probes/charge"), charge, 1e-12 * charge);
  EXPECT_NEAR(run.value("statics/electrodes/cube.middle/potential"), 1e4, 1e-8);
  EXPECT_EQ(run.value("statics/electrodes/cube.high/potential"), 2e4);
  EXPECT_NEAR(run.value("statics/probes/between"), 1e4, 1e-8);
  EXPECT_NEAR(run.value("statics/probes/mean"), 1e4, 1e-8);
  // Maxwell's stress eps (e e - e^2/2 1): tension along the field, compression across.
  const double maxwell = 0.5 * 3 * eps0 * 1e8;
  const Eigen::MatrixXd stress = last_field(run, "statics/solids/cube/stress", 6);
  const Eigen::MatrixXd field = last_field(run, "statics/solids/cube/field", 3);
  for (Eigen::Index cell = 0; cell < 8; ++cell) {
    EXPECT_NEAR(field(1, cell), -1e4, 1e-8);
    EXPECT_NEAR(field(0, cell), 0.0, 1e-8);
    EXPECT_NEAR(stress(1, cell) - stress(0, cell), 2 * maxwell, 1e-12);
    EXPECT_NEAR(stress(0, cell) - stress(2, cell), 0.0, 1e-12);
    EXPECT_NEAR(stress.col(cell).tail<3>().norm(), 0.0, 1e-12);
  }
}

TEST(SolidRecords, StretchedActuatorCarriesItsLoadAndCharge) {
  const SceneRun run(
      cube(dielectric, on_rollers + "      - {where: y+, traction: [0, 0.02, 0]}\n" + three_electrodes,
           "statics: {steps: 4}\n"
           "record:\n"
           "  fields: {cube: {fields: [position, velocity, stress, field, true_field, jacobian], every: 3}}\n"
           "  probes:\n"
           "    below: {reaction: cube@y-}\n"
           "    all: {reaction: {solid: cube, where: all}, along: [0, -5, 0]}\n"
           "    height: {distance: [\"cube@[1, -1, 1]\", \"cube@[1, 1, 1]\"], along: [0, 2, 0]}\n"
           "    rise: {average: cube@y+, of: displacement, along: [0, 1, 0]}\n"
           "    diagonal: {distance: [\"cube@[-1, -1, -1]\", \"cube@[1, 1, 1]\"]}\n"));
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const double stretch = run.value("statics/probes/height") / 2;
  const double across = 1 / std::sqrt(stretch);
  EXPECT_NEAR(run.value("statics/probes/rise"), 2 * (stretch - 1), 1e-13);
  EXPECT_NEAR(run.value("statics/probes/diagonal"), 2 * std::sqrt(stretch * stretch + 2 * across * across), 1e-12);
  // The load is 0.02 MPa on 4 mm^2.
  EXPECT_NEAR(run.last("statics/probes/below")[1], -0.08, 1e-12);
  EXPECT_NEAR(run.value("statics/probes/all"), 0.08, 1e-12);
  const double charge = 3 * eps0 * 4 * 1e4 / (stretch * stretch);  // eps (A / stretch) (E / stretch)
  EXPECT_NEAR(run.value("statics/electrodes/cube.high/charge"), charge, 1e-10 * charge);
  const Eigen::MatrixXd stress = last_field(run, "statics/solids/cube/stress", 6);
  EXPECT_NEAR(stress(1, 5), 0.02 * stretch, 1e-12);  // by deformed area
  EXPECT_NEAR(stress(0, 5), 0.0, 1e-12);
  EXPECT_NEAR(last_field(run, "statics/solids/cube/field", 3)(1, 2), -1e4, 1e-8);
  EXPECT_NEAR(last_field(run, "statics/solids/cube/true_field", 3)(1, 2), -1e4 / stretch, 1e-8);
  EXPECT_NEAR(last_field(run, "statics/solids/cube/jacobian", 1)(0, 7), 1.0, 1e-12);
  EXPECT_EQ(Eigen::VectorXd(run.rows("statics/solids/cube/load").row(0)), Eigen::Vector3d(0, 0.75, 1));
  EXPECT_THROW(run.rows("statics/solids/cube/velocity"), std::out_of_range);  // nothing moves
}

class Formulations : public testing::TestWithParam<const char*> {};

TEST_P(Formulations, CompressionIsAPositivePressureOnFieldAndSupport) {
  const std::string formulation = GetParam();
  const bool exact = formulation.starts_with("incompressible");
  const SceneRun run(
      cube("elastic: {model: neo_hookean, mu: 0.2, poisson: " + std::string(exact ? "0.5}" : "0.45}"),
           "    formulation: " + formulation + "\n" + on_rollers +
               "      - {where: x+, pressure: 0.03}\n      - {where: y+, pressure: 0.03}\n"
               "      - {where: z+, pressure: 0.03}\n",
           "statics: {steps: 3}\n"
           "record: {fields: {cube: [pressure, stress, jacobian]}, probes: {left: {reaction: cube@x-}}}\n"));
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const double J = last_field(run, "statics/solids/cube/jacobian", 1)(0, 0);
  if (exact) {
    EXPECT_NEAR(J, 1.0, 1e-12);
  } else {
    EXPECT_LT(J, 0.99);
  }
  for (Eigen::Index cell = 0; cell < 8; ++cell) {
    EXPECT_NEAR(last_field(run, "statics/solids/cube/pressure", 1)(0, cell), 0.03, 1e-10);
    EXPECT_NEAR(last_field(run, "statics/solids/cube/stress", 6)(2, cell), -0.03, 1e-10);
  }
  // On the deformed area.
  EXPECT_NEAR(run.last("statics/probes/left")[0], 0.03 * 4 * std::pow(J, 2.0 / 3.0), 1e-8);
}

INSTANTIATE_TEST_SUITE_P(All, Formulations,
                         testing::Values("displacement", "mean_dilatation", "incompressible", "incompressible_direct"));

TEST(SolidRecords, AlternatingElectrodesHaveAChargeEach) {
  const SceneRun run(cube(dielectric,
                          "    conditions:\n      - {where: all, displacement: [0, 0, 0]}\n"
                          "    electrodes: {stack: {alternate: layers, potentials: [0, 10 kV]}}\n",
                          "statics: {steps: 1}\nrecord: {probes: {q: {charge: cube.stack}}}\n", "[1, 1, 2]"));
  ASSERT_TRUE(run.outcome().completed());
  // Two layers of 1 mm side by side: the inner electrode has field on both sides.
  const double charge = 2 * 3 * eps0 * 4 * 1e4;
  EXPECT_NEAR(run.last("statics/probes/q")[0], -charge, 1e-12 * charge);
  EXPECT_NEAR(run.last("statics/probes/q")[1], charge, 1e-12 * charge);
}

TEST(SolidRecords, WithoutAWishNothingIsRecorded) {
  const SceneRun run(cube(dielectric, on_rollers, "statics: {steps: 1}\n"));
  ASSERT_TRUE(run.outcome().completed());
  for (const auto& channel : run.recorder().declared().channels) {
    for (const char* folder : {"statics/solids/", "statics/electrodes/", "statics/probes/"}) {
      EXPECT_FALSE(channel.spec.path.starts_with(folder)) << channel.spec.path;
    }
  }
  EXPECT_TRUE(run.recorder().declared().fixed.empty());
}

TEST(SolidRecords, ScenesWithoutSolidsHaveNoStateOfSolidsInTheirCheckpoint) {
  const SceneRun run("pendulum", {"dynamics.duration=10"});
  std::string names;
  for (const auto& vector : run.recorder().checkpoint().reals) names += vector.name + " ";
  for (const auto& vector : run.recorder().checkpoint().integers) names += vector.name + " ";
  EXPECT_EQ(names, "ledger residual row x p increment multipliers step solver ");
}

}  // namespace
}  // namespace muldi
