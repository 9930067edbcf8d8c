/// What must not depend on how a scene is written: units, place and orientation, order.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <ostream>

#include "base/text.hpp"
#include "scene_run.hpp"
#include "transformed_scene.hpp"

namespace muldi::golden {
namespace {

/// Factor of a result in SI to the same in mm, g, ms, A (numerics 2), by the name of its unit in SI.
double si_factor(const std::string& unit) {
  static const std::pair<const char*, double> factors[] = {
      {"m", 1e3}, {"s", 1e3},    {"1", 1.0},      {"rad", 1.0},      {"m/s", 1.0}, {"rad/s", 1e-3}, {"N", 1.0},
      {"J", 1e3}, {"V/m", 1e-3}, {"kg m/s", 1e3}, {"kg m^2/s", 1e6}, {"V", 1.0},   {"C", 1e3},
  };
  for (const auto& [name, factor] : factors) {
    if (unit == name) return factor;
  }
  ADD_FAILURE() << "no factor for the unit '" << unit << "'";
  return 0.0;
}

/// Channels of the physics: reals outside the solver groups.
std::vector<results::ChannelSpec> physics(const SceneRun& run) {
  std::vector<results::ChannelSpec> channels;
  for (const results::DeclaredChannel& channel : run.recorder().declared().channels) {
    if (channel.spec.type != results::ValueType::float64) continue;
    if (channel.spec.path.find("solver/") != std::string::npos) continue;
    channels.push_back(channel.spec);
  }
  return channels;
}

/// A channel, and the size that its errors are measured by: its largest value.
struct Measured {
  std::string name;
  Eigen::MatrixXd expected;
  Eigen::MatrixXd got;
  double size = 0.0;
};

Measured whole(const std::string& name, Eigen::MatrixXd expected, Eigen::MatrixXd got) {
  const double size = expected.cwiseAbs().maxCoeff();
  return {name, std::move(expected), std::move(got), size};
}

/// Reactions fall into forces and moments, measured by the largest force of all joints (times 10 mm): they are changes
/// of momentum over a step, whose round-off is that of the whole system. A balance is measured by the energies of which
/// it is a small rest.
std::vector<Measured> measured(const SceneRun& run, const std::string& path, const Eigen::MatrixXd& got) {
  const Eigen::MatrixXd expected = run.rows(path);
  if (path.ends_with("/reaction")) {
    Measured force = whole(path + " (force)", expected.topRows<3>(), got.topRows<3>());
    Measured moment = whole(path + " (moment)", expected.bottomRows<3>(), got.bottomRows<3>());
    const bool in_statics = path.starts_with("statics/");
    for (const std::string& joint : run.scene().joints.names()) {
      const auto of_joint = run.rows((in_statics ? "statics/joints/" : "joints/") + joint + "/reaction");
      force.size = std::max(force.size, of_joint.topRows<3>().cwiseAbs().maxCoeff());
    }
    moment.size = std::max(moment.size, 10.0 * force.size);
    return {force, moment};
  }
  Measured all = whole(path, expected, got);
  // A body that only slides turns by round-off.
  if (path.starts_with("bodies/")) {
    const std::string kind = path.substr(path.rfind('/'));
    for (const results::DeclaredChannel& channel : run.recorder().declared().channels) {
      const std::string& other = channel.spec.path;
      if (!other.starts_with("bodies/") || !other.ends_with(kind)) continue;
      all.size = std::max(all.size, run.rows(other).cwiseAbs().maxCoeff());
    }
  }
  if (path == "energy/balance") {
    for (const char* energy : {"energy/kinetic", "energy/elastic", "energy/electric"}) {
      all.size = std::max(all.size, run.rows(energy).cwiseAbs().maxCoeff());
    }
  }
  return {all};
}

/// The largest error of a comparison over its size.
class Worst {
 public:
  void add(const Measured& channel) {
    const double error = (channel.expected - channel.got).cwiseAbs().maxCoeff();
    const double relative = error == 0.0 ? 0.0 : error / channel.size;
    if (!(relative <= value_)) {
      value_ = relative;
      channel_ = channel.name;
    }
  }
  double value() const { return value_; }
  const std::string& channel() const { return channel_; }

 private:
  double value_ = 0.0;
  std::string channel_;
};

struct SceneInBothUnits {
  const char* in_mm;
  const char* in_si;
};
// NOLINTNEXTLINE(readability-identifier-naming): GoogleTest's name
void PrintTo(const SceneInBothUnits& scenes, std::ostream* out) { *out << scenes.in_si; }

class Units : public testing::TestWithParam<SceneInBothUnits> {};

TEST_P(Units, SiAndMillimetresGiveTheSameResultsWithTheSameIterations) {
  const auto& [in_mm, in_si] = GetParam();
  const SceneRun mm(in_mm, {"dynamics.duration=1 s"}), si(in_si, {"dynamics.duration=1 s"});
  ASSERT_TRUE(mm.outcome().completed()) << mm.outcome().sentence;
  ASSERT_TRUE(si.outcome().completed()) << si.outcome().sentence;
  EXPECT_EQ(mm.iterations(), si.iterations());
  EXPECT_EQ(mm.iterations("statics/"), si.iterations("statics/"));
  Worst worst;
  for (const results::ChannelSpec& channel : physics(si)) {
    Eigen::MatrixXd got = si_factor(channel.unit) * si.rows(channel.path);
    // The moments of reactions stand beside their forces, in N m.
    if (channel.path.ends_with("/reaction")) got.bottomRows<3>() *= 1e3;
    for (const Measured& part : measured(mm, channel.path, got)) worst.add(part);
  }
  EXPECT_LT(worst.value(), 1e-9) << worst.channel();
}

INSTANTIATE_TEST_SUITE_P(Scenes, Units,
                         testing::Values(SceneInBothUnits{"revolute_joint_lumped", "si/revolute_joint"},
                                         SceneInBothUnits{"elephant_trunk_lumped", "si/elephant_trunk"}),
                         [](const auto& instance) { return std::string(instance.param.in_mm); });

/// The rows of a channel as the moved scene must have them.
Eigen::MatrixXd moved_rows(const SceneRun& run, const std::string& path, const RigidMotion& motion) {
  Eigen::MatrixXd rows = run.rows(path);
  const Eigen::Matrix3d& R = motion.rotation;
  if (path.ends_with("/orientation")) {
    // Row-major: entry (i, j) is row 3 i + j.
    for (Eigen::Index k = 0; k < rows.cols(); ++k) {
      using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
      Eigen::Map<RowMajor> axes(rows.col(k).data());
      axes = (R * axes).eval();
    }
  } else if (path.ends_with("/position") || path.find("points/") != std::string::npos) {
    rows = (R * rows).colwise() + motion.translation;
  } else if (path.ends_with("/reaction")) {
    rows << R * rows.topRows<3>(), R * rows.bottomRows<3>();
  } else if (path == "momentum/angular") {
    const Eigen::MatrixXd linear = R * run.rows("momentum/linear");
    rows = R * rows;
    for (Eigen::Index k = 0; k < rows.cols(); ++k) {
      rows.col(k) += motion.translation.cross(Eigen::Vector3d(linear.col(k)));
    }
  } else if (path == "momentum/linear" || (path.starts_with("bodies/") && path.ends_with("velocity"))) {
    rows = R * rows;
  }
  return rows;
}

class Invariance : public testing::TestWithParam<const char*> {
 protected:
  /// What Newton's iteration leaves is no part of the question.
  static Overrides shortened() { return {"dynamics.duration=300 ms", "record.every=10", "solver.tolerance=1e-13"}; }
};

TEST_P(Invariance, AMovedSceneGivesMovedResults) {
  std::mt19937 random(7);
  const scene::Scene scene = shipped(GetParam(), shortened());
  const SceneRun here(scene);
  ASSERT_TRUE(here.outcome().completed()) << here.outcome().sentence;
  for (int k = 0; k < 3; ++k) {
    const RigidMotion motion = random_motion(random, 200.0);
    const SceneRun there(written_and_read(moved(scene, motion)));
    ASSERT_TRUE(there.outcome().completed()) << there.outcome().sentence;
    Worst worst;
    for (const results::ChannelSpec& channel : physics(here)) {
      // Its loop has more constraints than it needs and no axes that say how they share the load: reactions are one
      // choice of many.
      if (scene.title == "Slider-crank" && channel.path.ends_with("/reaction")) continue;
      const Eigen::MatrixXd expected = moved_rows(here, channel.path, motion);
      for (const Measured& part : measured(there, channel.path, expected)) worst.add(part);
    }
    EXPECT_LT(worst.value(), 1e-9) << worst.channel();
  }
}

TEST_P(Invariance, AnotherOrderOfBodiesAndJointsGivesTheSameResults) {
  std::mt19937 random(11);
  const scene::Scene scene = shipped(GetParam(), shortened());
  const SceneRun first(scene);
  for (int k = 0; k < 3; ++k) {
    const SceneRun other(written_and_read(shuffled(scene, random)));
    ASSERT_TRUE(other.outcome().completed()) << other.outcome().sentence;
    Worst motion, reactions;
    for (const results::ChannelSpec& channel : physics(first)) {
      Worst& worst = channel.path.ends_with("/reaction") ? reactions : motion;
      for (const Measured& part : measured(first, channel.path, other.rows(channel.path))) worst.add(part);
    }
    EXPECT_LT(motion.value(), 1e-10) << motion.channel();
    // Another tree: the residual that Newton's iteration leaves (1e-12 of the momentum) over the step.
    EXPECT_LT(reactions.value(), 1e-9) << reactions.channel();
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Invariance,
                         testing::Values("revolute_joint_lumped", "elephant_trunk_lumped", "tree", "four_bar",
                                         "slider_crank"),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace muldi::golden
