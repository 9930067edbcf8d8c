#include <sys/wait.h>

#include <csignal>

#include "recording.hpp"
#include "results/superblock.hpp"

namespace muldi::results {
namespace {

/// Starts a process that records until it is killed; returns when its first row is on record.
pid_t record_forever(const std::string& path) {
  const pid_t child = ::fork();
  if (child == 0) {
    Hdf5Recorder recorder({.path = path});
    Recording recording(recorder);
    recorder.start();
    recording.append(0);
    recorder.flush();
    for (std::int64_t i = 1;; ++i) {
      recording.append(i);
      if (i % 256 == 0) ::usleep(1000);  // or the file outgrows its readers
    }
  }
  for (int tries = 0; tries < 1000; ++tries) {
    if (read_superblock(path)) break;
    ::usleep(1000);
  }
  return child;
}

void kill(pid_t child) {
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
}

void record_and_kill(const std::string& path, useconds_t microseconds) {
  const pid_t child = record_forever(path);
  ::usleep(microseconds);
  kill(child);
}

TEST(RunningRecorder, CanBeReadAtAnyMoment) {
  const Scratch scratch;
  const pid_t child = record_forever(scratch / "a.h5");
  std::size_t before = 0;
  for (int i = 0; i < 20; ++i) {
    try {
      const ResultFile file(scratch / "a.h5");
      const std::size_t n = file.axes().at("time");
      expect_rows(file, n);
      EXPECT_EQ(file.text("status"), "running");
      EXPECT_GE(n, before);
      before = n;
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
  }
  kill(child);
}

TEST(RunningRecorder, LetsTheFileGrowBeforeItsSuperblockSays) {
  // Readers of the library ask for the size first, then read the superblock; meanwhile the file goes on growing.
  const Scratch scratch;
  Hdf5Recorder recorder({.path = scratch / "a.h5"});
  Recording recording(recorder);
  recorder.start();
  std::uint64_t first = 0, last = 0;
  for (std::int64_t i = 0; i < 200; ++i) {
    const std::uint64_t size = std::filesystem::file_size(scratch / "a.h5");
    recording.append_all(i * 256, (i + 1) * 256);
    recorder.flush();
    last = read_superblock(scratch / "a.h5")->end_of_file;
    if (i == 0) first = last;
    if (i > 0) {
      ASSERT_GE(size, last) << "flush " << i;
    }
  }
  EXPECT_GT(last, first + (std::uint64_t{4} << 20)) << "several times";
}

TEST(KilledRecorder, LeavesCompleteRowsAndTheStatusRunning) {
  std::size_t most = 0;
  for (useconds_t i = 0; i < 20; ++i) {
    const Scratch scratch;
    record_and_kill(scratch / "a.h5", 5000 + 7919 * i % 20'000);
    const ResultFile file(scratch / "a.h5");
    const std::size_t n = file.axes().at("time");
    expect_rows(file, n);
    EXPECT_EQ(file.text("status"), "running");
    const auto stored = file.checkpoint();
    ASSERT_TRUE(stored);
    EXPECT_LE(static_cast<std::size_t>(stored->rows[0]), n) << "rows of the checkpoint are on record";
    EXPECT_EQ(stored->checkpoint.integer("step")[0], std::max<std::int64_t>(stored->rows[0] - 1, 0));
    EXPECT_EQ(stored->checkpoint.real("q")[0], static_cast<double>(stored->checkpoint.integer("step")[0]));
    most = std::max(most, n);
  }
  EXPECT_GT(most, 1024U) << "at least one process was killed after several flushes";
}

TEST(KilledRecorder, CanBeResumed) {
  const Scratch scratch;
  const std::string path = scratch / "a.h5";
  record_and_kill(path, 15'000);
  Hdf5Recorder recorder({.path = path, .mode = Output::Mode::resume});
  const std::int64_t step = recorder.resume_point()->integer("step")[0];
  {
    Recording recording(recorder);
    recorder.start();
    const std::int64_t n = static_cast<std::int64_t>(recorder.rows(recording.run));
    EXPECT_EQ(n, step + 1) << "the checkpoint of a row belongs to the rows up to it";
    recording.append_all(n, n + 2000);
    recorder.close({.status = "completed"});
    expect_rows(ResultFile(path), static_cast<std::size_t>(n) + 2000);
  }
  EXPECT_EQ(ResultFile(path).text("status"), "completed");
}

}  // namespace
}  // namespace muldi::results
