/// Motions of solids: initial velocities, reactions in time, cadence of fields, inversion.
#include <gtest/gtest.h>

#include "unit/pipeline/solid_scene.hpp"

namespace muldi {
namespace {

using golden::SceneRun;
using test::cube;
using test::last_field;

const std::string rubber = "elastic: {model: neo_hookean, mu: 0.2, poisson: 0.45}";

TEST(SolidMotion, InitialVelocityIsThatOfARigidBody) {
  const SceneRun run(cube(rubber, "    position: [3, 0, 0]\n",
                          "initial: {solids: {cube: {velocity: [0, 0.5, 0], angular_velocity: [0, 0, 0.25]}}}\n"
                          "dynamics: {duration: 0.1, step: 0.1}\n"
                          "record: {fields: {cube: [position, velocity]}}\n"));
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const double mass = 8e-3;
  const double inertia = mass * 4 / 6;  // m a^2 / 6
  const Eigen::VectorXd linear = run.rows("momentum/linear").col(0);
  const Eigen::VectorXd angular = run.rows("momentum/angular").col(0);
  EXPECT_NEAR((linear - Eigen::Vector3d(0, mass * 0.5, 0)).norm(), 0.0, 1e-16);
  EXPECT_NEAR((angular - Eigen::Vector3d(0, 0, 3 * mass * 0.5 + inertia * 0.25)).norm(), 0.0, 1e-16);
  const Eigen::Matrix3Xd x = run.rows("solids/cube/position").col(0).reshaped(3, 27);
  const Eigen::Matrix3Xd v = run.rows("solids/cube/velocity").col(0).reshaped(3, 27);
  for (Eigen::Index node = 0; node < 27; ++node) {
    EXPECT_NEAR(v(0, node), -0.25 * x(1, node), 1e-14);
    EXPECT_NEAR(v(1, node), 0.5 + 0.25 * (x(0, node) - 3), 1e-14);
  }
}

TEST(SolidMotion, PrescribedPositionsTakeNoPartInTheInitialVelocity) {
  const SceneRun run(cube(rubber, "    conditions:\n      - {where: x-, displacement: [0, ~, 0]}\n",
                          "initial: {solids: {cube: {velocity: [1, 2, 3]}}}\n"
                          "dynamics: {duration: 0.01, step: 0.01}\n"
                          "record: {probes: {held: {average: cube@x-, of: velocity},"
                          " corner: {point: \"cube@[1, 1, 1]\", of: velocity}}}\n"));
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  EXPECT_NEAR((run.rows("probes/held").col(0) - Eigen::Vector3d(0, 2, 0)).norm(), 0.0, 1e-14);
  EXPECT_NEAR((run.rows("probes/corner").col(0) - Eigen::Vector3d(1, 2, 3)).norm(), 0.0, 1e-14);
}

class Motions : public testing::TestWithParam<const char*> {};

TEST_P(Motions, ReactionsAreTheForcesOfTheDiscreteMotion) {
  const std::string formulation = GetParam();
  const std::string nu = formulation == "incompressible" ? "0.5}" : "0.45}";
  const double dt = 0.05;
  const SceneRun run(cube("elastic: {model: neo_hookean, mu: 0.2, poisson: " + nu,
                          "    formulation: " + formulation +
                              "\n    conditions:\n      - {where: y-, displacement: [0, 0, 0]}\n"
                              "      - {where: y+, traction: [0.02, -0.01, 0]}\n",
                          "gravity: [0, -2, 0]\n"
                          "dynamics: {duration: 1, step: 0.05}\n"
                          "record: {fields: {cube: [position]}, probes: {r: {reaction: cube@y-}}}\n",
                          "[1, 1, 1]"));
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  // The sum of all discrete equations of motion: internal forces cancel, each node of the one cell has 1/8 of the mass.
  const double mass = 8e-3;
  const Eigen::Vector3d load(0.02 * 4, -0.01 * 4 - mass * 2, 0);
  const auto x = run.rows("solids/cube/position");
  const auto centre = [&](Eigen::Index n) -> Eigen::Vector3d { return x.col(n).reshaped(3, 8).rowwise().mean(); };
  for (Eigen::Index n = 1; n < 20; ++n) {
    const Eigen::Vector3d force = mass * (centre(n + 1) - 2 * centre(n) + centre(n - 1)) / (dt * dt) - load;
    const Eigen::Vector3d reaction = run.rows("probes/r").col(n);
    EXPECT_NEAR((reaction - force).norm(), 0.0, 1e-9) << n;
  }
  const Eigen::Vector3d first = 2 * mass * (centre(1) - centre(0)) / (dt * dt) - load;  // starts at rest
  EXPECT_NEAR((Eigen::Vector3d(run.rows("probes/r").col(0)) - first).norm(), 0.0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Formulations, Motions, testing::Values("displacement", "mean_dilatation", "incompressible"));

TEST(SolidMotion, LastReactionAndPressureAreOneSidedValuesOfTheSame) {
  const auto end = [](const std::string& path, const std::string& step, const std::string& duration) {
    const SceneRun run(
        cube("elastic: {model: neo_hookean, mu: 0.2, poisson: 0.5}, viscous: {model: kelvin_voigt, viscosity: 0.1}",
             "    conditions:\n      - {where: y-, displacement: [0, 0, 0]}\n"
             "      - {where: y+, traction: [0, {sine: {amplitude: 0.02, frequency: 0.5}}, 0]}\n",
             "dynamics: {duration: " + duration + ", step: " + step +
                 "}\nrecord: {fields: {cube: [pressure]}, probes: {r: {reaction: cube@y-}}}\n"));
    const Eigen::Index n = static_cast<Eigen::Index>(std::lround(0.5 / std::stod(step)));
    return Eigen::VectorXd(run.rows(path).col(n));
  };
  for (const std::string path : {"probes/r", "solids/cube/pressure"}) {
    const double coarse = (end(path, "0.02", "0.5") - end(path, "0.02", "0.6")).norm();
    const double fine = (end(path, "0.01", "0.5") - end(path, "0.01", "0.6")).norm();
    EXPECT_NEAR(coarse / fine, 2.0, 0.2) << path;  // of first order: a quarter of a step earlier
    EXPECT_LT(fine, 0.05 * end(path, "0.01", "0.6").norm()) << path;
  }
}

TEST(SolidMotion, FieldsHaveACadenceOfTheirOwnAndTheLastState) {
  const SceneRun run(cube(rubber, "",
                          "dynamics: {duration: 1.1, step: 0.1}\n"
                          "record: {every: 2, fields: {cube: {fields: [position], every: 3}}}\n"));
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  EXPECT_EQ(run.n_rows("time"), 7U);  // 0, 0.2, ..., 1 and the last
  const Eigen::VectorXd times = run.rows("solids/cube/times").row(0);
  ASSERT_EQ(times.size(), 3);
  EXPECT_NEAR((times - Eigen::Vector3d(0, 0.6, 1.1)).norm(), 0.0, 1e-15);
  EXPECT_EQ(run.recorder().declared().fixed.size(), 2U);
  EXPECT_EQ(run.recorder().declared().fixed[0].spec.path, "solids/cube/reference");
  EXPECT_EQ(run.recorder().declared().fixed[1].spec.path, "solids/cube/cells");
}

TEST(SolidMotion, ProbesReachFromBodiesToSolids) {
  const SceneRun run(scene::read_scene_text(
      "muldi: 1\n"
      "materials: {m: {density: 1e-3, elastic: {model: neo_hookean, mu: 0.2, poisson: 0.45}}}\n"
      "bodies: {arm: {mass: 1, inertia: [1, 1, 1], position: [0, 5, 0], points: {tip: [1, -1, 0]}}}\n"
      "solids: {cube: {mesh: {box: {size: [2, 2, 2], cells: [1, 1, 1]}}, material: m}}\n"
      "initial: {bodies: {arm: {velocity: [0, 3, 0]}}}\n"
      "dynamics: {duration: 1, step: 0.1}\n"
      "record:\n"
      "  probes:\n"
      "    gap: {distance: [\"cube@[1, 1, -1]\", arm.tip], along: [0, 1, 0]}\n"
      "    way: {point: arm.tip, of: displacement}\n"
      "    speed: {point: arm.tip, of: velocity, along: [0, 2, 0]}\n",
      "scene.yaml"));
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const double start = run.rows("probes/gap")(0, 0);
  EXPECT_NEAR(run.value("probes/gap"), start + 3, 1e-12);
  EXPECT_NEAR(run.last("probes/way")[1], 3.0, 1e-12);
  EXPECT_NEAR(run.value("probes/speed"), 3.0, 1e-12);
}

TEST(SolidMotion, CellsInvertedAtTheEndOfAStepAreReported) {
  // From a height of 2 to -0.5 in one step: the middle, 0.75, is admissible.
  const SceneRun run(cube(rubber,
                          "    conditions:\n      - {where: y-, displacement: [0, 0, 0]}\n"
                          "      - {where: y+, displacement: [0, {table: [[0, 0], [0.1, -2.5]]}, 0]}\n",
                          "dynamics: {duration: 0.1, step: 0.1}\n", "[1, 1, 1]"));
  ASSERT_EQ(run.warnings().size(), 1U);
  EXPECT_EQ(run.warnings()[0], "at t = 0.1 ms: solid 'cube': cell 0 at [0, 0, 0] is inverted (det F -0.25)");
}

TEST(SolidMotion, ASolidThatInvertsSaysSo) {
  const SceneRun run(cube(rubber,
                          "    conditions:\n      - {where: y-, displacement: [0, 0, 0]}\n"
                          "      - {where: y+, displacement: [0, {table: [[0, 0], [1, -4]]}, 0]}\n",
                          "dynamics: {duration: 1, step: 0.1}\n", "[1, 1, 1]"));
  EXPECT_EQ(run.outcome().status, variational::Status::inverted_element);
  EXPECT_EQ(variational::name_of(run.outcome().status), "inverted_element");
  EXPECT_NE(run.outcome().sentence.find("solid 'cube': cell 0 at [0, 0, 0] is inverted"), std::string::npos)
      << run.outcome().sentence;
}

}  // namespace
}  // namespace muldi
