#include <gmock/gmock.h>

#include <bit>

#include "recording.hpp"

namespace muldi::results {
namespace {

/// Records rows [begin, end); with `resume` into a file that has the rows before.
void record(const std::string& path, std::int64_t begin, std::int64_t end, std::size_t expected_rows = 0) {
  const auto mode = begin == 0 ? Output::Mode::create : Output::Mode::resume;
  Hdf5Recorder recorder({.path = path, .mode = mode});
  Recording recording(recorder, expected_rows);
  recorder.start();
  ASSERT_EQ(recorder.rows(recording.run), static_cast<std::size_t>(begin));
  recording.append_all(begin, end);
  recorder.close({.status = "completed", .where = {}, .time = 0.0});
}

TEST(Resume, GivesTheSameBitsAsAnUnbrokenRecording) {
  for (const std::int64_t broken_at : {1, 100, 1023, 1024, 1025, 2900}) {
    const Scratch scratch;
    record(scratch / "whole.h5", 0, 3000);
    record(scratch / "broken.h5", 0, broken_at);
    record(scratch / "broken.h5", broken_at, 3000);
    const ResultFile whole(scratch / "whole.h5"), broken(scratch / "broken.h5");
    ASSERT_EQ(whole.data_sets(), broken.data_sets());
    for (const std::string& path : whole.data_sets()) {
      if (path.starts_with("checkpoint/")) continue;  // compared by meaning below
      const Array a = whole.read(path), b = broken.read(path);
      ASSERT_EQ(a.shape, b.shape) << path;
      for (std::size_t i = 0; i < a.values.size(); ++i) {
        ASSERT_EQ(std::bit_cast<std::int64_t>(a.values[i]), std::bit_cast<std::int64_t>(b.values[i])) << path;
      }
    }
    EXPECT_EQ(whole.checkpoint()->checkpoint, broken.checkpoint()->checkpoint);
    EXPECT_EQ(whole.checkpoint()->rows, broken.checkpoint()->rows);
  }
}

TEST(Resume, GoesOnInChunksOfTheOldSize) {
  const Scratch scratch;
  record(scratch / "a.h5", 0, 10, 10);
  record(scratch / "a.h5", 10, 3000, 3000);
  expect_rows(ResultFile(scratch / "a.h5"), 3000);
}

TEST(Resume, CutsRowsAfterTheCheckpoint) {
  const Scratch scratch;
  const std::string path = scratch / "a.h5";
  {
    Hdf5Recorder recorder({.path = path});
    Recording recording(recorder);
    recorder.start();
    recording.append_all(0, 1500);
    for (int i = 0; i < 700; ++i) {  // rows without a checkpoint of their own
      recorder.append(recording.run.axis, -1.0);
      recorder.append(recording.position, std::array{-1.0, -1.0, -1.0});
      recorder.append(recording.orientation, std::array<double, 9>{});
      recorder.append(recording.iterations, 0);
    }
    recorder.close({.status = "interrupted"});
  }
  EXPECT_EQ(ResultFile(path).axes().at("time"), 2200U);
  record(path, 1500, 1600);
  expect_rows(ResultFile(path), 1600);
}

TEST(Resume, SaysRunningAgain) {
  const Scratch scratch;
  const std::string path = scratch / "a.h5";
  record(path, 0, 5);
  Hdf5Recorder recorder({.path = path, .mode = Output::Mode::resume});
  Recording recording(recorder);
  recorder.start();
  EXPECT_EQ(ResultFile(path).text("status"), "running");
  recorder.close({.status = "interrupted"});
  EXPECT_EQ(ResultFile(path).text("status"), "interrupted");
  EXPECT_EQ(ResultFile(path).text("title"), "Pendel \xc3\xa4");
}

TEST(Resume, RefusesOtherChannelsNamingAllDifferences) {
  const Scratch scratch;
  const std::string path = scratch / "a.h5";
  record(path, 0, 5);
  const auto resume = [&] {
    Hdf5Recorder recorder({.path = path, .mode = Output::Mode::resume});
    const Series run = recorder.declare_series({.axis = "time", .unit = "s"});
    recorder.declare_channel(run, {.path = "bodies/pendulum/position", .shape = {2}, .unit = "mm"});
    recorder.declare_channel(run, {.path = "bodies/pendulum/orientation", .shape = {3, 3}});
    recorder.declare_channel(run, {.path = "solver/iterations"});
    recorder.declare_channel(run, {.path = "bodies/top/position", .shape = {3}});
    recorder.declare_fixed({.path = "solids/cube/cells", .shape = {4}}, std::array<std::int64_t, 4>{3, 2, 1, 9});
    recorder.declare_checkpoint(Recording::checkpoint(0));
    recorder.start();
  };
  EXPECT_EQ(message_of<base::InputError>(resume),
            path + ": error: time: cannot be resumed: it has another unit\n" +  //
                path + ": error: bodies/pendulum/position: cannot be resumed: it has rows of another shape\n" + path +
                ": error: solver/iterations: cannot be resumed: it has values of another type\n" + path +
                ": error: bodies/top/position: cannot be resumed: the file lacks it\n" + path +
                ": error: solids/cube/cells: cannot be resumed: the file has other values\n" + path +
                ": error: statics/load: cannot be resumed: the scene does not record it\n" + path +
                ": error: statics/muscles/upper/force: cannot be resumed: the scene does not record it");
  expect_rows(ResultFile(path), 5);
  EXPECT_EQ(ResultFile(path).text("status"), "completed") << "a refused file is left as it was";
}

TEST(Resume, RefusesAnotherCheckpoint) {
  const Scratch scratch;
  const std::string path = scratch / "a.h5";
  record(path, 0, 5);
  const auto resume = [&] {
    Hdf5Recorder recorder({.path = path, .mode = Output::Mode::resume});
    Recording recording(recorder);
    recorder.declare_checkpoint({.reals = {{"q", {0.0, 0.0, 0.0}}, {"p", {0.0}}}, .integers = {{"step", {0}}}});
    recorder.start();
  };
  EXPECT_EQ(message_of<base::InputError>(resume),
            "error: '" + path + "' cannot be resumed: its checkpoint is not of this scene");
}

}  // namespace
}  // namespace muldi::results
