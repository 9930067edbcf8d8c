/// Sensitivities against differences of whole runs, recovery of known parameters, and what data do not tell.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/text.hpp"
#include "pipeline/study/calibrate.hpp"
#include "pipeline/study/simulated_equilibria.hpp"
#include "pipeline/study/simulated_motion.hpp"

namespace muldi::pipeline {
namespace {

using Strings = std::vector<std::string>;

std::string shipped(const std::string& name) { return MULDI_SOURCE_DIR "/scenes/" + name + ".yaml"; }

/// Bounds about the values of the scene.
scene::CalibrateStudy study_of(const Strings& keys, const scene::SceneText& text) {
  scene::CalibrateStudy study;
  const scene::Scene scene = text.read({});
  std::vector<base::Diagnostic> none;
  for (const std::string& key : keys) {
    const double value = scene::number_at(scene, text.keys(key, {}, none).front()).value();
    scene::FittedKey& fitted = study.fit.items.emplace_back();
    fitted.path = key;
    fitted.range = {.min = base::number_text(0.99 * value), .max = base::number_text(1.01 * value)};
  }
  return study;
}

/// Derivative by parameter k of what is solved for anew: differences of order 4 at theta (1 +- 1e-3), (1 +- 2e-3). They
/// carry the errors of the runs (1e-13) a thousandfold, and their own, 1e-12/30 of the fifth derivative.
template <class Solve>
Eigen::MatrixXd difference(const Parameters& parameters, std::size_t k, const Solve& solve) {
  const auto at = static_cast<Eigen::Index>(k);
  const double h = 1e-3 * parameters.start()[at];
  const auto moved = [&](double steps) {
    Eigen::VectorXd theta = parameters.start();
    theta[at] += steps * h;
    const scene::Scene scene = parameters.scene_at(theta);
    const build::BuiltModel built = build::build_model(scene);
    return Eigen::MatrixXd(solve(scene, built));
  };
  return (8.0 * (moved(1) - moved(-1)) - (moved(2) - moved(-2))) / (12.0 * h);
}

void expect_same(const Eigen::MatrixXd& exact, const Eigen::MatrixXd& differences, const std::string& key,
                 double tolerance) {
  for (Eigen::Index c = 0; c < differences.cols(); ++c) {
    const double size = differences.col(c).cwiseAbs().maxCoeff();
    EXPECT_GT(size, 0.0) << key << " has an effect on column " << c;
    EXPECT_LT((exact.col(c) - differences.col(c)).cwiseAbs().maxCoeff(), tolerance * size) << key << " column " << c;
  }
}

void expect_exact(const std::string& name, Strings overrides, const Strings& keys, const Strings& paths,
                  double tolerance) {
  overrides.emplace_back("solver.tolerance=1e-13");
  const scene::SceneText text(shipped(name), overrides);
  const Parameters parameters(study_of(keys, text), text);
  const scene::Scene scene = parameters.scene_at(parameters.start());
  const build::BuiltModel built = build::build_model(scene);
  ASSERT_EQ(why_not_differentiable(scene, built), "");
  std::vector<RecordedColumn> columns;
  for (const std::string& path : paths) columns.push_back({path, path.ends_with("reaction") ? 1u : 0u});
  std::vector<std::vector<Variant>> variants;
  for (std::size_t k = 0; k < keys.size(); ++k) variants.push_back(parameters.variants(parameters.start(), k));
  Motion motion;
  ASSERT_TRUE(simulate(scene, built, motion).completed());
  const std::vector<Eigen::MatrixXd> exact = sensitivities(scene, built, motion, variants, columns);
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const Eigen::MatrixXd differences =
        difference(parameters, k, [&](const scene::Scene& moved, const build::BuiltModel& model) {
          Motion of_moved;
          EXPECT_TRUE(simulate(moved, model, of_moved).completed());
          return observe(moved, model, of_moved.path, columns);
        });
    expect_same(exact[k], differences, keys[k], tolerance);
  }
}

const Strings all_of_muscles{"materials.silicone.electric.relative_permittivity", "materials.silicone.elastic.young",
                             "materials.silicone.viscous.viscosity", "materials.silicone.density",
                             "muscles.*.section.diameter"};
const Strings at_joint{"joints/hinge/coordinate", "joints/hinge/velocity", "joints/hinge/reaction",
                       "muscles/upper/force", "energy/kinetic"};

TEST(Sensitivities, OfADampedJointAreExact) {
  Strings keys = all_of_muscles;
  for (const char* key : {"controls.agonist.field", "bodies.pendulum.mass", "bodies.pendulum.inertia[2]"})
    keys.push_back(key);
  expect_exact("revolute_joint_lumped", {"dynamics.duration=20 ms"}, keys, at_joint, 1e-8);
}

TEST(Sensitivities, OfRestLengthsAreExact) {
  expect_exact("revolute_joint_lumped",
               {"dynamics.duration=20 ms", "muscles.upper.rest_length=99", "muscles.lower.rest_length=99"},
               {"muscles.*.rest_length", "muscles.upper.section.diameter"}, at_joint, 1e-8);
}

TEST(Sensitivities, OfAStartAtRestInEquilibriumAreExact) {
  expect_exact("revolute_joint_lumped",
               {"dynamics.duration=10 ms", "gravity=[0, -9.81 m/s^2, 0]", "initial={from: static_equilibrium}",
                "controls.agonist={field: {ramp: {from: 10 kV/mm, to: 30 kV/mm, start: 0, over: 10}}}"},
               {"materials.silicone.electric.relative_permittivity", "materials.silicone.elastic.young",
                "muscles.upper.section.diameter", "bodies.pendulum.mass"},
               {"joints/hinge/coordinate", "joints/hinge/velocity"}, 1e-8);
}

TEST(Sensitivities, OfAClosedLoopAreExact) {
  // Runs are converged to 1e-13 of position, of which differences of velocities over 1 ms keep 1e-8 at best.
  expect_exact("four_bar", {"dynamics.duration=100 ms"},
               {"bodies.coupler.mass", "bodies.rocker.inertia[2]", "initial.joints.A.velocity"},
               {"joints/A/coordinate", "joints/D/coordinate", "joints/C/velocity"}, 1e-7);
}

TEST(Sensitivities, OfASpringAndADamperOnTheJointThatClosesALoopAreExact) {
  expect_exact("slider_crank", {"dynamics.duration=20 ms"},
               {"joints.guide.stiffness", "joints.guide.damping", "bodies.piston.mass"},
               {"joints/main/coordinate", "joints/guide/coordinate"}, 1e-7);
}

TEST(Sensitivities, AreRefusedOfFiniteElements) {
  const scene::SceneText text(shipped("membrane_fe"), {});
  const scene::Scene scene = text.read({});
  EXPECT_EQ(
      why_not_differentiable(scene, build::build_model(scene)),
      "finite elements have no sensitivities: fit the muscles of `model: lumped`, with the finite elements as the "
      "reference");
}

TEST(Sensitivities, OfASpinningTopAreExact) {
  expect_exact("heavy_top", {"dynamics.duration=5 ms"}, {"bodies.top.mass", "bodies.top.inertia[2]"},
               {"points/top.head", "bodies/top/angular_velocity"}, 1e-7);
}

TEST(Sensitivities, OfEquilibriaAreExact) {
  const scene::SceneText text(shipped("revolute_joint_lumped"),
                              {"gravity=[0, -9.81 m/s^2, 0]", "solver.tolerance=1e-13"});
  const Strings keys{"materials.silicone.electric.relative_permittivity", "materials.silicone.elastic.young",
                     "muscles.upper.section.diameter", "bodies.pendulum.mass"};
  const Parameters parameters(study_of(keys, text), text);
  const scene::Scene scene = parameters.scene_at(parameters.start());
  const build::BuiltModel built = build::build_model(scene);
  const std::vector<RecordedColumn> columns{
      {"statics/joints/hinge/coordinate", 0}, {"statics/joints/hinge/reaction", 1}, {"statics/muscles/upper/force", 0}};
  std::vector<EquilibriumPoint> points;
  ASSERT_TRUE(find_equilibria(scene, built, points).completed());
  std::vector<std::vector<Variant>> variants;
  for (std::size_t k = 0; k < keys.size(); ++k) variants.push_back(parameters.variants(parameters.start(), k));
  const auto exact = equilibrium_sensitivities(scene, built, points, variants, columns);
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const Eigen::MatrixXd differences =
        difference(parameters, k, [&](const scene::Scene& moved, const build::BuiltModel& model) {
          std::vector<EquilibriumPoint> of_moved;
          EXPECT_TRUE(find_equilibria(moved, model, of_moved).completed());
          return observe_equilibria(moved, model, of_moved, columns);
        });
    expect_same(exact[k], differences, keys[k], 1e-8);
  }
}

TEST(Interpolation, IsExactForCubics) {
  const Eigen::VectorXd axis = Eigen::VectorXd::LinSpaced(9, 0.0, 8.0);
  Eigen::VectorXd at(4);
  at << 0.25, 3.5, 5.0, 7.9;
  const auto cubic = [](const Eigen::VectorXd& x) { return Eigen::VectorXd(x.array().cube() - 2.0 * x.array()); };
  EXPECT_LT((interpolation(axis, at) * cubic(axis) - cubic(at)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(interpolation(axis, at)(2, 5), 1.0);  // at a point its own value
  EXPECT_LT((interpolation(-axis, -at) * cubic(-axis) - cubic(-at)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(FitQuality, OfAStraightLineHasTheIntervalsOfTheTextbook) {
  // y = a + b t at t = 0, 1, 2, 3 with residuals 1, -1, -1, 1 (orthogonal to the line): s^2 = 4/2, var b = s^2/5,
  // var a = s^2 (1/4 + 1.5^2/5); t_0.975 of 2 degrees of freedom is 4.3027.
  Eigen::MatrixXd J(4, 2);
  J << 1, 0, 1, 1, 1, 2, 1, 3;
  const Eigen::Vector4d r(1, -1, -1, 1);
  const FitQuality quality = fit_quality(J, r, Eigen::Vector2d(20, 10), Eigen::Vector2d::Ones());
  EXPECT_EQ(quality.freedom, 2);
  EXPECT_NEAR(quality.deviation[0], std::sqrt(2.0 * 0.7), 1e-12);
  EXPECT_NEAR(quality.deviation[1], std::sqrt(2.0 / 5.0), 1e-12);
  EXPECT_NEAR(quality.half_width[1], 4.3027 * std::sqrt(2.0 / 5.0), 1e-12);
  EXPECT_TRUE(quality.combinations.empty());
}

TEST(FitQuality, QuantilesAreThoseOfTheTable) {  // published: any table of Student's t
  EXPECT_NEAR(student_quantile(5), 2.5706, 1e-4);
  EXPECT_NEAR(student_quantile(11), 2.2010, 3e-4);
  EXPECT_NEAR(student_quantile(30), 2.0423, 1e-4);
  EXPECT_NEAR(student_quantile(1000), 1.9623, 1e-4);
}

/// A folder with a reference and its study.
class Fit : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("fit" + std::to_string(::getpid()));
    std::filesystem::create_directory(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  /// What a scene gives, as a table of time or load and the first component.
  void write_table(const Strings& overrides, bool statics) {
    const scene::Scene scene = text_.read(overrides);
    const build::BuiltModel built = build::build_model(scene);
    std::ofstream out(folder_ / "data.csv");
    out.precision(17);
    if (statics) {
      std::vector<EquilibriumPoint> points;
      ASSERT_TRUE(find_equilibria(scene, built, points).completed());
      const Eigen::MatrixXd angle = observe_equilibria(scene, built, points, {{"statics/joints/hinge/coordinate", 0}});
      for (std::size_t i = 0; i < points.size(); ++i)
        out << points[i].load << "," << angle(static_cast<Eigen::Index>(i), 0) << "\n";
      return;
    }
    Motion motion;
    ASSERT_TRUE(simulate(scene, built, motion).completed());
    const Eigen::MatrixXd angle = observe(scene, built, motion.path, {{"joints/hinge/coordinate", 0}});
    for (Eigen::Index i = 0; i < angle.rows(); ++i) {
      out << static_cast<double>(i) * motion.path.step << "," << angle(i, 0) / (std::acos(-1.0) / 180.0) << "\n";
    }
  }

  Calibration calibrate_to(const std::string& data_set, const std::vector<std::array<std::string, 3>>& keys,
                           const std::string& unit) {
    scene::CalibrateStudy study;
    study.origin = {.place = {.file = (folder_ / "study.yaml").string()}};
    study.reference = "data.csv";
    for (const auto& [path, min, max] : keys) {
      study.fit.items.push_back({.path = path, .origin = {}, .range = {.min = min, .max = max}});
    }
    study.compare.items.push_back({.path = data_set, .origin = {}, .comparison = {.column = 2, .unit = unit}});
    return calibrate(study, text_, {});
  }

  scene::SceneText text_{shipped("revolute_joint_lumped"), {"dynamics.duration=200 ms", "dynamics.step=2"}};

 private:
  std::filesystem::path folder_;
};

TEST_F(Fit, RecoversKnownParametersOfAMotion) {
  write_table({"materials.silicone.electric.relative_permittivity=3.7", "muscles.upper.section.diameter=10",
               "muscles.lower.section.diameter=10", "materials.silicone.viscous.viscosity=7"},
              false);
  const Calibration fit = calibrate_to("joints.hinge.coordinate",
                                       {{"materials.silicone.electric.relative_permittivity", "2", "5"},
                                        {"muscles.*.section.diameter", "8 mm", "14 mm"},
                                        {"materials.silicone.viscous.viscosity", "2", "50"}},
                                       "deg");
  EXPECT_EQ(fit.end, math::LeastSquaresEnd::converged);
  EXPECT_NEAR(fit.value[0], 3.7, 1e-10 * 3.7);
  EXPECT_NEAR(fit.value[1], 10.0, 1e-10 * 10.0);
  EXPECT_NEAR(fit.value[2], 7.0, 1e-10 * 7.0);
  EXPECT_TRUE(fit.warnings.empty());
  EXPECT_LT(fit.quality.half_width[0], 1e-10);
}

TEST_F(Fit, SaysThatStaticsWithoutGravityCannotTellPermittivityStiffnessAndAreaApart) {
  write_table({"materials.silicone.electric.relative_permittivity=3.7"}, true);
  const Calibration fit = calibrate_to("statics.joints.hinge.coordinate",
                                       {{"materials.silicone.electric.relative_permittivity", "2", "5"},
                                        {"muscles.*.section.diameter", "8 mm", "14 mm"},
                                        {"materials.silicone.elastic.young", "0.3", "2"}},
                                       "rad");
  EXPECT_EQ(fit.end, math::LeastSquaresEnd::converged);
  // What the data do tell: the ratio, from 3.7/0.7.
  EXPECT_NEAR(fit.value[0] / fit.value[2], 3.7 / 0.7, 1e-9);
  EXPECT_EQ(fit.value[1], 11.0);
  EXPECT_EQ(
      fit.warnings,
      (Strings{"the data cannot tell materials.silicone.electric.relative_permittivity and "
               "materials.silicone.elastic.young apart: changing them together by +1 %, +1 % changes nothing that is "
               "compared; hold one of them fixed, or compare more",
               "the data say nothing about muscles.*.section.diameter: take it out of `fit`"}));
  for (const double width : fit.quality.half_width) EXPECT_TRUE(std::isinf(width));
}

}  // namespace
}  // namespace muldi::pipeline
