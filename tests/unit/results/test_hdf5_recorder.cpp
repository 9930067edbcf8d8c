#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <csignal>
#include <fstream>
#include <future>
#include <numeric>
#include <thread>

#include "recording.hpp"

namespace muldi::results {
namespace {

using testing::ElementsAre;
using testing::Optional;

void record(const std::string& path, std::int64_t n_rows) {
  Hdf5Recorder recorder({.path = path});
  Recording recording(recorder, static_cast<std::size_t>(n_rows));
  recorder.start();
  recording.append_all(0, n_rows);
  recorder.close({.status = "completed", .where = {}, .time = 0.5 * static_cast<double>(n_rows - 1)});
}

TEST(Hdf5Recorder, WritesWhatWasAppended) {
  for (const std::int64_t n : {0, 1, 5, 64, 1024, 1025, 2500}) {
    const Scratch scratch;
    record(scratch / "a.h5", n);
    const ResultFile file(scratch / "a.h5");
    expect_rows(file, static_cast<std::size_t>(n));
    EXPECT_EQ(file.text("status"), "completed");
    EXPECT_EQ(file.checkpoint()->rows, (std::vector<std::int64_t>{n, 0}));
  }
}

TEST(Hdf5Recorder, WritesFixedArraysAttributesAndUnits) {
  const Scratch scratch;
  record(scratch / "a.h5", 3);
  const ResultFile file(scratch / "a.h5");
  EXPECT_THAT(file.read("solids/cube/reference").values, ElementsAre(0.0, 1.0, 2.0, 3.0, 4.0, 5.0));
  EXPECT_EQ(file.read("solids/cube/reference").shape, (Shape{2, 3}));
  EXPECT_THAT(file.read("solids/cube/cells").values, ElementsAre(3.0, 2.0, 1.0, 0.0));
  EXPECT_EQ(file.text("title"), "Pendel \xc3\xa4");
  EXPECT_THAT(file.attribute("", "threads"), Optional(AttributeValue(std::int64_t{2})));
  EXPECT_THAT(file.attribute("bodies/pendulum", "mass"), Optional(AttributeValue(40.0)));
  EXPECT_EQ(file.read("bodies/pendulum/position").unit, "mm");
  EXPECT_EQ(file.attribute("bodies/pendulum/position", "doc"), AttributeValue(std::string("Centre of mass.")));
  EXPECT_EQ(file.axis_of("statics/muscles/upper/force"), "statics/load");
  EXPECT_EQ(file.axis_of("solids/cube/reference"), std::nullopt);
}

TEST(Hdf5Recorder, CompressesFieldsAndReadsThemBack) {
  const Scratch scratch;
  const std::size_t nodes = 2000;
  std::vector<double> field(3 * nodes);
  {
    Hdf5Recorder recorder({.path = scratch / "a.h5"});
    const Series times = recorder.declare_series({.axis = "solids/cube/times"});
    const Channel position =
        recorder.declare_channel(times, {.path = "solids/cube/position", .shape = {nodes, 3}, .unit = "mm"});
    recorder.declare_fixed({.path = "solids/cube/reference", .shape = {nodes, 3}}, field);
    recorder.start();
    for (int k = 0; k < 11; ++k) {
      std::iota(field.begin(), field.end(), k);
      recorder.append(times.axis, k);
      recorder.append(position, field);
      if (k % 3 == 0) recorder.flush();
    }
    recorder.close({.status = "completed"});
  }
  const ResultFile file(scratch / "a.h5");
  const Array position = file.read("solids/cube/position");
  ASSERT_EQ(position.shape, (Shape{11, nodes, 3}));
  for (std::size_t k = 0; k < 11; ++k) {
    ASSERT_EQ(position.values[k * 3 * nodes], static_cast<double>(k));
    ASSERT_EQ(position.values[(k + 1) * 3 * nodes - 1], static_cast<double>(k + 3 * nodes - 1));
  }
  EXPECT_LT(file.bytes(), 12 * nodes * 3 * sizeof(double) / 2);
}

TEST(Hdf5Recorder, ShowsRowsOfARunningFileAfterEachFlush) {
  const Scratch scratch;
  Hdf5Recorder recorder({.path = scratch / "a.h5"});
  Recording recording(recorder);
  recorder.start();
  std::int64_t n = 0;
  for (const std::int64_t more : {1, 10, 700, 700, 700}) {
    recording.append_all(n, n + more);
    n += more;
    recorder.flush();
    EXPECT_EQ(ResultFile(scratch / "a.h5").text("status"), "running");
    // Another process: here the library would find the file open and show it as the writer sees it.
    const std::string command = RECORDING_PROCESS " read " + (scratch / "a.h5") + " " + std::to_string(n);
    EXPECT_EQ(std::system(command.c_str()), 0);
  }
  recorder.close({.status = "completed"});
  expect_rows(ResultFile(scratch / "a.h5"), static_cast<std::size_t>(n));
}

TEST(Hdf5Recorder, FlushesByTheClock) {
  const Scratch scratch;
  Hdf5Recorder recorder({.path = scratch / "a.h5", .flush_interval = std::chrono::milliseconds(20)});
  Recording recording(recorder);
  recorder.start();
  recording.append(0);
  ::usleep(30'000);
  recording.append(1);
  // The checkpoint of a row comes after it: the flush that row 1 caused shows that of row 0.
  EXPECT_EQ(ResultFile(scratch / "a.h5").checkpoint()->checkpoint, (Checkpoint{
                                                                       .reals = {{"p", {-0.0}}, {"q", {0.0, 0.0}}},
                                                                       .integers = {{"step", {0}}},
                                                                   }));
  EXPECT_EQ(ResultFile(scratch / "a.h5").read("time").shape, (Shape{2}));
  recorder.close({.status = "completed"});
}

TEST(Hdf5Recorder, PutsDownHowTheRunEnded) {
  const Scratch scratch;
  Hdf5Recorder recorder({.path = scratch / "a.h5"});
  Recording recording(recorder);
  recorder.start();
  recording.append_all(0, 4);
  recorder.set_attribute("", "wall_time.step", 0.25);
  recorder.declare_fixed({.path = "optimum/last/bounds", .shape = {1}}, std::array{1.0});
  recorder.close({.status = "no_convergence", .where = "step 4: residual 1e3", .time = 2.0});
  const ResultFile file(scratch / "a.h5");
  EXPECT_EQ(file.text("status"), "no_convergence");
  EXPECT_EQ(file.text("status_where"), "step 4: residual 1e3");
  EXPECT_EQ(file.attribute("", "status_time"), AttributeValue(2.0));
  EXPECT_EQ(file.attribute("", "wall_time.step"), AttributeValue(0.25));
  EXPECT_THAT(file.read("optimum/last/bounds").values, ElementsAre(1.0));
  expect_rows(file, 4);
}

TEST(Hdf5Recorder, CallsARecordingThatNobodyClosedInterrupted) {
  const Scratch scratch;
  {
    Hdf5Recorder recorder({.path = scratch / "a.h5"});
    Recording recording(recorder);
    recorder.start();
    recording.append_all(0, 4);
  }
  const ResultFile file(scratch / "a.h5");
  EXPECT_EQ(file.text("status"), "interrupted");
  EXPECT_EQ(file.text("status_where"), "the recording was not closed");
  expect_rows(file, 4);
}

TEST(Hdf5Recorder, KeepsAnExistingFileUnlessToldToOverwrite) {
  const Scratch scratch;
  const std::string path = scratch / "a.h5";
  std::ofstream(path) << "not to be lost";
  const auto start = [&](Output::Mode mode) {
    Hdf5Recorder recorder({.path = path, .mode = mode});
    Recording recording(recorder);
    recorder.start();
    recorder.close({.status = "completed"});
  };
  EXPECT_EQ(message_of<base::InputError>([&] { start(Output::Mode::create); }),
            "error: '" + path + "' exists (--force overwrites it, --output names another file)");
  EXPECT_EQ(std::filesystem::file_size(path), 14U);
  start(Output::Mode::overwrite);
  EXPECT_EQ(ResultFile(path).text("status"), "completed");
}

TEST(Hdf5Recorder, RefusesAFileThatIsBeingWritten) {
  const Scratch scratch;
  const std::string path = scratch / "a.h5";
  Hdf5Recorder first({.path = path});
  Recording recording(first);
  first.start();
  recording.append_all(0, 3);
  first.flush();
  const std::string expected = "error: '" + path + "' is in use by another process";
  EXPECT_EQ(message_of<base::InputError>([&] { Hdf5Recorder({.path = path, .mode = Output::Mode::resume}); }),
            expected);
  EXPECT_EQ(message_of<base::InputError>([&] {
              Hdf5Recorder second({.path = path, .mode = Output::Mode::overwrite});
              second.start();
            }),
            expected);
  first.close({.status = "completed"});
  expect_rows(ResultFile(path), 3);
}

TEST(Hdf5Recorder, WaitsForAReaderThatTriesToOpenTheFile) {
  const Scratch scratch;
  const std::string path = scratch / "a.h5";
  record(path, 3);
  const int reader = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(reader, LOCK_SH), 0);
  const auto attempt = std::async(std::launch::async, [reader] {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    ::close(reader);
  });
  Hdf5Recorder recorder({.path = path, .mode = Output::Mode::resume});
  EXPECT_TRUE(recorder.resume_point());
}

TEST(Hdf5Recorder, SaysWhyItCannotWrite) {
  const auto start = [](const std::string& path, Output::Mode mode) {
    return message_of<base::EnvironmentError>([&] { Hdf5Recorder({.path = path, .mode = mode}).start(); });
  };
  EXPECT_EQ(start("/nowhere/a.h5", Output::Mode::create), "cannot write '/nowhere/a.h5': No such file or directory");
  EXPECT_EQ(start("/proc/a.h5", Output::Mode::create), "cannot write '/proc/a.h5': No such file or directory");
  EXPECT_EQ(start("/dev/full", Output::Mode::overwrite), "cannot write '/dev/full': not a regular file");
}

/// Runs `action` in a process that may not make files larger than `bytes`; its exit code.
template <class Action>
int run_with_file_limit(rlim_t bytes, Action action) {
  const pid_t child = ::fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    ::_exit(action());
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Hdf5Recorder, KeepsCompleteRowsWhenTheDiskIsFull) {
  for (const rlim_t limit : {200'000, 300'000, 350'000, 512'345, 1'000'000}) {
    const Scratch scratch;
    const std::string path = scratch / "a.h5";
    const int code = run_with_file_limit(limit, [&] {
      Hdf5Recorder recorder({.path = path});
      Recording recording(recorder);
      recorder.start();
      const std::string message = message_of<base::EnvironmentError>([&] { recording.append_all(0, 100'000); });
      recorder.close({.status = "completed"});
      return message.ends_with(": File too large") ? 7 : 8;
    });
    ASSERT_EQ(code, 7);
    const ResultFile file(path);
    const std::size_t n = file.axes().at("time");
    EXPECT_GT(n, 500U);
    expect_rows(file, n);
    EXPECT_EQ(file.text("status"), "write_error");
    EXPECT_TRUE(file.text("status_where").ends_with(": File too large")) << file.text("status_where");
  }
}

TEST(Hdf5Recorder, LeavesNoFileBehindIfItCannotBeMade) {
  const Scratch scratch;
  const std::string path = scratch / "a.h5";
  EXPECT_EQ(run_with_file_limit(1000,
                                [&] {
                                  const std::string message = message_of<base::EnvironmentError>([&] {
                                    Hdf5Recorder recorder({.path = path});
                                    Recording recording(recorder);
                                    recorder.start();
                                    recording.append(0);
                                    recorder.flush();
                                  });
                                  return message == "cannot write '" + path + "': File too large" ? 7 : 8;
                                }),
            7);
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace muldi::results
