#include <gmock/gmock.h>

#include <fstream>

#include "recording.hpp"

/// Read by the leak sanitizer: the HDF5 library loses memory of its own when it meets damaged metadata.
extern "C" const char* __lsan_default_suppressions() { return "leak:H5FL__malloc\n"; }  // NOLINT(readability-*)

namespace muldi::results {
namespace {

using testing::ElementsAre;

void record(const std::string& path, std::int64_t n_rows) {
  Hdf5Recorder recorder({.path = path});
  Recording recording(recorder);
  recorder.start();
  recording.append_all(0, n_rows);
  recorder.close({.status = "completed"});
}

TEST(ResultFile, ListsDataSetsAndAxes) {
  const Scratch scratch;
  record(scratch / "a.h5", 5);
  const ResultFile file(scratch / "a.h5");
  EXPECT_THAT(
      file.data_sets(),
      ElementsAre("bodies/pendulum/orientation", "bodies/pendulum/position", "checkpoint/counter", "checkpoint/p",
                  "checkpoint/q", "checkpoint/rows", "checkpoint/step", "solids/cube/cells", "solids/cube/reference",
                  "solver/iterations", "statics/load", "statics/muscles/upper/force", "time"));
  EXPECT_EQ(file.axes(), (std::map<std::string, std::size_t>{{"statics/load", 0}, {"time", 5}}));
  EXPECT_TRUE(file.contains("time"));
  EXPECT_FALSE(file.contains("bodies"));
}

TEST(ResultFile, ReadsTheLastRow) {
  const Scratch scratch;
  record(scratch / "a.h5", 5);
  const ResultFile file(scratch / "a.h5");
  EXPECT_THAT(file.last_row("bodies/pendulum/position").values, ElementsAre(4.0, 4.0 / 3.0, -4.0));
  EXPECT_THAT(file.last_row("statics/muscles/upper/force").values, ElementsAre());
  EXPECT_EQ(file.last_row("statics/muscles/upper/force").shape, (Shape{0}));
}

TEST(ResultFile, RefusesWhatIsNoResult) {
  const Scratch scratch;
  const auto open = [](const std::string& path) {
    return message_of<base::InputError>([&] { const ResultFile file(path); });
  };
  EXPECT_EQ(open(scratch / "none.h5"), "error: cannot read '" + (scratch / "none.h5") + "': No such file or directory");
  std::ofstream(scratch / "text.h5") << "hello, this is no HDF5 file";
  EXPECT_EQ(open(scratch / "text.h5"), "error: cannot read '" + (scratch / "text.h5") + "': not an HDF5 file");
  std::ofstream(scratch / "empty.h5") << "";
  EXPECT_EQ(open(scratch / "empty.h5"), "error: cannot read '" + (scratch / "empty.h5") +
                                            "': it is empty: no result, or its run was killed before its start "
                                            "was recorded");
}

TEST(ResultFile, RefusesATruncatedFile) {
  const Scratch scratch;
  const std::string path = scratch / "a.h5";
  record(path, 2000);
  const auto size = std::filesystem::file_size(path);
  std::filesystem::resize_file(path, size - 100);
  const std::string expected = "error: cannot read '" + path + "': truncated, it has " + std::to_string(size - 100) +
                               " of " + std::to_string(size) + " bytes";
  EXPECT_EQ(message_of<base::InputError>([&] { const ResultFile file(path); }), expected);
  EXPECT_EQ(message_of<base::InputError>([&] { Hdf5Recorder({.path = path, .mode = Output::Mode::resume}); }),
            expected);
}

TEST(ResultFile, NeverReadsDamagedMetadataAsSomethingElse) {
  const Scratch scratch;
  const std::string path = scratch / "a.h5", damaged = scratch / "damaged.h5";
  record(path, 20);
  // The first bytes hold superblock, groups and headers of data sets, which carry checksums. The heap of texts (GCOL)
  // carries none: there the library trusts what it finds.
  std::string bytes(3000, '\0');
  std::ifstream(path, std::ios::binary).read(bytes.data(), 3000);
  const auto heap = static_cast<std::streamoff>(std::min<std::size_t>(bytes.find("GCOL"), 3000));
  int refused = 0;
  for (std::streamoff at = 0; at < heap; at += 13) {
    std::filesystem::copy_file(path, damaged, std::filesystem::copy_options::overwrite_existing);
    {
      std::fstream stream(damaged, std::ios::in | std::ios::out | std::ios::binary);
      stream.seekg(at);
      const char byte = static_cast<char>(stream.get());
      stream.seekp(at);
      stream.put(static_cast<char>(byte ^ 0x55));
    }
    try {
      const ResultFile file(damaged);
      expect_rows(file, 20);
    } catch (const base::InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 20);
}

}  // namespace
}  // namespace muldi::results
