/// A homogeneous stretch goes through joints of any meshes (patch tests).
#include <gtest/gtest.h>

#include "attached_scene.hpp"

namespace muldi::test {
namespace {

using golden::SceneRun;

/// Cells of two cubes, the second attached to the first.
struct Pair {
  const char* name;
  const char* low;
  const char* up;
};

/// Fails unless one and the same F = diag(a, a, c) is in both, positions being F X, under a traction of 0.1.
void expect_homogeneous_stretch(const SceneRun& run) {
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const Eigen::Matrix3Xd of_up = reference(run, "up");
  const Eigen::Vector3d corner = run.last("statics/solids/up/position").tail<3>();
  const Eigen::Vector3d stretch = corner.cwiseQuotient(of_up.rightCols<1>());
  EXPECT_GT(stretch[2], 1.1);
  for (const char* name : {"low", "up"}) {
    const std::string folder = std::string("statics/solids/") + name + "/";
    const Eigen::Matrix3Xd X = reference(run, name);
    const Eigen::VectorXd last = run.last(folder + "position");
    const auto x = last.reshaped(3, X.cols());
    EXPECT_LT((x - stretch.asDiagonal() * X).cwiseAbs().maxCoeff(), 1e-11) << name;
    const Eigen::VectorXd stress = run.last(folder + "stress");
    for (Eigen::Index cell = 0; cell < stress.size() / 6; ++cell) {
      EXPECT_NEAR(stress[6 * cell + 2] * stretch[0] * stretch[1], 0.1, 1e-10);
    }
  }
}

/// A cube on another one, stretched along z; `lines`: conditions of each of them.
SceneRun stretched_pair(const Pair& pair, const std::string& centre, const std::string& lines) {
  return SceneRun(boxes({{"low", "[1, 1, 1]", pair.low, "[" + centre + ", 0.5]",
                          "    conditions:\n      - {where: z-, displacement: [~, ~, 0]}\n" + lines},
                         {"up", "[1, 1, 1]", pair.up, "[" + centre + ", 1.5]",
                          "    conditions:\n      - {where: z+, traction: [0, 0, 0.1]}\n" + lines +
                              "    attach: [{where: z-, solid: low, where_other: z+}]\n"}},
                        "elastic: {model: neo_hookean, mu: 0.2, poisson: 0.4}", "mean_dilatation",
                        "statics: {steps: 1}\nrecord: {fields: {low: [position, stress], up: [position, stress]}}\n"
                        "solver: {tolerance: 1e-13}\n"));
}

class StretchedPair : public ::testing::TestWithParam<Pair> {};

TEST_P(StretchedPair, PassesAHomogeneousStretch) {
  expect_homogeneous_stretch(
      stretched_pair(GetParam(), "0.5, 0.5",
                     "      - {where: x-, displacement: [0, ~, ~]}\n      - {where: y-, displacement: [~, 0, ~]}\n"));
}

TEST(HeldPair, PassesAHomogeneousStretchWithPointsOfTheJointThatAreHeldOnBothSides) {
  expect_homogeneous_stretch(stretched_pair({"", "[4, 2, 2]", "[6, 4, 2]"}, "0, 0",
                                            "      - {where: {point: [0, 0, 1]}, displacement: [0, 0, ~]}\n"
                                            "      - {where: {point: [0.5, 0, 1]}, displacement: [~, 0, ~]}\n"));
}

INSTANTIATE_TEST_SUITE_P(Meshes, StretchedPair,
                         ::testing::Values(Pair{"TheOneRefinesTheOther", "[2, 3, 2]", "[4, 6, 3]"},
                                           Pair{"NeitherRefinesTheOther", "[2, 2, 2]", "[3, 3, 2]"},
                                           Pair{"TheCoarserIsAttached", "[4, 3, 2]", "[2, 2, 2]"},
                                           Pair{"InOneDirectionOnly", "[3, 2, 2]", "[4, 4, 2]"},
                                           Pair{"AStripOfOneCell", "[3, 1, 2]", "[5, 1, 2]"}),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace muldi::test
