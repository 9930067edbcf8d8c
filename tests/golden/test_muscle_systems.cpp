/// The revolute joint and the elephant trunk: reference-results A and E.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/text.hpp"
#include "scene_run.hpp"

namespace muldi::golden {
namespace {

TEST(RevoluteJoint, SettlesAtTheAngleOfTheReference) {
  const double angle = SceneRun("revolute_joint_lumped").value("statics/joints/hinge/coordinate") / degree;
  EXPECT_NEAR(angle, 7.7284947404, 5e-11);
  EXPECT_NEAR(angle, 7.73, 5e-3);  // as published
}

TEST(RevoluteJoint, SettlesAtTheAngleOfTheReferenceWithAHigherPermittivity) {
  const SceneRun run("revolute_joint_lumped", {"materials.silicone.electric.relative_permittivity=3.7"});
  EXPECT_NEAR(run.value("statics/joints/hinge/coordinate") / degree, 9.5077006219, 5e-11);
}

TEST(RevoluteJoint, CoarseStepDiffersFromTheFineOneAsInTheReference) {
  const SceneRun fine("revolute_joint_lumped");
  const SceneRun coarse("revolute_joint_lumped", {"dynamics.step=10 ms"});
  const auto a = fine.rows("joints/hinge/coordinate"), b = coarse.rows("joints/hinge/coordinate");
  ASSERT_EQ(a.cols(), 1001);
  ASSERT_EQ(b.cols(), 101);
  double largest = 0.0;
  for (Eigen::Index i = 0; i < b.cols(); ++i) largest = std::max(largest, std::abs(b(0, i) - a(0, 10 * i)) / degree);
  EXPECT_NEAR(largest, 0.097976, 5e-7);
}

TEST(ElephantTrunk, SettlesAtTheAnglesAndTheTipOfTheReference) {
  const SceneRun run("elephant_trunk_lumped", {"dynamics.duration=1 ms"});
  for (int joint = 1; joint <= 6; ++joint) {
    const double angle = run.value(base::format("statics/joints/joint{}/coordinate", joint)) / degree;
    EXPECT_NEAR(angle, 9.507700621871, 5e-11) << joint;
  }
  const Eigen::Vector3d tip = run.last("statics/points/segment6.rho6");
  const Eigen::Vector3d reference(-95.8649066679, 274.0421097373, 73.0752202916);
  EXPECT_LT((tip - reference).norm(), 1e-9);
  // The printed tip is an unsettled sample.
  EXPECT_NEAR((tip - Eigen::Vector3d(-95.8341, 274.054, 73.0747)).norm(), 0.033, 5e-4);
}

TEST(ElephantTrunk, SlowestModeHalvesAsInTheReference) {
  const SceneRun run("elephant_trunk_lumped", {"dynamics.duration=30 s"});
  const double rest = run.value("statics/joints/joint1/coordinate");
  const auto t = run.rows("time");
  const Eigen::VectorXd away = run.rows("joints/joint1/coordinate").row(0).transpose().array() - rest;
  // Turning points of the decaying oscillation, from parabolas through three rows.
  std::vector<std::pair<double, double>> peaks;
  for (Eigen::Index i = 1; i + 1 < away.size(); ++i) {
    const double left = away[i] - away[i - 1], right = away[i + 1] - away[i];
    if (left * right > 0.0) continue;
    const double shift = 0.5 * (left + right) / (left - right);
    peaks.emplace_back(t(0, i) + shift * (t(0, i) - t(0, i - 1)), std::abs(away[i] + 0.25 * (left + right) * shift));
  }
  // The first ones hold faster modes; an even number of half swings between the two that are compared.
  ASSERT_GT(peaks.size(), 16U);
  const auto& [t1, first] = peaks[4];
  const auto& [t2, last] = peaks[16];
  const double half_life = (t2 - t1) * std::log(2.0) / std::log(first / last);
  EXPECT_NEAR(half_life, 1381.0, 1.0);
}

/// The trunk with a control for each muscle, bent by initial joint positions.
SceneRun bent_trunk() {
  const double fields[] = {30, 5, 10, 20, 0, 40, 25, 15, 35, 0, 12, 8};
  const double angles[] = {0.1, -0.05, 0.2, 0.15, -0.1, 0.05};
  Overrides overrides{"dynamics.duration=1 ms"};
  std::string controls = "controls={", joints = "initial={joints: {";
  for (int k = 1; k <= 12; ++k) {
    controls += base::format("c{}: {{field: {} kV/mm}}, ", k, fields[k - 1]);
    overrides.push_back(base::format("muscles.m{0}.control=c{0}", k));
  }
  for (int k = 1; k <= 6; ++k) joints += base::format("joint{}: {{position: {}}}, ", k, angles[k - 1]);
  overrides.push_back(controls + "}");
  overrides.push_back(joints + "}}");
  return SceneRun("elephant_trunk_lumped", overrides);
}

TEST(ElephantTrunk, HasTheKinematicsAndThePotentialOfTheReference) {
  const SceneRun run = bent_trunk();
  const Eigen::Vector3d tip = run.rows("points/segment6.rho6").col(0);
  // Printed to ten digits.
  EXPECT_LT((tip - Eigen::Vector3d(-60.05429896, 297.7868222, 12.75517058)).norm(), 1e-7);
  const double lengths[] = {49.228435312289, 50.726610060859, 50.369262351521, 49.619490484388};
  for (int k = 1; k <= 4; ++k) {
    const double length = run.rows(base::format("muscles/m{}/length", k))(0, 0);
    EXPECT_NEAR(length, lengths[k - 1], 1e-12);
  }
  const double potential = run.rows("energy/elastic")(0, 0) + run.rows("energy/electric")(0, 0);
  EXPECT_NEAR(potential, -212.333425162110, 1e-11);
}

/// Work of the switches: the supply gives half of C U^2 where it charges and takes it where it discharges; while the
/// voltage stays, U^2 times the change of C flows.
TEST(EnergyHarvester, GainsTheWorkOfItsCyclesByTheClosedForm) {
  const SceneRun run("energy_harvester");
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const auto stretch = run.rows("muscles/muscle/stretch").row(0);
  const auto voltage = run.rows("muscles/muscle/layer_voltage").row(0);
  const double volume = std::numbers::pi * 25.0 * 40.0, field = 600.0 / 0.05;
  const double scale = 0.5 * volume * 3.7 * 8.8542e-12 * field * field;
  double gain = 0.0;
  int switches = 0;
  // The voltage of a row is that of the interval that ends there.
  for (Eigen::Index i = 1; i < stretch.cols(); ++i) {
    if (voltage[i] == voltage[i - 1]) continue;
    ++switches;
    gain += (voltage[i] > 0.0 ? 1.0 : -1.0) * scale / (stretch[i - 1] * stretch[i - 1]);
  }
  EXPECT_EQ(switches, 12);
  EXPECT_GT(gain, 8.0);
  const double supplied = run.value("muscles/muscle/supplied_energy");
  EXPECT_NEAR(-supplied, gain, 1e-12 * gain);
  EXPECT_EQ(supplied, run.value("energy/supplied"));
  const double capacitance = 3.7 * 8.8542e-12 * std::numbers::pi * 25.0 / 0.05;
  EXPECT_NEAR(run.rows("muscles/muscle/capacitance")(0, 0), capacitance, 1e-12 * capacitance);
}

TEST(EnergyHarvester, TakesItsGainFromTheMotion) {
  const SceneRun run("energy_harvester");
  const auto total = run.rows("energy/total").row(0);
  // Without voltage at the begin and the end; the error is that of the energy of the step.
  const double lost = total[0] - total[total.cols() - 1];
  EXPECT_NEAR(lost, -run.value("energy/supplied"), 5e-4);
  EXPECT_NEAR(lost + run.value("energy/supplied"), -run.value("energy/balance"), 1e-11);
}

/// Muscles of either model of the joint, under a field that grows: a stiff machine keeps them near their shape.
TEST(RevoluteJointTwin, RecordsTheSameElectricFiguresOfBothModels) {
  const auto run = [](const std::string& model) {
    return SceneRun("revolute_joint_twin",
                    {"muscles.upper.model=" + model, "muscles.lower.model=" + model,
                     "muscles.upper.layer_thickness=50 um", "muscles.upper.lumped={}", "dynamics.duration=1 ms",
                     "record.electric=[capacitance, stored_energy, supplied_energy]"});
  };
  const SceneRun lumped = run("lumped"), fe = run("fe");
  const double octagon = 2.0 * std::numbers::sqrt2 / std::numbers::pi;  // its area by that of the circle
  const auto both = [&](const std::string& what, Eigen::Index row, double within) {
    const double wanted = octagon * lumped.rows("statics/muscles/upper/" + what)(0, row);
    EXPECT_NEAR(fe.rows("statics/muscles/upper/" + what)(0, row), wanted, within * std::abs(wanted)) << what;
  };
  both("capacitance", 0, 1e-12);  // of the undeformed muscle
  both("charge", 6, 0.01);        // its ends are held
  both("capacitance", 6, 0.01);
  both("stored_energy", 6, 0.01);
  both("supplied_energy", 6, 0.01);
  EXPECT_EQ(fe.value("statics/muscles/lower/supplied_energy"), 0.0);
  const double charge = fe.value("statics/muscles/upper/capacitance") * fe.value("statics/muscles/upper/layer_voltage");
  EXPECT_NEAR(fe.value("statics/muscles/upper/charge"), charge, 1e-12 * charge);
}

}  // namespace
}  // namespace muldi::golden
