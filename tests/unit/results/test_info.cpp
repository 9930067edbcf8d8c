#include "results/info.hpp"

#include <gmock/gmock.h>

#include "recording.hpp"

namespace muldi::results {
namespace {

TEST(Info, TellsStatusSizesFinalValuesAndTimes) {
  const Scratch scratch;
  const std::string path = scratch / "a.h5";
  {
    Hdf5Recorder recorder({.path = path});
    Recording recording(recorder);
    recorder.set_attribute("", "command_line", std::string("muldi-sim run pendulum.yaml"));
    recorder.start();
    recording.append_all(0, 10);
    recorder.set_attribute("", "wall_time.step", 0.25);
    recorder.set_attribute("", "wall_time.build", 0.125);
    recorder.close({.status = "no_convergence", .where = "residual 1e3", .time = 4.5});
  }
  const auto bytes = std::filesystem::file_size(path);
  const auto tenths = (bytes + 50) / 100;
  const std::string size = std::to_string(tenths / 10) + "." + std::to_string(tenths % 10);
  EXPECT_EQ(info(path), path +
                            "\n"
                            "  status         no_convergence at 4.5 ms: residual 1e3\n"
                            "  title          Pendel \xc3\xa4\n"
                            "  command_line   muldi-sim run pendulum.yaml\n"
                            "  threads        2\n"
                            "  size           " +
                            size +
                            " kB in 13 data sets\n"
                            "  /statics/load  no rows yet\n"
                            "  /time          10 rows from 0 to 4.5 ms\n"
                            "final values\n"
                            "  /bodies/pendulum/orientation  [1, 0, 9, 0, 1, 0, 0, 0, 0.1]\n"
                            "  /bodies/pendulum/position     [9, 3, -9] mm\n"
                            "  /statics/muscles/upper/force  no rows yet\n"
                            "solver\n"
                            "  /solver/iterations  mean 2.4, largest 6, sum 24\n"
                            "wall time\n"
                            "  build  0.125 s\n"
                            "  step   0.25 s\n");
}

TEST(Info, TellsAKilledRunFromARunningOne) {
  const Scratch scratch;
  const std::string path = scratch / "a.h5";
  Hdf5Recorder recorder({.path = path});
  Recording recording(recorder);
  recorder.start();
  recording.append(0);
  recorder.flush();
  EXPECT_THAT(info(path), testing::HasSubstr("status         running\n"));
  std::filesystem::copy_file(path, scratch / "copy.h5");
  EXPECT_THAT(info(scratch / "copy.h5"),
              testing::HasSubstr("status         running (no process writes it: it was killed)\n"));
  recorder.close({.status = "completed"});
}

}  // namespace
}  // namespace muldi::results
