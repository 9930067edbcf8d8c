/// Controls in time and what is recorded of it.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "base/text.hpp"
#include "scene_run.hpp"

namespace muldi::golden {
namespace {

struct ControlCase {
  const char* name;
  const char* function;
};
// NOLINTNEXTLINE(readability-identifier-naming): GoogleTest's name
void PrintTo(const ControlCase& one, std::ostream* out) { *out << one.function; }

/// Functions of time as scenes give them. The kinks and jumps of the second half lie on nodes of all steps used.
constexpr ControlCase control_cases[] = {
    {"sine", "{sine: {amplitude: 15 kV/mm, frequency: 7 Hz, phase: 20 deg, offset: 15 kV/mm}}"},
    {"expression", "{expression: '30*(1-exp(-t/20))', unit: kV/mm}"},
    {"ramp", "{ramp: {from: 5 kV/mm, to: 30 kV/mm, start: 16 ms, over: 64 ms}}"},
    {"table", "{table: [[0, 0], [24 ms, 30 kV/mm], [56 ms, 10 kV/mm], [88 ms, 25 kV/mm]]}"},
    {"steps", "{steps: [[0, 30 kV/mm], [24 ms, 5 kV/mm], [56 ms, 20 kV/mm], [88 ms, 0]]}"},
};

class ControlOrder : public testing::TestWithParam<ControlCase> {};

TEST_P(ControlOrder, IsTwoInPositionsVelocitiesAndForces) {
  const auto run_with = [&](double step) {
    scene::Scene scene = shipped("revolute_joint_lumped", {std::string("controls.agonist.field=") + GetParam().function,
                                                           "dynamics.duration=120 ms", step_of(step)});
    scene.statics.reset();
    return SceneRun(std::move(scene));
  };
  const SceneRun runs[] = {run_with(2.0), run_with(1.0), run_with(0.5)};
  for (const char* path : {"joints/hinge/coordinate", "joints/hinge/velocity", "muscles/lower/force"}) {
    const double y0 = runs[0].value(path), y1 = runs[1].value(path), y2 = runs[2].value(path);
    EXPECT_NEAR(std::log2(std::abs((y0 - y1) / (y1 - y2))), 2.0, 0.05) << path;
  }
}

INSTANTIATE_TEST_SUITE_P(Functions, ControlOrder, testing::ValuesIn(control_cases),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(Controls, TheValueOfAnIntervalIsThatOfItsMiddle) {
  const SceneRun run("revolute_joint_lumped",
                     {"controls.agonist.field={ramp: {to: 30 kV/mm, over: 100 ms}}", "dynamics.step=10 ms"});
  const auto field = run.rows("controls/agonist");
  for (Eigen::Index i = 1; i <= 10; ++i) EXPECT_NEAR(field(0, i), 300.0 * (10.0 * static_cast<double>(i) - 5.0), 1e-9);
  EXPECT_EQ(field(0, 0), field(0, 1));
  EXPECT_EQ(field(0, 11), 30e3);
}

class RecordEvery : public testing::TestWithParam<const char*> {};

TEST_P(RecordEvery, TakesASubsetBitForBit) {
  const SceneRun all(GetParam(), {"dynamics.duration=100 ms", "record.every=1"});
  const SceneRun some(GetParam(), {"dynamics.duration=100 ms", "record.every=7"});
  const auto n_all = static_cast<Eigen::Index>(all.n_rows("time"));
  const auto n_some = static_cast<Eigen::Index>(some.n_rows("time"));
  ASSERT_EQ(n_some, (n_all - 1 + 6) / 7 + 1);  // the last node is there even if 7 does not divide the steps
  std::size_t n_channels = 0;
  for (const results::DeclaredChannel& channel : all.recorder().declared().channels) {
    const std::string& path = channel.spec.path;
    if (channel.spec.type != results::ValueType::float64 || path.starts_with("statics/")) continue;
    const auto a = all.rows(path), b = some.rows(path);
    for (Eigen::Index i = 0; i < n_some; ++i) {
      ASSERT_TRUE(b.col(i) == a.col(std::min(7 * i, n_all - 1))) << path << " row " << i;
    }
    ++n_channels;
  }
  EXPECT_GT(n_channels, 10U);
}

INSTANTIATE_TEST_SUITE_P(Scenes, RecordEvery,
                         testing::Values("revolute_joint_lumped", "elephant_trunk_lumped", "four_bar", "slider_crank",
                                         "tree", "double_pendulum"),
                         [](const auto& instance) { return std::string(instance.param); });

}  // namespace
}  // namespace muldi::golden
