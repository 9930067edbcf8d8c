#include <gmock/gmock.h>

#include "recording.hpp"
#include "results/memory_recorder.hpp"

namespace muldi::results {
namespace {

using testing::ElementsAre;

TEST(MemoryRecorder, KeepsRowsBeyondOneBlock) {
  MemoryRecorder recorder;
  Recording recording(recorder);
  recorder.start();
  recording.append_all(0, 3000);
  recorder.close({.status = "completed", .time = 1499.5});
  EXPECT_EQ(recorder.rows(recording.run), 3000U);
  ASSERT_EQ(recorder.reals("bodies/pendulum/position").size(), 9000U);
  EXPECT_EQ(recorder.reals("time")[2999], 1499.5);
  EXPECT_EQ(recorder.reals("bodies/pendulum/position")[3 * 2999 + 2], -2999.0);
  EXPECT_EQ(recorder.integers("solver/iterations")[2999], 2999 % 7);
  EXPECT_EQ(recorder.checkpoint(), Recording::checkpoint(2999));
  EXPECT_EQ(recorder.ending().status, "completed");
}

TEST(MemoryRecorder, DropsAnIncompleteRow) {
  MemoryRecorder recorder;
  const Series run = recorder.declare_series({.axis = "time"});
  const Channel x = recorder.declare_channel(run, {.path = "x"});
  recorder.start();
  recorder.append(run.axis, 0.0);
  recorder.append(x, 1.0);
  recorder.append(run.axis, 1.0);
  recorder.close({.status = "interrupted"});
  EXPECT_THAT(recorder.reals("time"), ElementsAre(0.0));
  EXPECT_THAT(recorder.reals("x"), ElementsAre(1.0));
}

TEST(MemoryRecorder, AdvancesSeriesIndependently) {
  MemoryRecorder recorder;
  Recording recording(recorder);
  recorder.start();
  recording.append_all(0, 2);
  recorder.append(recording.sweep.axis, 10.0);
  recorder.append(recording.force, 3.0);
  recorder.close({.status = "completed"});
  EXPECT_THAT(recorder.reals("time"), ElementsAre(0.0, 0.5));
  EXPECT_THAT(recorder.reals("statics/load"), ElementsAre(10.0));
  EXPECT_THAT(recorder.reals("statics/muscles/upper/force"), ElementsAre(3.0));
}

TEST(MemoryRecorder, KeepsLateDeclarationsForTheEnd) {
  MemoryRecorder recorder;
  Recording recording(recorder);
  recorder.start();
  recorder.set_attribute("", "wall_time.step", 1.0);
  recorder.set_attribute("", "wall_time.step", 2.0);
  recorder.declare_fixed({.path = "modes", .shape = {2}}, std::array{1.0, 2.0});
  EXPECT_TRUE(recorder.late_attributes().empty());
  recorder.close({.status = "completed"});
  EXPECT_THAT(recorder.late_attributes(), ElementsAre(Attribute{"", "wall_time.step", 2.0}));
  ASSERT_EQ(recorder.late_fixed().size(), 1U);
  EXPECT_THAT(recorder.late_fixed()[0].reals, ElementsAre(1.0, 2.0));
}

TEST(Recorder, RejectsMisuse) {
  MemoryRecorder recorder;
  const Series run = recorder.declare_series({.axis = "time"});
  const Channel x = recorder.declare_channel(run, {.path = "x", .shape = {2}});
  EXPECT_THROW(recorder.declare_channel(run, {.path = "empty", .shape = {0}}), base::ContractError);
  EXPECT_THROW(recorder.append(x, std::array{1.0, 2.0}), base::ContractError) << "not started";
  recorder.start();
  EXPECT_THROW(recorder.append(x, 1.0), base::ContractError) << "one value of two";
  EXPECT_THROW(recorder.append(x, std::array<std::int64_t, 2>{1, 2}), base::ContractError) << "integers";
  recorder.append(x, std::array{1.0, 2.0});
  EXPECT_THROW(recorder.append(x, std::array{1.0, 2.0}), base::ContractError) << "twice in one row";
  EXPECT_THROW(recorder.declare_channel(run, {.path = "late"}), base::ContractError);
  EXPECT_THROW(recorder.write_checkpoint(Recording::checkpoint(0)), base::ContractError) << "none was declared";
}

TEST(Recorder, RejectsPathsThatCannotBe) {
  const auto start_with = [](const std::string& path) {
    MemoryRecorder recorder;
    const Series run = recorder.declare_series({.axis = "time"});
    recorder.declare_series({.axis = "statics/load"});
    recorder.declare_channel(run, {.path = path});
    recorder.start();
  };
  EXPECT_NO_THROW(start_with("bodies/a/position"));
  EXPECT_THROW(start_with("/bodies"), base::ContractError);
  EXPECT_THROW(start_with("time"), base::ContractError) << "declared twice";
  EXPECT_THROW(start_with("statics/x"), base::ContractError) << "lies below the axis of another series";
}

TEST(Checkpoint, FindsVectorsByName) {
  const Checkpoint checkpoint = Recording::checkpoint(6);
  EXPECT_THAT(checkpoint.real("q"), ElementsAre(6.0, 2.0));
  EXPECT_THAT(checkpoint.integer("step"), ElementsAre(6));
  EXPECT_THROW(checkpoint.real("step"), base::ContractError);
}

}  // namespace
}  // namespace muldi::results
