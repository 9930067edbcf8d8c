/// Parts of a sweep: expressions of outputs, designs, journals.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "base/error.hpp"
#include "pipeline/study/design.hpp"
#include "pipeline/study/journal.hpp"
#include "pipeline/study/output_expression.hpp"

namespace muldi::pipeline {
namespace {

const std::string joint = MULDI_SOURCE_DIR "/scenes/revolute_joint_lumped.yaml";

/// Three rows of a point that moves along x = 1, -4, 2, and of a scalar 10, 20, 30.
void record(results::MemoryRecorder& recorder) {
  const results::Series series = recorder.declare_series({.axis = "time", .unit = "ms"});
  const results::Channel point =
      recorder.declare_channel(series, {.path = "points/arm.tip", .shape = {3}, .unit = "mm"});
  const results::Channel angle = recorder.declare_channel(series, {.path = "joints/j/coordinate", .shape = {1}});
  recorder.start();
  for (const double x : {1.0, -4.0, 2.0}) {
    const double row[] = {x, 0.0, 7.0};
    const double single[] = {10.0 * static_cast<double>(recorder.rows(series) + 1)};
    recorder.append(series.axis, x);
    recorder.append(point, std::span<const double>(row));
    recorder.append(angle, std::span<const double>(single));
  }
  recorder.set_attribute("statics", "limit_load", 42.0);
  recorder.close({.status = "completed", .where = {}, .time = 0.0});
}

double value(const std::string& text) {
  results::MemoryRecorder recorder;
  record(recorder);
  std::string error;
  const OutputExpression output = parse_output(text, error);
  EXPECT_EQ(error, "") << text;
  return value_of(output, recorder);
}

std::string fault(const std::string& text) {
  results::MemoryRecorder recorder;
  record(recorder);
  std::string error, unit;
  const OutputExpression output = parse_output(text, error);
  return error.empty() ? why_no_output(output, recorder.declared(), unit) : error;
}

TEST(OutputExpression, TakesRowsComponentsAndReductions) {
  EXPECT_EQ(value("joints.j.coordinate[0]"), 10.0);
  EXPECT_EQ(value("joints.j.coordinate[-1]"), 30.0);
  EXPECT_EQ(value("points.arm.tip[1, 0]"), -4.0);
  EXPECT_EQ(value("points.arm.tip[1][2]"), 7.0);
  EXPECT_EQ(value("final(points.arm.tip[:, 0])"), 2.0);
  EXPECT_EQ(value("max( points.arm.tip[:, 0] )"), 2.0);
  EXPECT_EQ(value("min(points.arm.tip[:, 0])"), -4.0);
  EXPECT_EQ(value("largest(points.arm.tip[:, 0])"), 4.0);
  EXPECT_EQ(value("mean(joints.j.coordinate)"), 20.0);
  EXPECT_EQ(value("statics.limit_load"), 42.0);
  EXPECT_TRUE(std::isnan(value("joints.j.coordinate[3]")));
}

TEST(OutputExpression, SaysWhatIsWrong) {
  EXPECT_EQ(fault("joints.j.coordinat[-1]"),
            "the result has no data set 'joints.j.coordinat' (did you mean 'joints.j.coordinate'?)");
  EXPECT_EQ(fault("joints.j.coordinate"), "is a series: give a row such as [-1], or a reduction such as max(...)");
  EXPECT_EQ(fault("points.arm.tip[-1]"), "the data set is (rows, 3): give the row and 1 component");
  EXPECT_EQ(fault("points.arm.tip[-1, 3]"), "the component is out of range");
  EXPECT_EQ(fault("maxi(joints.j.coordinate)"), "no reduction 'maxi' (did you mean 'max'?)");
  EXPECT_EQ(fault("max(joints.j.coordinate"), "the bracket is not closed");
  EXPECT_EQ(fault("joints.j.coordinate[x]"),
            "needs a data set with indices such as joints.hinge.coordinate[-1] or max(points.arm.tip[:, 1])");
}

scene::SweepStudy study(scene::Design design, std::vector<scene::VariedKey> keys) {
  scene::SweepStudy made;
  made.design = design;
  made.samples = 8;
  made.vary.items = std::move(keys);
  return made;
}

TEST(Design, OfAGridChangesTheLastKeyFastest) {
  using Kind = scene::VariedValues::Kind;
  const scene::SceneText text(joint, {});
  const SweepPlan plan = plan_sweep(
      study(scene::Design::grid, {{.path = "controls.agonist.field",
                                   .values = {.kind = Kind::linspace, .from = "0", .to = "30 kV/mm", .count = 3}},
                                  {.path = "muscles.*.section.diameter", .values = {.texts = {"10", "1.1 cm"}}}}),
      text);
  ASSERT_EQ(plan.points.size(), 6u);
  EXPECT_EQ(plan.points[3].numbers, (std::vector<double>{15000.0, 11.0}));
  EXPECT_EQ(plan.points[3].overrides,
            (std::vector<std::string>{"controls.agonist.field=15000", "muscles.upper.section.diameter=1.1 cm",
                                      "muscles.lower.section.diameter=1.1 cm"}));
}

TEST(Design, OfAHypercubeHasOnePointInEveryPart) {
  using Kind = scene::VariedValues::Kind;
  const scene::SceneText text(joint, {});
  const scene::SweepStudy made =
      study(scene::Design::lhs,
            {{.path = "controls.agonist.field", .values = {.kind = Kind::range, .from = "0", .to = "8000"}},
             {.path = "materials.silicone.viscous.viscosity",
              .values = {.kind = Kind::range, .from = "1", .to = "256", .logarithmic = true}}});
  const SweepPlan plan = plan_sweep(made, text);
  std::set<int> linear, logarithmic;
  for (const DesignPoint& point : plan.points) {
    linear.insert(static_cast<int>(point.numbers[0] / 1000.0));
    logarithmic.insert(static_cast<int>(std::log2(point.numbers[1])));
  }
  const std::set<int> every{0, 1, 2, 3, 4, 5, 6, 7};
  EXPECT_EQ(linear, every);
  EXPECT_EQ(logarithmic, every);
  EXPECT_EQ(plan_sweep(made, text).points[5].texts, plan.points[5].texts);  // by the seed alone
}

TEST(Design, RefusesValuesThatTheSceneRefuses) {
  const scene::SceneText text(joint, {});
  const scene::Origin origin{.place = {.file = "s.yaml", .line = 4, .column = 3}, .path = "vary.x"};
  try {
    plan_sweep(
        study(
            scene::Design::list,
            {{.path = "muscles.upper.section.diameter", .origin = origin, .values = {.texts = {"10", "-1", "3 kV"}}}}),
        text);
    FAIL() << "no error";
  } catch (const base::InputError& error) {
    EXPECT_STREQ(error.what(),
                 "s.yaml:4:3: error: vary.x: with '-1': muscles.upper.section.diameter: must be > 0, got '-1'\n"
                 "s.yaml:4:3: error: vary.x: with '3 kV': muscles.upper.section.diameter: needs length (mm), got '3 "
                 "kV' (voltage)");
  }
}

class JournalFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("journal" + std::to_string(::getpid()));
    std::filesystem::create_directory(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string path(const char* name = "a.journal") const { return (folder_ / name).string(); }

 private:
  std::filesystem::path folder_;
};

TEST_F(JournalFile, KeepsEveryBitOfWhatIsFinished) {
  const double awkward = 0.1 + 0.2;
  {
    Journal journal(path(), 7, false);
    journal.append({.point = 3, .status = "completed", .outputs = {awkward, -0.0}, .sentence = {}});
    journal.append({.point = 1, .status = "crashed", .outputs = {NAN, NAN}, .sentence = "a\tb\nc"});
  }
  const std::vector<FinishedPoint> points = finished_points(path(), 7, 2);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].outputs[0], awkward);
  EXPECT_TRUE(std::signbit(points[0].outputs[1]));
  EXPECT_TRUE(std::isnan(points[1].outputs[0]));
  EXPECT_EQ(points[1].sentence, "a b c");
  EXPECT_TRUE(finished_points(path(), 8, 2).empty());
}

TEST_F(JournalFile, LosesOnlyTheLineThatAKillHasCut) {
  {
    Journal journal(path(), 7, false);
    journal.append({.point = 0, .status = "completed", .outputs = {1.0}, .sentence = {}});
  }
  std::ofstream(path(), std::ios::app) << "1\tcompleted\t2.5";  // no newline: cut in the middle of 2.54, say
  EXPECT_EQ(finished_points(path(), 7, 1).size(), 1u);
  {
    Journal journal(path(), 7, false);
    journal.append({.point = 1, .status = "completed", .outputs = {2.54}, .sentence = {}});
  }
  const std::vector<FinishedPoint> points = finished_points(path(), 7, 1);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[1].outputs[0], 2.54);
}

TEST_F(JournalFile, IsWrittenByOneProcessForOneSweep) {
  const Journal journal(path(), 7, false);
  EXPECT_THROW(Journal(path(), 7, false), base::InputError);
  { const Journal other(path("b.journal"), 8, false); }
  EXPECT_THROW(Journal(path("b.journal"), 9, false), base::InputError);
  EXPECT_NO_THROW(Journal(path("b.journal"), 9, true));
}

TEST_F(JournalFile, OfShardsCountTogether) {
  { Journal(path("a.journal.1-of-2"), 7, false).append({.point = 0, .status = "completed", .outputs = {1.0}}); }
  { Journal(path("a.journal.2-of-2"), 7, false).append({.point = 1, .status = "completed", .outputs = {2.0}}); }
  { Journal(path("ab.journal"), 7, false).append({.point = 2, .status = "completed", .outputs = {3.0}}); }
  EXPECT_EQ(finished_points(path(), 7, 1).size(), 2u);
}

}  // namespace
}  // namespace muldi::pipeline
