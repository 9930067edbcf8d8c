/// Positions that controls move: their velocities, the work they do, and starts and kinks of their motion.
#include <gtest/gtest.h>

#include "unit/pipeline/solid_scene.hpp"

namespace muldi {
namespace {

using golden::SceneRun;
using test::cube;

const std::string rubber = "elastic: {model: neo_hookean, mu: 0.2, poisson: 0.45}";

std::string formula(const std::string& text) { return "{expression: '" + text + "', unit: mm}"; }

/// A cube of which every node goes along x as `motion` says.
SceneRun carried(const std::string& motion, const std::string& rest, const std::string& material = rubber) {
  return SceneRun(cube(material,
                       "    conditions: [{where: x-, displacement: [{control: c}, ~, ~]},\n                 {where: "
                       "x+, displacement: [{control: c}, ~, ~]}]\n",
                       "controls: {c: {displacement: " + motion + "}}\n" + rest, "[1, 1, 1]"));
}

const std::string mass_recorded =
    "record: {probes: {r: {reaction: cube@x-}, q: {reaction: cube@x+}, v: {average: cube@x-, of: velocity}}}\n";

TEST(PrescribedMotion, WorkOfASteadyAccelerationIsTheKineticEnergy) {
  const SceneRun run = carried(formula("0.3*t^2"), "dynamics: {duration: 1, step: 0.1}\n" + mass_recorded);
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const double mass = 8e-3;
  const auto external = run.rows("energy/external").row(0), balance = run.rows("energy/balance").row(0);
  const Eigen::MatrixXd force = run.rows("probes/r") + run.rows("probes/q"), velocity = run.rows("probes/v");
  // Positions are placed 1e-9 of a step before its end, which the bounds allow for.
  for (Eigen::Index i = 0; i < external.size(); ++i) {
    const double v = 0.6 * 0.1 * static_cast<double>(i);
    EXPECT_NEAR(velocity(0, i), v, 1e-10);
    EXPECT_NEAR(force(0, i), mass * 0.6, 1e-10);  // at the first and the last node too
    EXPECT_NEAR(external[i], 0.5 * mass * v * v, 1e-12);
    EXPECT_NEAR(balance[i], 0.0, 1e-12);
  }
}

TEST(PrescribedMotion, ABlowDoesTheWorkOfTheMeanVelocity) {
  // From rest to 0.5 mm/ms at a node, and to rest again.
  const SceneRun run = carried("{ramp: {from: 0, to: 0.2, start: 0.3, over: 0.4}}",
                               "dynamics: {duration: 1, step: 0.1}\n" + mass_recorded);
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const double kinetic = 0.5 * 8e-3 * 0.25;
  for (const double t : {0.1, 0.2, 0.4, 0.5, 0.6, 0.8, 0.9, 1.0}) {
    const double wanted = t > 0.35 && t < 0.65 ? kinetic : 0.0;
    EXPECT_NEAR(run.value_at("energy/kinetic", t), wanted, 1e-12) << t;
    EXPECT_NEAR(run.value_at("energy/external", t), wanted, 1e-12) << t;
  }
  // In the middle of the blow the velocity is the mean.
  EXPECT_NEAR(run.value_at("probes/v", 0.3), 0.25, 1e-9);
}

TEST(PrescribedMotion, ASolidThatFliesWithItsMovingFaceIsNotDeformed) {
  for (const std::string formulation : {"displacement, poisson: 0.3", "incompressible, poisson: 0.5"}) {
    const std::string name = formulation.substr(0, formulation.find(','));
    const SceneRun run(
        cube("elastic: {model: neo_hookean, mu: 0.2" + formulation.substr(name.size()) + "}",
             "    formulation: " + name + "\n    conditions: [{where: x-, displacement: [{control: c}, 0, 0]}]\n",
             "controls: {c: {displacement: " + formula("0.5*t") +
                 "}}\n"
                 "initial: {solids: {cube: {velocity: [0.5, 0, 0]}}}\n"
                 "dynamics: {duration: 1, step: 0.1}\n"
                 "record: {probes: {r: {reaction: cube@x-}}}\n"));
    ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
    // Of the 1e-9 of a step by which the face is ahead.
    EXPECT_LT(run.rows("energy/elastic").lpNorm<Eigen::Infinity>(), 1e-14) << name;
    EXPECT_LT(run.rows("probes/r").lpNorm<Eigen::Infinity>(), 1e-9) << name;
    EXPECT_LT((run.rows("energy/kinetic").array() - 0.5 * 8e-3 * 0.25).matrix().lpNorm<Eigen::Infinity>(), 1e-11);
    EXPECT_LT(run.rows("energy/external").lpNorm<Eigen::Infinity>(), 1e-11) << name;
  }
}

struct Case {
  const char* formulation;
  const char* poisson;
  const char* rest;
};

class Stretched : public testing::TestWithParam<Case> {};

/// Largest imbalance of a charged cube that is stretched and, from t = 0 on, moves.
double imbalance(const Case& said, int refinement) {
  const double step = 0.05 / refinement;
  const SceneRun run(
      cube(std::string("elastic: {model: neo_hookean, mu: 0.2, poisson: ") + said.poisson +
               "}, electric: {model: ideal_dielectric, relative_permittivity: 5}, "
               "viscous: {model: kelvin_voigt, viscosity: 0.05}",
           std::string("    formulation: ") + said.formulation +
               "\n    conditions:\n"
               "      - {where: y-, displacement: [0, 0, 0], potential: 0}\n"
               "      - {where: y+, displacement: [0, {control: c}, ~], potential: 6e4}\n",
           std::string("controls: {c: {displacement: " + formula("0.3*sin(1.5*t)") + "}}\ndynamics: {duration: 2, ") +
               said.rest + "step: " + std::to_string(step) + "}\nrecord: {every: " + std::to_string(4 * refinement) +
               "}\n"));
  EXPECT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  EXPECT_GT(run.rows("energy/external").maxCoeff(), 0.05);
  return run.rows("energy/balance").lpNorm<Eigen::Infinity>();
}

TEST_P(Stretched, ImbalanceFallsAsTheSquareOfTheStep) {
  const double coarse = imbalance(GetParam(), 2), fine = imbalance(GetParam(), 4);
  EXPECT_NEAR(coarse / fine, 4.0, 0.2) << coarse << ' ' << fine;
  EXPECT_LT(fine, 2e-5);
}

INSTANTIATE_TEST_SUITE_P(Formulations, Stretched,
                         testing::Values(Case{"displacement", "0.3", ""}, Case{"mean_dilatation", "0.45", ""},
                                         Case{"incompressible", "0.5", ""}),
                         [](const auto& item) { return std::string(item.param.formulation); });

TEST(PrescribedMotion, WorkIsBookedByTheExplicitIntegratorToo) {
  const auto lost = [](const std::string& step) {
    const SceneRun run(
        cube(rubber,
             "    formulation: displacement\n    conditions:\n      - {where: y-, displacement: [0, 0, 0]}\n"
             "      - {where: y+, displacement: [0, {control: c}, 0]}\n",
             "controls: {c: {displacement: " + formula("0.2*sin(1.5*t)") +
                 "}}\n"
                 "dynamics: {duration: 2, integrator: explicit, step: " +
                 step + "}\nrecord: {every: 10}\n"));
    EXPECT_TRUE(run.outcome().completed()) << run.outcome().sentence;
    return run.rows("energy/balance").lpNorm<Eigen::Infinity>();
  };
  EXPECT_NEAR(lost("0.005") / lost("0.0025"), 4.0, 0.3);
}

}  // namespace
}  // namespace muldi
