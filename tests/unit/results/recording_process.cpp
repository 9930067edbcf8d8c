/// A process that writes or reads the recording of recording.hpp, for tests that need a second one.
///   recording_process write FILE ROWS   records, then kills itself without closing
///   recording_process read FILE ROWS    exit code 0 if the running file shows these rows and the checkpoint of the
///   last
#include <csignal>
#include <iostream>

#include "recording.hpp"

namespace {

void write_and_die(const std::string& path, std::int64_t rows) {
  muldi::results::Hdf5Recorder recorder({.path = path});
  muldi::results::Recording recording(recorder);
  recorder.start();
  recording.append_all(0, rows);
  std::raise(SIGKILL);
}

bool shows(const std::string& path, std::int64_t rows) {
  const muldi::results::ResultFile file(path);
  muldi::results::expect_rows(file, static_cast<std::size_t>(rows));
  EXPECT_EQ(file.text("status"), "running");
  EXPECT_EQ(file.checkpoint()->checkpoint.integer("step"), std::vector{rows - 1});
  return !testing::Test::HasFailure();
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  if (argc != 4) return 2;
  const std::string verb = argv[1], path = argv[2];
  const std::int64_t rows = std::stoll(argv[3]);
  try {
    if (verb == "write") write_and_die(path, rows);
    return shows(path, rows) ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
