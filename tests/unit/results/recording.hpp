#pragma once
/// A small recording that every test can check: the values of each row follow from its number.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <string>

#include "results/hdf5_recorder.hpp"
#include "results/result_file.hpp"

namespace muldi::results {

/// A folder of its own for one test, removed at its end.
class Scratch {
 public:
  Scratch() {
    std::string pattern = (std::filesystem::temp_directory_path() / "muldi_results_XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~Scratch() { std::filesystem::remove_all(folder_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  std::string operator/(const std::string& name) const { return (folder_ / name).string(); }

 private:
  std::filesystem::path folder_;
};

/// Channels, a fixed array, a checkpoint and a second series; row i has the time 0.5 i.
struct Recording {
  Recorder& recorder;
  Series run;
  Channel position;
  Channel orientation;
  Channel iterations;
  Series sweep;
  Channel force;

  static Checkpoint checkpoint(std::int64_t step) {
    const auto value = static_cast<double>(step);
    return {.reals = {{"q", {value, value / 3.0}}, {"p", {-value}}}, .integers = {{"step", {step}}}};
  }

  explicit Recording(Recorder& target, std::size_t expected_rows = 0) : recorder(target) {
    run = recorder.declare_series({.axis = "time", .unit = "ms", .doc = "Time nodes.", .expected_rows = expected_rows});
    position = recorder.declare_channel(
        run, {.path = "bodies/pendulum/position", .shape = {3}, .unit = "mm", .doc = "Centre of mass."});
    orientation = recorder.declare_channel(run, {.path = "bodies/pendulum/orientation", .shape = {3, 3}});
    iterations = recorder.declare_channel(run, {.path = "solver/iterations", .type = ValueType::int64});
    sweep = recorder.declare_series({.axis = "statics/load"});
    force = recorder.declare_channel(sweep, {.path = "statics/muscles/upper/force", .unit = "N"});
    recorder.declare_fixed({.path = "solids/cube/reference", .shape = {2, 3}, .unit = "mm"},
                           std::array{0.0, 1.0, 2.0, 3.0, 4.0, 5.0});
    recorder.declare_fixed({.path = "solids/cube/cells", .shape = {4}}, std::array<std::int64_t, 4>{3, 2, 1, 0});
    recorder.declare_checkpoint(checkpoint(0));
    recorder.set_attribute("", "title", std::string("Pendel \xc3\xa4"));
    recorder.set_attribute("", "threads", std::int64_t{2});
    recorder.set_attribute("bodies/pendulum", "mass", 40.0);
  }

  /// Row i of the run and the checkpoint that belongs to it.
  void append(std::int64_t i) {
    const auto x = static_cast<double>(i);
    recorder.append(run.axis, 0.5 * x);
    recorder.append(position, std::array{x, x / 3.0, -x});
    recorder.append(orientation, std::array{1.0, 0.0, x, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0 / (1.0 + x)});
    recorder.append(iterations, i % 7);
    recorder.write_checkpoint(checkpoint(i));
  }
  void append_all(std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) append(i);
  }
};

/// Fails unless the file holds rows 0 to n - 1 of the recording in all its channels.
inline void expect_rows(const ResultFile& file, std::size_t n) {
  const Array time = file.read("time"), position = file.read("bodies/pendulum/position");
  const Array orientation = file.read("bodies/pendulum/orientation"), iterations = file.read("solver/iterations");
  ASSERT_EQ(time.shape, (Shape{n}));
  ASSERT_EQ(position.shape, (Shape{n, 3}));
  ASSERT_EQ(orientation.shape, (Shape{n, 3, 3}));
  ASSERT_EQ(iterations.shape, (Shape{n}));
  for (std::size_t i = 0; i < n; ++i) {
    const auto x = static_cast<double>(i);
    ASSERT_EQ(time.values[i], 0.5 * x);
    ASSERT_EQ(position.values[3 * i + 1], x / 3.0);
    ASSERT_EQ(position.values[3 * i + 2], -x);
    ASSERT_EQ(orientation.values[9 * i + 2], x);
    ASSERT_EQ(orientation.values[9 * i + 8], 1.0 / (1.0 + x));
    ASSERT_EQ(iterations.values[i], static_cast<double>(i % 7));
  }
}

/// The message of the exception of type `Error` that `action` throws; empty if it throws none.
template <class Error, class Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

}  // namespace muldi::results
