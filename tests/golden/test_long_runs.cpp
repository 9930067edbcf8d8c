/// Long runs of finite-element muscles on bodies (thesis 5.4.1, 8.3.2): energies over five seconds, and the whole
/// motion of the trunk.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "base/text.hpp"
#include "scene_run.hpp"
#include "support/figure.hpp"

namespace muldi::golden {
namespace {

/// Largest error of the total energy in percent of its initial value, and the largest kinetic energy.
struct EnergyError {
  double percent = 0.0;
  double of_first_second = 0.0;
  double kinetic = 0.0;
};

EnergyError energy_error(const std::string& duration, const std::string& step) {
  const SceneRun run("revolute_joint_fe", {"record.every=1", "dynamics.duration=" + duration, "dynamics.step=" + step});
  EXPECT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const auto total = run.rows("energy/total"), time = run.rows("time");
  EnergyError error{.kinetic = run.rows("energy/kinetic").maxCoeff()};
  for (Eigen::Index i = 0; i < total.cols(); ++i) {
    const double here = 100.0 * std::abs(total(0, i) / total(0, 0) - 1.0);
    error.percent = std::max(error.percent, here);
    if (time(0, i) <= 1000.0) error.of_first_second = std::max(error.of_first_second, here);
  }
  return error;
}

TEST(RevoluteJointFeLong, EnergyErrorOverFiveSecondsIsBoundedAndWithinThePublishedOne) {
  const EnergyError coarse = energy_error("5 s", "2 ms"), fine = energy_error("5 s", "1 ms");
  // Published 9.61e-5 and 2.29e-5 %; an independent program has 20 to 35 % less, and so have we.
  test::record_figure("34", "energy error over 5 s at 2 ms, percent (published)", coarse.percent, 9.61e-5);
  EXPECT_NEAR(coarse.percent, 7.58e-5, 0.02e-5);  // recorded
  test::record_figure("34", "energy error over 5 s at 1 ms, percent (published)", fine.percent, 2.29e-5);
  EXPECT_NEAR(fine.percent, 1.88e-5, 0.02e-5);  // recorded
  EXPECT_NEAR(coarse.percent / fine.percent, 4.0, 0.2);
  // No drift: the first of five seconds has nearly the largest error.
  EXPECT_LT(coarse.percent, 1.15 * coarse.of_first_second);
  EXPECT_LT(fine.percent, 1.15 * fine.of_first_second);
  EXPECT_NEAR(fine.kinetic, 10.3, 0.1);
}

TEST(RevoluteJointFeLong, EnergyErrorAtATenthOfAMillisecondIsTheSquareOfTheStepBelow) {
  const EnergyError fine = energy_error("1 s", "1 ms"), finest = energy_error("1 s", "0.1 ms");
  // Published over 5 s; most of it comes in the first second.
  test::record_figure("34", "energy error over 1 s at 0.1 ms, percent (published)", finest.percent, 2.88e-7);
  // Second order; the published ones have 79.5.
  test::record_near("34", "energy error at 1 ms over that at 0.1 ms", fine.percent / finest.percent, 100.0, 3.0);
  EXPECT_NEAR(finest.percent, 1.87e-7, 0.1e-7);  // recorded over 5 s
}

TEST(ElephantTrunkFeLong, RestsWithAllItsJointsAlikeAndBentLessThanTheLumpedOne) {
  const SceneRun run("elephant_trunk_fe", {"statics={steps: 3}", "dynamics={duration: 1 ms, step: 1 ms}"});
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  // Without gravity every joint balances its own two muscles. Mesh: scenes/ELEPHANT_TRUNK.md.
  for (int joint = 1; joint <= 6; ++joint) {
    const double angle = run.value(base::format("statics/joints/joint{}/coordinate", joint)) / degree;
    EXPECT_NEAR(angle, 6.942376146744, 1e-9) << joint;  // recorded
    EXPECT_LT(angle, 9.507700621871) << joint;          // lumped
  }
  const Eigen::Vector3d tip(-71.91451326, 288.70338654, 54.40237457);  // recorded
  EXPECT_LT((run.last("statics/points/segment6.rho6") - tip).norm(), 1e-7);
}

TEST(ElephantTrunkFeLong, SwingsForTenSecondsAboutItsEquilibrium) {
  const SceneRun run("elephant_trunk_fe");
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  EXPECT_LT(run.rows("solver/constraint_violation").maxCoeff(), 1e-11);
  // Dissipation takes what the motion has: the power balance stays a small part of it.
  EXPECT_LT(run.rows("energy/balance").array().abs().maxCoeff(), 1e-2 * run.value("energy/dissipated"));
  // The slowest mode halves in about 1.4 s: after ten seconds it is within a few percent of the angle of rest, 6.942
  // degrees.
  for (int joint = 1; joint <= 6; ++joint) {
    const auto angle = run.rows(base::format("joints/joint{}/coordinate", joint));
    EXPECT_NEAR(angle.rightCols(100).mean() / degree, 6.942, 0.15) << joint;
  }
}

TEST(RevoluteJointTwinLong, MusclesThatPullInEndTheLoadStepsWhereTheArcLengthTurns) {
  const SceneRun run("revolute_joint_twin",
                     {"dynamics.duration=1 ms", "statics={control: agonist, from: 40 kV/mm, to: 60 kV/mm, steps: 2}"});
  EXPECT_EQ(run.outcome().status, variational::Status::loss_of_equilibrium);
  const double critical = 59101.858;  // recorded, by continuation: arc_length from 0 to 120 kV/mm
  EXPECT_LT(run.attribute("statics", "critical_load_above"), critical);
  EXPECT_GT(run.attribute("statics", "critical_load_below"), critical);
  // The last good state is on record, and is the last.
  EXPECT_EQ(run.value("statics/load"), run.attribute("statics", "critical_load_above"));
  EXPECT_NEAR(run.value("statics/joints/hinge/coordinate") / degree, 61.7, 0.5);  // of the curve at its limit
}

/// The generator with a muscle of finite elements.
struct Harvest {
  explicit Harvest(const std::string& step)
      : run("energy_harvester", {"muscles.muscle.model=fe", "record.every=1", "dynamics.step=" + step}) {
    EXPECT_TRUE(run.outcome().completed()) << run.outcome().sentence;
    supplied = run.value("energy/supplied");
    balance = run.rows("energy/balance").array().abs().maxCoeff();
  }
  SceneRun run;
  double supplied = 0.0;
  double balance = 0.0;
};

TEST(EnergyHarvesterLong, AMuscleOfFiniteElementsGainsTheWorkOfItsSwitches) {
  const Harvest coarse("0.2 ms"), fine("0.1 ms");
  EXPECT_EQ(fine.run.warnings(), std::vector<std::string>{});
  // Without voltage at both ends: what the motion has lost is in the supply, but for the error of the step.
  const auto total = fine.run.rows("energy/total").row(0);
  EXPECT_NEAR(total[0] - total[total.cols() - 1], -fine.supplied, fine.balance);
  EXPECT_NEAR(coarse.balance / fine.balance, 4.0, 0.2);
  EXPECT_LT(fine.balance, 1e-5);
  EXPECT_NEAR(coarse.supplied, fine.supplied, 2e-3);

  const auto stretch = fine.run.rows("muscles/muscle/stretch").row(0);
  const auto voltage = fine.run.rows("muscles/muscle/layer_voltage").row(0);
  const auto charge = fine.run.rows("muscles/muscle/charge").row(0);
  const auto capacitance = fine.run.rows("muscles/muscle/capacitance").row(0);
  // Of a layer of the octagon at rest; 800 layers.
  const double at_rest = 3.7 * 8.8542e-12 * 2.0 * std::numbers::sqrt2 * 25.0 / 0.05, layers = 40.0 / 0.05;
  double gain = 0.0, of_prism = 0.0;
  for (Eigen::Index i = 1; i < stretch.cols(); ++i) {
    EXPECT_NEAR(charge[i], capacitance[i] * voltage[i], 1e-12 * capacitance[i] * 600.0) << i;
    // Layers share the stretch unequally near the clamped ends: the mean of 1/L^2 is above the square of that of L.
    const double prism = at_rest / (stretch[i] * stretch[i]);
    EXPECT_GT(capacitance[i], (1.0 - 1e-9) * prism) << i;
    EXPECT_LT(capacitance[i], 1.003 * prism) << i;
    if (voltage[i] == voltage[i - 1]) continue;
    // Charging takes C U^2 from the supply, of which half is stored; discharging returns it, and held voltage U^2 dC.
    const double work = (voltage[i] > 0.0 ? 0.5 : -0.5) * layers * 600.0 * 600.0;
    gain += work * capacitance[i - 1];
    of_prism += work * at_rest / (stretch[i - 1] * stretch[i - 1]);
  }
  EXPECT_NEAR(-fine.supplied, gain, 1e-9 * gain);
  EXPECT_NEAR(gain, of_prism, 0.01 * of_prism);  // 4.456 mJ
  EXPECT_NEAR(gain, 4.432, 1e-3);                // recorded

  // Why not the 8.71 mJ of the lumped muscle: the section is an octagon, softer by its area. A lumped muscle of that
  // area swings slower still, because nothing clamps its ends, and comes still later to its switches.
  const SceneRun octagon("energy_harvester",
                         {base::format("muscles.muscle.section.diameter={}",
                                       10.0 * std::sqrt(2.0 * std::numbers::sqrt2 / std::numbers::pi))});
  EXPECT_LT(-octagon.value("energy/supplied"), gain);
  EXPECT_LT(gain, -SceneRun("energy_harvester").value("energy/supplied"));
}

/// Equilibria of the twin along its agonist's field, past its limit.
Overrides along_the_curve(int steps) {
  return {"dynamics.duration=1 ms",
          base::format("statics={{control: agonist, to: 120 kV/mm, steps: {}, continuation: arc_length}}", steps)};
}

/// Largest difference of the recorded energy to the integral of dPi/dE = 2 Pi_el/E along the curve: at an equilibrium,
/// stable or not, the energy changes with the field alone. By trapezoids, in mJ.
double energy_gap(const SceneRun& run) {
  const auto field = run.rows("statics/load"), total = run.rows("statics/energy/total");
  const auto electric = run.rows("statics/energy/electric");
  double integral = 0.0, gap = 0.0;
  for (Eigen::Index k = 1; k < field.cols(); ++k) {
    const auto slope = [&](Eigen::Index i) { return field(0, i) > 0.0 ? 2.0 * electric(0, i) / field(0, i) : 0.0; };
    integral += 0.5 * (slope(k) + slope(k - 1)) * (field(0, k) - field(0, k - 1));
    gap = std::max(gap, std::abs(total(0, k) - total(0, 0) - integral));
  }
  return gap;
}

TEST(RevoluteJointTwinLong, FiniteElementsPassTheirLimitUntilOneCellGivesWay) {
  const SceneRun run("revolute_joint_twin", along_the_curve(30));
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  EXPECT_EQ(
      run.warnings(),
      (std::vector<std::string>{
          "statics: the load turns at the limit point 59101.85837 V/mm of 'agonist': loaded beyond it, the system "
          "jumps (pull-in, snap-through); dynamics shows where to, and statics/stable marks the rows of this curve "
          "that are stable",
          "statics: the curve ends at the load 49121.72513: cell 4 at [-3.478, 17.13, 2.134] of solid 'upper' "
          "gives way alone: it keeps its volume as a whole, but of the part at one of its Gauss points 0.0999 is "
          "left, squeezed to stretch 0.0499; what follows depends on the mesh"}));
  const auto field = run.rows("statics/load"), angle = run.rows("statics/joints/hinge/coordinate");
  const auto stable = run.recorder().integers("statics/stable");
  Eigen::Index top = 0;
  field.row(0).maxCoeff(&top);
  EXPECT_GT(field.cols(), top + 20);
  for (Eigen::Index k = 0; k < field.cols(); ++k) {
    EXPECT_EQ(stable[static_cast<std::size_t>(k)] != 0, k <= top) << field(0, k);
  }
  EXPECT_LT(angle.rightCols<1>()[0], 0.6 * angle.maxCoeff());  // the joint swings back
  // Closed form of the energy's slope; the rest is the trapezoids'.
  const double coarse = energy_gap(run), fine = energy_gap(SceneRun("revolute_joint_twin", along_the_curve(60)));
  EXPECT_LT(coarse, 2e-4 * std::abs(run.rows("statics/energy/total").minCoeff()));
  EXPECT_NEAR(coarse / fine, 4.0, 0.3);
}

/// The value of a row of `y` where `x` passes `wanted` between columns k and k + 1, by the cubic through four columns.
double interpolated(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, double wanted, Eigen::Index k) {
  double value = 0.0;
  for (Eigen::Index i = k - 1; i <= k + 2; ++i) {
    double weight = 1.0;
    for (Eigen::Index j = k - 1; j <= k + 2; ++j) {
      if (j != i) weight *= (wanted - x(0, j)) / (x(0, i) - x(0, j));
    }
    value += weight * y(0, i);
  }
  return value;
}

/// Where a row of `x` passes `wanted`, in order: the values of `y`.
std::vector<double> passages(const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, double wanted) {
  std::vector<double> found;
  for (Eigen::Index k = 1; k + 2 < x.cols(); ++k) {
    if ((x(0, k) - wanted) * (x(0, k + 1) - wanted) <= 0.0) found.push_back(interpolated(x, y, wanted, k));
  }
  return found;
}

TEST(RevoluteJointTwinLong, BothBranchesAreWhereATorqueAtTheHingeVanishes) {
  const auto passed = [](const Overrides& overrides, double load) {
    const SceneRun run("revolute_joint_twin", overrides);
    return passages(run.rows("statics/load"), run.rows("statics/joints/hinge/coordinate") / degree, load);
  };
  for (const double field : {58000.0, 57000.0}) {
    const auto by_field = passed(along_the_curve(120), field);
    const auto by_torque = passed(
        {"dynamics.duration=1 ms", "joints.hinge.torque={control: drive}",
         base::format("controls={{agonist: {{field: {}}}, antagonist: {{field: 0}}, drive: {{torque: 0}}}}", field),
         "statics={control: drive, from: -10, to: 50, steps: 120, continuation: arc_length}"},
        0.0);
    ASSERT_EQ(by_field.size(), 2U);
    ASSERT_EQ(by_torque.size(), 2U);
    EXPECT_NEAR(by_field[0], by_torque[0], 5e-5) << field;
    EXPECT_NEAR(by_field[1], by_torque[1], 5e-5) << field;
    EXPECT_GT(std::abs(by_field[1] - by_field[0]), 4.0);
  }
}

TEST(RevoluteJointTwinLong, ADampedMotionEndsOnTheStableBranch) {
  const SceneRun run("revolute_joint_twin",
                     {"controls.agonist.field=50 kV/mm", "materials.silicone.viscous.viscosity=40",
                      "dynamics={duration: 1.5 s, step: 0.5 ms}", "record.every=100"});
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const auto angle = run.rows("joints/hinge/coordinate") / degree;
  // The slowest mode decays by the same ratio between records: Aitken's limit.
  const Eigen::Index n = angle.cols() - 1;
  const double last = angle(0, n) - angle(0, n - 1), before = angle(0, n - 1) - angle(0, n - 2);
  const double limit = angle(0, n) - last * last / (last - before);
  EXPECT_NEAR(limit, run.value("statics/joints/hinge/coordinate") / degree, 1e-4);
  EXPECT_NEAR(limit, 29.3523, 1e-4);  // recorded, of the static curve
}

/// Kinetic energy at the end over that at the beginning, of a small motion about the equilibrium; infinite if the run
/// fails. `share`: of the step h sqrt(rho/s) with the height of a layer and the Maxwell stress eps E^2.
double growth(double field, double density, double share) {
  const double stress = 3.7 * 8.8542e-12 * field * field;
  const double step = 1e-4 * std::floor(1e4 * share * 100.0 / 23.0 * std::sqrt(density / stress));
  const SceneRun run(
      "revolute_joint_twin",
      {"initial={from: static_equilibrium, momentum: {hinge: 1}}", "materials.silicone.viscous.viscosity=0.01",
       base::format("materials.silicone.density={}", density), base::format("controls.agonist.field={}", field),
       "statics.steps=4", "record.every=1",
       base::format("dynamics={{duration: {:.6f}, step: {:.6f}}}", 120 * step, step)});
  const auto kinetic = run.rows("energy/kinetic");
  return run.outcome().completed() ? kinetic.rightCols<1>()[0] / kinetic(0, 0) : HUGE_VAL;
}

/// lib/THEORY.md, 9: pressures act at nodes in time, the other stresses between them.
TEST(RevoluteJointTwinLong, StressedCellsOfConstantVolumeBoundTheStep) {
  for (const auto& [field, density] : {std::pair(3e4, 1e-3), std::pair(1.5e4, 1e-3), std::pair(3e4, 4e-3)}) {
    EXPECT_LT(growth(field, density, 0.8), 1.0) << field << ' ' << density;
    EXPECT_GT(growth(field, density, 1.25), 1.0) << field << ' ' << density;
  }
}

}  // namespace
}  // namespace muldi::golden
