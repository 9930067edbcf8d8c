/// Capacitances, stored and supplied energies of electrodes against closed forms.
#include <gtest/gtest.h>

#include "unit/pipeline/solid_scene.hpp"

namespace muldi {
namespace {

using golden::SceneRun;
using test::cube;
using test::eps0;
using test::on_rollers;

constexpr double permittivity = 3 * eps0;
constexpr double area = 4.0;
constexpr double height = 2.0;
constexpr double voltage = 2e4;

const std::string dielectric =
    "elastic: {model: neo_hookean, mu: 0.2, poisson: 0.5}, electric: {model: ideal_dielectric, relative_permittivity: "
    "3}";
const std::string rigid = "    conditions:\n      - {where: all, displacement: [0, 0, 0]}\n";
const std::string two_electrodes =
    "    electrodes:\n"
    "      low: {where: y-, potential: 0}\n"
    "      high: {where: y+, potential: {control: supply}}\n";
const std::string wanted = "record: {electric: [capacitance, stored_energy, supplied_energy]}\n";

std::string supply(const std::string& potential) { return "controls: {supply: {potential: " + potential + "}}\n"; }

double of(const SceneRun& run, const std::string& electrode, const std::string& what) {
  return run.value("statics/electrodes/cube." + electrode + "/" + what);
}

TEST(Capacitance, OfAPlateIsThatOfTheClosedFormWithoutVoltageToo) {
  for (const char* potential : {"0", "20 kV"}) {
    const SceneRun run(cube(dielectric, rigid + two_electrodes, supply(potential) + "statics: {steps: 1}\n" + wanted));
    ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
    const double capacitance = permittivity * area / height;
    EXPECT_NEAR(of(run, "high", "capacitance"), capacitance, 1e-12 * capacitance);
    EXPECT_NEAR(of(run, "low", "capacitance"), capacitance, 1e-12 * capacitance);
  }
}

TEST(Capacitance, OfThreeConductorsIsTheDiagonalOfMaxwellsMatrix) {
  const SceneRun run(cube(dielectric,
                          rigid + two_electrodes + "      middle: {where: {plane: {y: 0}}, potential: 1 kV}\n",
                          supply("20 kV") + "statics: {steps: 1}\n" + wanted));
  ASSERT_TRUE(run.outcome().completed());
  const double half = permittivity * area / (0.5 * height);  // of the dielectric on one side of the middle
  EXPECT_NEAR(of(run, "high", "capacitance"), half, 1e-12 * half);
  EXPECT_NEAR(of(run, "middle", "capacitance"), 2 * half, 1e-12 * half);
}

TEST(Capacitance, SeesAFloatingElectrodeAsTheSourceDoes) {
  const SceneRun run(cube(dielectric, rigid + two_electrodes + "      middle: {where: {plane: {y: 0}}, charge: 0}\n",
                          supply("20 kV") + "statics: {steps: 1}\n" + wanted));
  ASSERT_TRUE(run.outcome().completed());
  const double half = permittivity * area / (0.5 * height);
  EXPECT_NEAR(of(run, "high", "capacitance"), 0.5 * half, 1e-11 * half);  // both halves in series
  EXPECT_NEAR(of(run, "middle", "capacitance"), 2 * half, 1e-11 * half);  // both in parallel
  EXPECT_NEAR(of(run, "high", "stored_energy"), 0.25 * half * voltage * voltage, 1e-11 * half * voltage * voltage);
  EXPECT_EQ(of(run, "middle", "stored_energy"), 0.0);
  EXPECT_EQ(of(run, "middle", "supplied_energy"), 0.0);
}

TEST(Capacitance, OfAStackIsThatOfAllLayersSideBySide) {
  const SceneRun run(cube(dielectric, rigid + "    electrodes: {stack: {alternate: layers, potentials: [0, 10 kV]}}\n",
                          "statics: {steps: 1}\n" + wanted, "[1, 1, 4]"));
  ASSERT_TRUE(run.outcome().completed());
  const double capacitance = 4 * permittivity * area / (height / 4);
  EXPECT_NEAR(of(run, "stack_0", "capacitance"), capacitance, 1e-12 * capacitance);
  EXPECT_NEAR(of(run, "stack_1", "capacitance"), capacitance, 1e-12 * capacitance);
}

/// A cube under a traction, so that it is stretched along the field.
SceneRun stretched(const std::string& material) {
  return SceneRun(cube(material, on_rollers + "      - {where: y+, traction: [0, 0.3, 0]}\n" + two_electrodes,
                       supply("5 kV") + "statics: {steps: 8}\n" +
                           "record:\n  electric: [capacitance, stored_energy, supplied_energy]\n"
                           "  probes: {height: {distance: [\"cube@[1, -1, 1]\", \"cube@[1, 1, 1]\"]}}\n"));
}

TEST(Capacitance, FollowsTheShape) {
  const SceneRun run = stretched(dielectric);
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const double stretch = run.value("statics/probes/height") / height;
  ASSERT_GT(stretch, 1.3);
  const double capacitance = permittivity * area / (height * stretch * stretch);  // eps (A / L) / (h L)
  EXPECT_NEAR(of(run, "high", "capacitance"), capacitance, 1e-10 * capacitance);
}

TEST(Capacitance, FollowsAPermittivityThatDependsOnTheStretch) {
  const double c1 = -2e-11, c2 = -1e-11, c3 = 3e-12;
  const SceneRun run = stretched(
      "elastic: {model: neo_hookean, mu: 0.2, poisson: 0.5}, electric: {model: invariants, c1: -2e-11, c2: -1e-11, c3: "
      "3e-12}");
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const double i2 = std::pow(run.value("statics/probes/height") / height, -2.0);
  // Omega = (c1 + (c2 - eps0/2) L^-2 + c3 L^-4) E^2 by volume, Q = -dOmega/dE A.
  const double capacitance = -2.0 * (c1 + (c2 - 0.5 * eps0) * i2 + c3 * i2 * i2) * area / height;
  EXPECT_NEAR(of(run, "high", "capacitance"), capacitance, 1e-10 * capacitance);
  EXPECT_NEAR(of(run, "high", "charge"), capacitance * 5e3, 1e-10 * capacitance * 5e3);
}

/// What is missing in supplied = stored + elastic for a cube that only its field deforms, relative.
double missing_in_statics(int steps) {
  const SceneRun run(cube(dielectric, on_rollers + two_electrodes,
                          supply("60 kV") + "statics: {steps: " + std::to_string(steps) + "}\n" + wanted));
  EXPECT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const double kept = run.value("statics/energy/stored") + run.value("statics/energy/elastic");
  EXPECT_EQ(run.value("statics/energy/supplied"), of(run, "high", "supplied_energy"));
  EXPECT_EQ(of(run, "low", "supplied_energy"), 0.0);
  return (run.value("statics/energy/supplied") - kept) / kept;
}

TEST(SuppliedEnergy, OfARisingVoltageIsWhatTheSolidKeepsToSecondOrderInTheLoadSteps) {
  const double coarse = missing_in_statics(10);
  const double fine = missing_in_statics(20);
  EXPECT_NEAR(coarse / fine, 4.0, 0.1);
  EXPECT_LT(std::abs(fine), 1e-3);
}

TEST(SuppliedEnergy, OfAFixedCapacitorIsHalfOfVoltageTimesCharge) {
  const SceneRun run(cube(dielectric, rigid + two_electrodes, supply("20 kV") + "statics: {steps: 3}\n" + wanted));
  const double energy = 0.5 * permittivity * area / height * voltage * voltage;
  EXPECT_NEAR(of(run, "high", "supplied_energy"), energy, 1e-12 * energy);
  EXPECT_NEAR(of(run, "high", "stored_energy"), energy, 1e-12 * energy);
}

TEST(SuppliedEnergy, CountsPotentialsWithoutANameInTheSum) {
  const SceneRun run(
      cube(dielectric, rigid + "      - {where: y-, potential: 0}\n      - {where: y+, potential: {control: supply}}\n",
           supply("20 kV") + "statics: {steps: 3}\nrecord: {electric: [stored_energy, supplied_energy]}\n"));
  const double energy = 0.5 * permittivity * area / height * voltage * voltage;
  EXPECT_NEAR(run.value("statics/energy/supplied"), energy, 1e-12 * energy);
  EXPECT_NEAR(run.value("statics/energy/stored"), energy, 1e-12 * energy);
}

TEST(SuppliedEnergy, OfAGivenChargeIsThatOfTheChargedCapacitor) {
  const std::string steps = "{steps: [[0, ";  // a function of time, which statics scale
  for (const std::string& charged : {"    electrodes:\n      high: {where: y+, charge: " + steps + "8.0e-7]]}}\n",
                                     "      - {where: y+, surface_charge: " + steps + "2.0e-7]]}}\n"}) {
    const SceneRun run(cube(dielectric, rigid + "      - {where: y-, potential: 0}\n" + charged,
                            "statics: {steps: 3}\nrecord: {electric: [stored_energy, supplied_energy]}\n"));
    ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
    const double energy = 0.5 * 8e-7 * 8e-7 / (permittivity * area / height);
    EXPECT_NEAR(run.value("statics/energy/supplied"), energy, 1e-10 * energy);
    EXPECT_NEAR(run.value("statics/energy/stored"), energy, 1e-10 * energy);
  }
}

/// A cube that moves under a voltage that rises and falls; with a floating electrode in its middle.
SceneRun moving(const std::string& record) {
  return SceneRun(
      cube("viscous: {model: kelvin_voigt, viscosity: 0.05}, " + dielectric,
           on_rollers + two_electrodes + "      middle: {where: {plane: {y: 0}}, charge: 1.0e-7}\n",
           supply("{sine: {amplitude: 100 kV, frequency: 0.1}}") + "dynamics: {duration: 8, step: 0.1}\n" + record));
}

TEST(SuppliedEnergy, ClosesTheLedgerOfAMotionAsTheBalanceOfTheEnthalpyDoes) {
  const SceneRun run = moving(wanted);
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const auto row = [&](const char* name) { return Eigen::VectorXd(run.rows(std::string("energy/") + name).row(0)); };
  Eigen::VectorXd kept = row("kinetic") + row("elastic") + row("stored") + row("dissipated") - row("supplied");
  kept.array() -= kept[0];
  const double scale = row("stored").maxCoeff();
  EXPECT_GT(row("supplied").maxCoeff(), 0.5 * scale);
  EXPECT_LT((kept - row("balance")).lpNorm<Eigen::Infinity>(), 1e-11 * scale);
  EXPECT_GT(row("balance").lpNorm<Eigen::Infinity>(), 1e-6 * scale);  // the identity holds for any error of the step
  EXPECT_EQ(run.rows("electrodes/cube.middle/supplied_energy").cwiseAbs().maxCoeff(), 0.0);
  EXPECT_EQ(run.rows("electrodes/cube.low/supplied_energy").cwiseAbs().maxCoeff(), 0.0);
}

TEST(ElectricRecords, LeaveTheMotionAsItIs) {
  const SceneRun with = moving(wanted), without = moving("");
  const auto difference = with.rows("energy/elastic") - without.rows("energy/elastic");
  // Other solves for potentials lie between: round-off of their iteration.
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-12 * without.rows("energy/elastic").maxCoeff());
  EXPECT_THROW(without.rows("energy/supplied"), std::out_of_range);
  for (const auto& vector : without.recorder().checkpoint().reals) EXPECT_NE(vector.name, "supply");
}

}  // namespace
}  // namespace muldi
