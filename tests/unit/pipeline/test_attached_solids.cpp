/// Solids that are attached to one another: the same as one mesh where nodes match, and what holds where they do not.
#include <gtest/gtest.h>

#include <cmath>

#include "attached_scene.hpp"
#include "pipeline/summary.hpp"

namespace muldi::test {
namespace {

using golden::SceneRun;

const std::string dielectric = ", electric: {model: ideal_dielectric, relative_permittivity: 3}";
const std::string attach_up = "    attach: [{where: z+, solid: up, where_other: z-}]\n";
const std::string clamped = "      - {where: z-, displacement: [0, 0, 0], potential: 0 V}\n";
const std::string pushed = "      - {where: x+, traction: [0, 1 kPa, 0]}\n";
const std::string held = "      - {where: x-, displacement: [0, ~, ~]}\n";

std::string record(const std::string& solids, const std::string& probes) {
  return "record:\n  every: 1\n  fields: {" + solids + "}\n  probes: {" + probes +
         "}\nsolver: {tolerance: 1e-13}\ngravity: [0, 1e-4, 0]\n";
}

/// A column of 1 x 1 x 2 under a field, a push and gravity, with one side held: whole, and cut at half its height.
class Column : public ::testing::TestWithParam<const char*> {
 protected:
  static std::string material() {
    const bool keeps_volume = std::string(GetParam()).starts_with("incompressible");
    return std::string("elastic: {model: neo_hookean, mu: 0.2, poisson: ") + (keeps_volume ? "0.5" : "0.45") +
           "}, viscous: {model: kelvin_voigt, viscosity: 0.05}" + dielectric;
  }
  static SceneRun whole(const std::string& task) {
    return SceneRun(boxes(
        {{"whole", "[1, 1, 2]", "[2, 2, 4]", "[0, 0, 1]",
          "    conditions:\n" + clamped + held + pushed + "    electrodes: {top: {where: z+, potential: 5 kV}}\n"}},
        material(), GetParam(),
        task + record("whole: [position, potential]", "r: {reaction: \"whole@x-\"}, b: {reaction: \"whole@z-\"}")));
  }
  static SceneRun cut(const std::string& task) {
    return SceneRun(boxes(
        {{"low", "[1, 1, 1]", "[2, 2, 2]", "[0, 0, 0.5]", "    conditions:\n" + clamped + held + pushed + attach_up},
         {"up", "[1, 1, 1]", "[2, 2, 2]", "[0, 0, 1.5]",
          "    conditions:\n" + held + pushed + "    electrodes: {top: {where: z+, potential: 5 kV}}\n"}},
        material(), GetParam(),
        task + record("low: [position, potential], up: [position, potential]",
                      "l: {reaction: \"low@x-\"}, u: {reaction: \"up@x-\"}, b: {reaction: "
                      "\"low@z-\"}")));
  }
  static void expect_same(const SceneRun& one, const SceneRun& two, const std::string& prefix) {
    ASSERT_TRUE(one.outcome().completed()) << one.outcome().sentence;
    ASSERT_TRUE(two.outcome().completed()) << two.outcome().sentence;
    EXPECT_LT(difference(one, two, prefix + "solids/", {"low", "up"}, "position"), 1e-11);  // of about 0.1
    EXPECT_LT(difference(one, two, prefix + "solids/", {"low", "up"}, "potential"), 1e-7);  // V, of 5000
    for (const char* part : {"elastic", "electric", "total"}) {
      const auto energy = one.rows(prefix + "energy/" + part);
      const double size = energy.lpNorm<Eigen::Infinity>();
      EXPECT_LT((two.rows(prefix + "energy/" + part) - energy).lpNorm<Eigen::Infinity>(), 1e-10 * size) << part;
    }
    const auto parts = two.rows(prefix + "energy/parts/solids/low") + two.rows(prefix + "energy/parts/solids/up");
    const auto of_whole = one.rows(prefix + "energy/parts/solids/whole");
    EXPECT_LT((parts - of_whole).lpNorm<Eigen::Infinity>(), 1e-10 * of_whole.lpNorm<Eigen::Infinity>());
    const auto reaction = one.rows(prefix + "probes/r");
    const auto sum = two.rows(prefix + "probes/l") + two.rows(prefix + "probes/u");
    EXPECT_LT((sum - reaction).lpNorm<Eigen::Infinity>(), 1e-10 * reaction.lpNorm<Eigen::Infinity>());
    EXPECT_LT((two.rows(prefix + "probes/b") - one.rows(prefix + "probes/b")).lpNorm<Eigen::Infinity>(),
              1e-10 * one.rows(prefix + "probes/b").lpNorm<Eigen::Infinity>());
    const auto charge = one.rows(prefix + "electrodes/whole.top/charge");
    EXPECT_LT((two.rows(prefix + "electrodes/up.top/charge") - charge).lpNorm<Eigen::Infinity>(),
              1e-11 * charge.lpNorm<Eigen::Infinity>());
  }
};

TEST_P(Column, CutInTwoRestsLikeOneMesh) {
  const std::string task = "statics: {steps: 2}\n";
  expect_same(whole(task), cut(task), "statics/");
}

TEST_P(Column, CutInTwoMovesLikeOneMesh) {
  const std::string task = "dynamics: {duration: 20 ms, step: 1 ms}\n";
  const SceneRun one = whole(task);
  const SceneRun two = cut(task);
  expect_same(one, two, "");
  for (const char* which : {"momentum/linear", "momentum/angular"}) {
    const auto momentum = one.rows(which);
    EXPECT_LT((two.rows(which) - momentum).lpNorm<Eigen::Infinity>(), 1e-10 * momentum.lpNorm<Eigen::Infinity>());
  }
}

INSTANTIATE_TEST_SUITE_P(Formulations, Column, ::testing::Values("displacement", "mean_dilatation", "incompressible"),
                         [](const auto& one) { return std::string(one.param); });

const std::string rubber = "elastic: {model: neo_hookean, mu: 0.2, poisson: 0.4}";

TEST(AttachedSolid, CarriesTheWeightOfWhatHangsOnIt) {
  const SceneRun run(
      boxes({{"low", "[1, 1, 1]", "[2, 2, 2]", "[0, 0, 0.5]", attach_up},
             {"up", "[1, 1, 2]", "[2, 2, 4]", "[0, 0, 2]", "    conditions: [{where: z+, displacement: [0, 0, 0]}]\n"}},
            rubber, "mean_dilatation",
            "gravity: [0, 0, -0.01]\nstatics: {steps: 1}\nrecord: {probes: {r: {reaction: up@z+}}}\nsolver: "
            "{tolerance: 1e-13}\n"));
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  // Density times volume times g.
  EXPECT_NEAR(run.last("statics/ties/low.up/force")[2], -1e-3 * 1 * 0.01, 1e-14);
  EXPECT_NEAR(run.last("statics/probes/r")[2], 1e-3 * 3 * 0.01, 1e-14);
  EXPECT_NEAR(run.last("statics/ties/low.up/moment").norm(), 0.0, 1e-15);
}

/// First Piola-Kirchhoff stress of the neo-Hookean law with kappa/2 (J - 1)^2, stretched by s along one axis and held
/// across it: F = diag(1, 1, s).
double confined_stress(double mu, double poisson, double s) {
  const double kappa = 2.0 * mu * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson));
  const double isochoric = mu * (std::pow(s, 1.0 / 3.0) - (2.0 + s * s) / (3.0 * std::pow(s, 5.0 / 3.0)));
  return isochoric + kappa * (s - 1.0);
}

TEST(AttachedSolid, TwoMaterialsInSeriesStretchByTheirOwnLaws) {
  const std::string sides =
      "      - {where: x-, displacement: [0, ~, ~]}\n      - {where: x+, displacement: [0, ~, ~]}\n"
      "      - {where: y-, displacement: [~, 0, ~]}\n      - {where: y+, displacement: [~, 0, ~]}\n";
  const std::string text =
      "muldi: 1\nmaterials:\n"
      "  soft: {density: 1e-3, elastic: {model: neo_hookean, mu: 0.1, poisson: 0.3}}\n"
      "  hard: {density: 1e-3, elastic: {model: neo_hookean, mu: 0.5, poisson: 0.4}}\n"
      "solids:\n"
      "  low:\n    mesh: {box: {size: [1, 1, 1], cells: [2, 2, 2], centre: [0, 0, 0.5]}}\n    material: soft\n"
      "    conditions:\n      - {where: z-, displacement: [~, ~, 0]}\n" +
      sides +
      "  up:\n    mesh: {box: {size: [1, 1, 3], cells: [4, 4, 2], centre: [0, 0, 2.5]}}\n    material: hard\n"
      "    conditions:\n      - {where: z+, traction: [0, 0, 0.1]}\n" +
      sides +
      "    attach: [{where: z-, solid: low, where_other: z+}]\n"
      "statics: {steps: 2}\n"
      "record: {probes: {a: {point: \"low@[0, 0, 1]\", of: displacement}, b: {point: \"up@[0, 0, 4]\", of: "
      "displacement}}}\nsolver: {tolerance: 1e-13}\n";
  const SceneRun run(scene::read_scene_text(text, "series.yaml"));
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const double s = 1.0 + run.last("statics/probes/a")[2];
  const double t = 1.0 + (run.last("statics/probes/b")[2] - run.last("statics/probes/a")[2]) / 3.0;
  EXPECT_GT(s, 1.2);
  EXPECT_NEAR(confined_stress(0.1, 0.3, s), 0.1, 1e-12);
  EXPECT_NEAR(confined_stress(0.5, 0.4, t), 0.1, 1e-12);
}

TEST(AttachedSolid, IsSummedUpAsOneWithWhatItsJointEliminates) {
  const scene::Scene scene = boxes({{"low", "[1, 1, 1]", "[2, 2, 2]", "[0, 0, 0.5]", attach_up},
                                    {"up", "[1, 1, 1]", "[2, 2, 2]", "[0, 0, 1.5]", ""}},
                                   rubber, "mean_dilatation", "dynamics: {duration: 1, step: 1}\n");
  const std::string text = pipeline::summary(scene, build::build_model(scene));
  // Of 54 nodes 9 are one with others.
  EXPECT_NE(
      text.find("  2 solids attached to one another, low + up: 54 nodes, 16 cells, mean_dilatation\n"
                "    free positions 135, 27 eliminated by attachment, no potentials (none is prescribed), element "
                "pressures 16\n"),
      std::string::npos)
      << text;
}

/// A pair with meshes that do not match, 3 x 3 cells against 2 x 2.
SceneRun loose_pair(const std::string& formulation, const std::string& tail) {
  const std::string poisson = formulation == "incompressible" ? "0.5" : "0.4";
  return SceneRun(boxes(
      {{"low", "[1, 1, 1]", "[2, 2, 2]", "[0, 0, 0.5]", ""},
       {"up", "[0.9, 0.9, 1]", "[3, 3, 2]", "[0, 0, 1.5]", "    attach: [{where: z-, solid: low, where_other: z+}]\n"}},
      "elastic: {model: neo_hookean, mu: 0.2, poisson: " + poisson + "}", formulation, tail));
}

class LoosePair : public ::testing::TestWithParam<const char*> {};

TEST_P(LoosePair, KeepsItsMomentaAndItsJoint) {
  const SceneRun run =
      loose_pair(GetParam(),
                 "initial: {solids: {up: {velocity: [0.02, 0, 0.03], angular_velocity: [0, 0.2, 0.1]}}}\n"
                 "dynamics: {duration: 20 ms, step: 0.5 ms}\n"
                 "record: {every: 1, fields: {low: [position], up: [position]}}\nsolver: {tolerance: 1e-13}\n");
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  for (const char* which : {"momentum/linear", "momentum/angular"}) {
    const auto momentum = run.rows(which);
    const double size = momentum.lpNorm<Eigen::Infinity>();
    EXPECT_GT(size, 1e-5);
    EXPECT_LT((momentum.colwise() - momentum.col(0)).lpNorm<Eigen::Infinity>(), 1e-10 * size) << which;
  }
  EXPECT_GT(run.rows("energy/elastic").maxCoeff(), 1e-3 * run.rows("energy/kinetic")(0, 0));
  // Up's node 0 is at (-0.45, -0.45, 1): in low's first cell of the top face, whose corners are these with weights
  // 0.81, 0.09, 0.09, 0.01 (closed form).
  const Eigen::VectorXd low = run.last("solids/low/position");
  const Eigen::Matrix3Xd X = reference(run, "low");
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index node = 0; node < X.cols(); ++node) {
    const double a = std::max(0.0, 1.0 - std::abs(X(0, node) + 0.45) / 0.5);
    const double b = std::max(0.0, 1.0 - std::abs(X(1, node) + 0.45) / 0.5);
    if (X(2, node) == 1.0) sum += a * b * low.segment<3>(3 * node);
  }
  const Eigen::VectorXd up = run.last("solids/up/position");
  const Eigen::Index corner = node_at(reference(run, "up"), {-0.45, -0.45, 1.0});
  EXPECT_LT((up.segment<3>(3 * corner) - sum).norm(), 1e-14);
}

INSTANTIATE_TEST_SUITE_P(Formulations, LoosePair,
                         ::testing::Values("displacement", "mean_dilatation", "incompressible"),
                         [](const auto& one) { return std::string(one.param); });

/// An electrode between two dielectrics, of the whole and of either or both of the halves.
TEST(AttachedDielectrics, ShareAnElectrodeBetweenThem) {
  const std::string silicone = rubber + dielectric;
  const std::string on_low = "    electrodes: {mid: {where: z+, potential: 2 kV}}\n";
  const std::string on_up = "    electrodes: {mid: {where: z-, potential: 2 kV}}\n";
  const std::string task = "statics: {steps: 1}\nrecord: {electric: [capacitance]}\nsolver: {tolerance: 1e-13}\n";
  const auto halves = [&](const std::string& low, const std::string& up) {
    return SceneRun(boxes(
        {{"low", "[1, 1, 1]", "[2, 2, 2]", "[0, 0, 0.5]", "    conditions:\n" + clamped + attach_up + low},
         {"up", "[1, 1, 1]", "[2, 2, 2]", "[0, 0, 1.5]", "    conditions: [{where: z+, potential: 1 kV}]\n" + up}},
        silicone, "mean_dilatation", task));
  };
  const SceneRun whole(boxes({{"whole", "[1, 1, 2]", "[2, 2, 4]", "[0, 0, 1]",
                               "    conditions:\n" + clamped +
                                   "      - {where: z+, potential: 1 kV}\n"
                                   "    electrodes: {mid: {where: {plane: {z: 1}}, potential: 2 kV}}\n"}},
                             silicone, "mean_dilatation", task));
  const SceneRun below = halves(on_low, "");
  const SceneRun above = halves("", on_up);
  const SceneRun both = halves(on_low, on_up);
  for (const SceneRun* run : {&whole, &below, &above, &both}) {
    ASSERT_TRUE(run->outcome().completed()) << run->outcome().sentence;
  }
  const double charge = whole.value("statics/electrodes/whole.mid/charge");
  EXPECT_GT(charge, 0.0);
  EXPECT_NEAR(below.value("statics/electrodes/low.mid/charge"), charge, 1e-12 * charge);
  EXPECT_NEAR(above.value("statics/electrodes/up.mid/charge"), charge, 1e-12 * charge);
  const double of_low = both.value("statics/electrodes/low.mid/charge");
  const double of_up = both.value("statics/electrodes/up.mid/charge");
  EXPECT_NEAR(of_low + of_up, charge, 1e-12 * charge);
  EXPECT_GT(of_low, 1.5 * of_up);  // twice the voltage
  const double capacitance = whole.value("statics/electrodes/whole.mid/capacitance");
  EXPECT_NEAR(below.value("statics/electrodes/low.mid/capacitance"), capacitance, 1e-12 * capacitance);
  EXPECT_NEAR(above.value("statics/electrodes/up.mid/capacitance"), capacitance, 1e-12 * capacitance);
}

/// Plates on either end of a pair of which neither mesh refines the other, held as it is: eps A / h.
TEST(AttachedDielectrics, HaveAHomogeneousFieldThroughAnyMeshes) {
  const std::string hold = "{where: all, displacement: [0, 0, 0]}";
  const SceneRun run(boxes({{"low", "[1, 1, 1]", "[2, 3, 2]", "[0, 0, 0.5]",
                             "    conditions: [" + hold + ", {where: z-, potential: 0 V}]\n"},
                            {"up", "[1, 1, 1]", "[3, 4, 2]", "[0, 0, 1.5]",
                             "    conditions: [" + hold + "]\n" +
                                 "    electrodes: {top: {where: z+, potential: 4 kV}}\n"
                                 "    attach: [{where: z-, solid: low, where_other: z+}]\n"}},
                           rubber + dielectric, "displacement",
                           "statics: {steps: 1}\nrecord: {electric: [capacitance], fields: {up: [potential]}}\n"));
  ASSERT_TRUE(run.outcome().completed()) << run.outcome().sentence;
  const Eigen::Matrix3Xd X = reference(run, "up");
  const Eigen::VectorXd potential = run.last("statics/solids/up/potential");
  EXPECT_LT((potential.transpose() - 2000.0 * X.row(2)).lpNorm<Eigen::Infinity>(), 1e-8);
  const double capacitance = 3.0 * 8.8542e-12 / 2.0;  // vacuum's permittivity in the units of results
  EXPECT_NEAR(run.value("statics/electrodes/up.top/capacitance"), capacitance, 1e-12 * capacitance);
}

TEST(AttachedDielectrics, FloatTogether) {
  const std::string silicone = rubber + dielectric;
  const std::string task = "statics: {steps: 1}\nsolver: {tolerance: 1e-13}\n";
  const SceneRun whole(boxes({{"whole", "[1, 1, 2]", "[2, 2, 4]", "[0, 0, 1]",
                               "    conditions:\n" + clamped +
                                   "      - {where: z+, potential: 3 kV}\n"
                                   "    electrodes: {mid: {where: {plane: {z: 1}}, charge: 0}}\n"}},
                             silicone, "displacement", task));
  const SceneRun cut(boxes({{"low", "[1, 1, 1]", "[2, 2, 2]", "[0, 0, 0.5]", "    conditions:\n" + clamped + attach_up},
                            {"up", "[1, 1, 1]", "[2, 2, 2]", "[0, 0, 1.5]",
                             "    conditions: [{where: z+, potential: 3 kV}]\n"
                             "    electrodes: {mid: {where: z-, charge: 0}}\n"}},
                           silicone, "displacement", task));
  ASSERT_TRUE(whole.outcome().completed()) << whole.outcome().sentence;
  ASSERT_TRUE(cut.outcome().completed()) << cut.outcome().sentence;
  const double potential = whole.value("statics/electrodes/whole.mid/potential");
  EXPECT_GT(potential, 1000.0);
  EXPECT_NEAR(cut.value("statics/electrodes/up.mid/potential"), potential, 1e-9);
  EXPECT_NEAR(cut.value("statics/electrodes/up.mid/charge"), 0.0, 1e-22);
}

/// Four quarters, each attached to the next: nodes on the middle line belong to all, and the ring closes.
TEST(AttachedSolid, FourQuartersInARingAreOneMesh) {
  const std::string task =
      "statics: {steps: 1}\nrecord: {fields: {FIELDS}}\nsolver: {tolerance: 1e-13}\ngravity: [0, 1e-3, 0]\n";
  const auto with = [&](const std::string& fields) {
    std::string text = task;
    return text.replace(text.find("FIELDS"), 6, fields);
  };
  const std::string clamp = "    conditions: [{where: z-, displacement: [0, 0, 0]}]\n";
  const auto quarter = [&](const std::string& name, const std::string& x, const std::string& y, const std::string& side,
                           const std::string& other, const std::string& face) {
    return BoxSolid{name, "[1, 1, 1]", "[2, 2, 2]", "[" + x + ", " + y + ", 0.5]",
                    clamp + "    attach: [{where: " + side + ", solid: " + other + ", where_other: " + face + "}]\n"};
  };
  const SceneRun whole(boxes({{"whole", "[2, 2, 1]", "[4, 4, 2]", "[0, 0, 0.5]", clamp}}, rubber, "displacement",
                             with("whole: [position]")));
  const SceneRun cut(boxes({quarter("a", "-0.5", "-0.5", "x+", "b", "x-"), quarter("b", "0.5", "-0.5", "y+", "c", "y-"),
                            quarter("c", "0.5", "0.5", "x-", "d", "x+"), quarter("d", "-0.5", "0.5", "y-", "a", "y+")},
                           rubber, "displacement", with("a: [position], b: [position], c: [position], d: [position]")));
  ASSERT_TRUE(whole.outcome().completed()) << whole.outcome().sentence;
  ASSERT_TRUE(cut.outcome().completed()) << cut.outcome().sentence;
  EXPECT_LT(difference(whole, cut, "statics/solids/", {"a", "b", "c", "d"}, "position"), 1e-13);
}

/// A bar between ground and a body that turns: whole, or a chain of three solids whose last may have a finer mesh.
SceneRun swinging_bar(const std::vector<BoxSolid>& solids) {
  return SceneRun(
      boxes(solids, rubber, "mean_dilatation",
            "bodies: {plate: {mass: 2e-3, inertia: [1e-3, 1e-3, 1e-3], position: [3.5, 0, 0]}}\n"
            "joints: {j: {type: revolute, from: {body: ground, at: [1, 0, 0]}, to: {body: plate, at: "
            "[-2.5, 0, 0]}, axis: [0, 0, 1]}}\n"
            "initial: {joints: {j: {position: 0.1}}}\n"
            "dynamics: {duration: 10 ms, step: 0.25 ms}\nrecord: {every: 1}\nsolver: {tolerance: 1e-13}\n"));
}

std::vector<BoxSolid> chain(const std::string& cells_of_last) {
  return {{"a", "[1, 1, 1]", "[2, 2, 2]", "[0.5, 0, 0]", "    attach: [{where: x-, body: ground}]\n"},
          {"b", "[1, 1, 1]", "[2, 2, 2]", "[1.5, 0, 0]", "    attach: [{where: x-, solid: a, where_other: x+}]\n"},
          {"c", "[1, 1, 1]", cells_of_last, "[2.5, 0, 0]",
           "    attach: [{where: x-, solid: b, where_other: x+}, {where: x+, body: plate}]\n"}};
}

TEST(AttachedSolid, ChainMovesItsBodyLikeOneMesh) {
  const SceneRun whole = swinging_bar({{"whole", "[3, 1, 1]", "[6, 2, 2]", "[1.5, 0, 0]",
                                        "    attach: [{where: x-, body: ground}, {where: x+, body: plate}]\n"}});
  const SceneRun cut = swinging_bar(chain("[2, 2, 2]"));
  const SceneRun finer = swinging_bar(chain("[2, 4, 4]"));
  for (const SceneRun* run : {&whole, &cut, &finer}) {
    ASSERT_TRUE(run->outcome().completed()) << run->outcome().sentence;
  }
  const auto angle = whole.rows("joints/j/coordinate");
  EXPECT_LT(angle.minCoeff(), 0.05);
  EXPECT_LT((cut.rows("joints/j/coordinate") - angle).lpNorm<Eigen::Infinity>(), 1e-11);
  const double force = whole.rows("ties/whole.plate/force").lpNorm<Eigen::Infinity>();
  EXPECT_LT((cut.rows("ties/c.plate/force") - whole.rows("ties/whole.plate/force")).lpNorm<Eigen::Infinity>(),
            1e-9 * force);
  EXPECT_LT((cut.rows("ties/a.ground/force") - whole.rows("ties/whole.ground/force")).lpNorm<Eigen::Infinity>(),
            1e-9 * force);
  // A finer third of the bar is a little softer.
  EXPECT_LT((finer.rows("joints/j/coordinate") - angle).lpNorm<Eigen::Infinity>(), 0.01);
  const auto energy = finer.rows("energy/total");
  EXPECT_LT((energy.array() - energy(0, 0)).abs().maxCoeff(), 0.05 * energy(0, 0));
}

}  // namespace
}  // namespace muldi::test
