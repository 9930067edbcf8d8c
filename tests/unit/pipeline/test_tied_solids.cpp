/// Solids that are fixed to bodies: what bodies feel, where solids start, what shocks are.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "solid_scene.hpp"

namespace muldi::test {
namespace {

using golden::SceneRun;

const std::string rubber = "elastic: {model: neo_hookean, mu: 0.2, poisson: 0.45}";
const std::string incompressible = "elastic: {model: neo_hookean, mu: 0.2, poisson: 0.5}";

/// The cube between ground and a body behind it, which `joint` carries.
std::string beside(const std::string& joint, const std::string& rest) {
  return "    attach:\n"
         "      - {where: x-, body: ground}\n"
         "      - {where: x+, body: plate}\n"
         "bodies:\n"
         "  plate: {mass: 2, inertia: [3, 4, 5], position: [1.5, 0.1, 0.2]}\n"
         "joints:\n"
         "  j: {" +
         joint + ", from: {body: ground, at: [1, 0, 0]}, to: {body: plate, at: [-0.5, -0.1, -0.2]}}\n" + rest;
}

TEST(TiedSolid, PullsItsBodyAsAPrescribedFaceIsHeld) {
  const std::string pulled =
      "controls: {pull: {force: 0.3}}\n"
      "loads: {l: {body: plate, at: [0, 0, 0], force: [1, 0, 0], control: pull}}\n"
      "statics: {steps: 3}\n"
      "record: {probes: {x: {distance: [\"cube@[-1, -1, -1]\", \"cube@[1, -1, -1]\"]}}}\n";
  const SceneRun tied(cube(rubber, beside("type: prismatic, axis: [1, 0, 0]", pulled), ""));
  ASSERT_TRUE(tied.outcome().completed()) << tied.outcome().sentence;
  const double stretch = tied.value("statics/joints/j/coordinate");
  const SceneRun held(cube(rubber,
                           "    conditions:\n"
                           "      - {where: x-, displacement: [0, 0, 0]}\n"
                           "      - {where: x+, displacement: [{control: move}, 0, 0]}\n",
                           "controls: {move: {displacement: " + std::to_string(stretch) +
                               "}}\n"
                               "statics: {steps: 3}\n"
                               "record: {probes: {r: {reaction: cube@x+, along: [1, 0, 0]}}}\n"));
  ASSERT_TRUE(held.outcome().completed());
  EXPECT_NEAR(held.value("statics/probes/r"), 0.3, 1e-5);  // `stretch` has six digits
  const Eigen::VectorXd force = tied.last("statics/ties/cube.plate/force");
  EXPECT_NEAR(force[0], -0.3, 1e-10);
  EXPECT_NEAR(force[1], 0.0, 1e-10);
  EXPECT_NEAR(tied.last("statics/ties/cube.ground/force")[0], 0.3, 1e-10);
  // The face follows the body to the last bit.
  EXPECT_NEAR(tied.value("statics/probes/x") - 2.0, stretch, 1e-14);
}

TEST(TiedSolid, JointCarriesWhatTheTiesLeave) {
  // Gravity bends the cube, which pulls the fixed plate: force and moment of joint, ties and weight balance.
  const SceneRun run(cube(rubber, beside("type: fixed", "gravity: [0, -0.01, 0]\nstatics: {steps: 1}\n"), ""));
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const Eigen::VectorXd tie = run.last("statics/ties/cube.plate/force");
  const Eigen::VectorXd moment = run.last("statics/ties/cube.plate/moment");
  const Eigen::VectorXd reaction = run.last("statics/joints/j/reaction");
  const double weight = 2 * 0.01;
  EXPECT_NEAR(reaction[0] + tie[0], 0.0, 1e-12);
  EXPECT_NEAR(reaction[1] + tie[1] - weight, 0.0, 1e-12);
  // About the centre of mass: the joint is at (-0.5, -0.1, -0.2) from it.
  const Eigen::Vector3d lever(-0.5, -0.1, -0.2);
  const Eigen::Vector3d of_joint =
      Eigen::Vector3d(reaction.tail<3>()) + lever.cross(Eigen::Vector3d(reaction.head<3>()));
  EXPECT_NEAR((of_joint + moment).norm(), 0.0, 1e-12);
  // Ground and plate carry the weight of the cube in equal parts.
  const double half = 0.5 * 8 * 1e-3 * 0.01;
  EXPECT_NEAR(tie[1], -half, 1e-12);
  EXPECT_NEAR(run.last("statics/ties/cube.ground/force")[1], -half, 1e-12);
}

class LedSolid : public ::testing::TestWithParam<const char*> {
 protected:
  static SceneRun turned(const std::string& initial, const std::string& joint = "type: revolute, axis: [0, 0, 1]") {
    return SceneRun(cube(std::string("elastic: {model: neo_hookean, mu: 0.2, poisson: ") + GetParam() + "}",
                         beside(joint, "initial: {" + initial + "}\ndynamics: {duration: 0.02, step: 0.01}\n"), ""));
  }
};

TEST_P(LedSolid, FollowsItsBodyToAnInitialPositionAndRestsThere) {
  const SceneRun up = turned("joints: {j: {position: 0.4}}");
  const SceneRun down = turned("joints: {j: {position: -0.4}}");
  ASSERT_TRUE(up.outcome().completed()) << up.outcome().sentence;
  const double energy = up.rows("energy/elastic")(0, 0);
  EXPECT_GT(energy, 0.05);
  EXPECT_NEAR(down.rows("energy/elastic")(0, 0), energy, 1e-9 * energy);  // by symmetry
  EXPECT_EQ(up.rows("energy/kinetic")(0, 0), 0.0);
  // The moment is the slope of the energies to which different ways have led.
  const double step = 1e-4;
  const double more = turned("joints: {j: {position: 0.4001}}").rows("energy/elastic")(0, 0);
  const double less = turned("joints: {j: {position: 0.3999}}").rows("energy/elastic")(0, 0);
  const double moment = (more - less) / (2.0 * step);
  EXPECT_GT(moment, 0.0);
  // At rest but for the bodies: all that is out of balance acts on the joint, as an angular acceleration.
  const double inertia = 5 + 2 * (0.25 + 0.01);
  const double acceleration = up.rows("joints/j/velocity")(0, 1) / 0.01;
  EXPECT_NEAR(-acceleration * inertia, moment, 0.02 * moment);
}

TEST_P(LedSolid, StartsWithItsBodyWithoutAJolt) {
  const SceneRun run = turned("joints: {j: {velocity: 0.01}}");
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const double of_plate = 0.5 * (5 + 2 * (0.25 + 0.01)) * 1e-4;
  const double of_cube = run.rows("energy/parts/solids/cube")(0, 0);
  EXPECT_GT(of_cube, 0.0);
  EXPECT_NEAR(run.rows("energy/kinetic")(0, 0), of_plate + of_cube, 1e-12 * of_plate);
}

TEST_P(LedSolid, ShockGivesTheWholeSystemItsMomentum) {
  const SceneRun run = turned("momentum: {j: 0.05}");
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  // 1/2 m qdot: of bodies and solids together.
  const double rate = run.rows("joints/j/velocity")(0, 0);
  EXPECT_NEAR(run.rows("energy/kinetic")(0, 0), 0.5 * 0.05 * rate, 1e-10 * 0.05 * rate);
  const double inertia = 5 + 2 * (0.25 + 0.01);
  EXPECT_LT(rate, 0.05 / inertia);
  EXPECT_GT(rate, 0.05 / (inertia + 0.02));  // the cube is light, and only its face has to follow at once
}

INSTANTIATE_TEST_SUITE_P(Poisson, LedSolid, ::testing::Values("0.45", "0.5"));

TEST(TiedSolid, FreeFlightIsRigidWhereTheBodyTurnsAsTheSolidDoes) {
  const std::string solid =
      "    attach: [{where: x+, body: plate}]\n"
      "bodies:\n"
      "  plate: {mass: 2, inertia: [3, 4, 5], position: [1.5, 0, 0]}\n"
      "initial: {bodies: {plate: {velocity: [0.2, 0.1, 0], angular_velocity: [0, 0, 0.05]}}}\n"
      "dynamics: {duration: 1, step: 0.05}\n";
  const SceneRun run(cube(rubber, solid, ""));
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const auto linear = run.rows("momentum/linear");
  const auto angular = run.rows("momentum/angular");
  // The velocity of the cube's centre 1.5 before that of the plate.
  EXPECT_NEAR(linear(0, 0), (2 + 8e-3) * 0.2, 1e-12);
  EXPECT_NEAR(linear(1, 0), 2 * 0.1 + 8e-3 * (0.1 - 0.05 * 1.5), 1e-12);
  for (Eigen::Index i = 1; i < linear.cols(); ++i) {
    EXPECT_NEAR((linear.col(i) - linear.col(0)).norm(), 0.0, 1e-11);
    EXPECT_NEAR((angular.col(i) - angular.col(0)).norm(), 0.0, 1e-10);
  }
}

TEST(TiedSolid, ThatFindsNoRestIsAnError) {
  const scene::Scene scene =
      cube(incompressible,
           beside("type: prismatic, axis: [1, 0, 0]",
                  "initial: {joints: {j: {position: -2.001}}}\ndynamics: {duration: 0.02, step: 0.01}\n"),
           "");
  try {
    const SceneRun run(scene);
    FAIL() << "no error";
  } catch (const base::InputError& error) {
    EXPECT_EQ(error.diagnostics().front().message,
              "the solids that are fixed to the bodies find no rest at the initial joint positions: "
              "give smaller ones");
  }
}

}  // namespace
}  // namespace muldi::test
