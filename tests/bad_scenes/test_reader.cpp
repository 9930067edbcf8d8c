// Scenes that must be refused, each with the whole of what the reader says about it:
//     # set: path=value                        an override, as with --set
//     # expect: 14:11: error: key.path: ...    a diagnostic, without the name of the file; in the order of the output
// A file with a line `# stage: build` is read without fault and refused later; it belongs to another program.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "scene/read_scene.hpp"
#include "support/figure.hpp"

namespace muldi::scene {
namespace {

namespace fs = std::filesystem;

const fs::path folder = fs::path(MULDI_SOURCE_DIR) / "tests" / "bad_scenes";

std::vector<std::string> lines_of(const fs::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

/// What follows `# key: ` in the lines of a file.
std::vector<std::string> comments(const std::vector<std::string>& lines, const std::string& key) {
  const std::string start = "# " + key + ": ";
  std::vector<std::string> found;
  for (const std::string& line : lines) {
    if (line.rfind(start, 0) == 0) found.push_back(line.substr(start.size()));
  }
  return found;
}

std::vector<std::string> scenes_of_the_reader() {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".yaml") continue;
    if (comments(lines_of(entry.path()), "stage").empty()) names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// The diagnostics of a file, without its name and folder.
std::vector<std::string> refusal(const fs::path& path, const std::vector<std::string>& overrides) {
  std::vector<std::string> lines;
  try {
    read_scene(path.string(), overrides);
  } catch (const base::InputError& error) {
    const std::string parent = path.parent_path().string() + "/";
    for (base::Diagnostic diagnostic : error.diagnostics()) {
      if (diagnostic.place.file == path.string()) diagnostic.place.file.clear();
      std::string line = to_string(diagnostic);
      for (std::size_t i = line.find(parent); i != std::string::npos; i = line.find(parent)) {
        line.erase(i, parent.size());
      }
      lines.push_back(line);
    }
  }
  return lines;
}

/// Lines of two lists that are not the same at the same place.
double n_different(const std::vector<std::string>& first, const std::vector<std::string>& second) {
  const std::size_t n = std::max(first.size(), second.size());
  std::size_t same = 0;
  for (std::size_t i = 0; i < std::min(first.size(), second.size()); ++i) same += first[i] == second[i] ? 1 : 0;
  return static_cast<double>(n - same);
}

/// A file of the test's own that is gone at the end.
class OwnFile {
 public:
  explicit OwnFile(const std::string& content) {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = fs::path(testing::TempDir()) / (std::string("bad_scene_") + test->name() + ".yaml");
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~OwnFile() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  OwnFile(const OwnFile&) = delete;
  OwnFile& operator=(const OwnFile&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

class BadScene : public testing::TestWithParam<std::string> {};

TEST_P(BadScene, SaysWhatItExpects) {
  const fs::path path = folder / (GetParam() + ".yaml");
  const std::vector<std::string> lines = lines_of(path);
  const std::vector<std::string> expected = comments(lines, "expect");
  ASSERT_FALSE(expected.empty()) << "the scene expects nothing";
  const std::vector<std::string> said = refusal(path, comments(lines, "set"));
  EXPECT_EQ(said, expected);
  test::record_figure("32", "a bad scene, lines of its refusal that are not as expected", n_different(said, expected),
                      0.0);
}

INSTANTIATE_TEST_SUITE_P(Reader, BadScene, testing::ValuesIn(scenes_of_the_reader()),
                         [](const auto& scene) { return scene.param; });

using Lines = std::vector<std::string>;

TEST(BadFile, EmptyIsRefused) {
  const OwnFile file("");
  EXPECT_EQ(refusal(file.path(), {}), Lines{"error: empty: a scene starts with 'muldi: 1'"});
}

TEST(BadFile, HundredMegabytesAreRefusedUnread) {
  const OwnFile file("muldi: 1\n");
  fs::resize_file(file.path(), 100'000'000);
  EXPECT_EQ(refusal(file.path(), {}), Lines{"error: cannot read: it has 100000000 bytes, at most 16777216 are read"});
}

TEST(BadFile, ZeroBytesAreNoText) {
  const OwnFile file(std::string("muldi: 1\nti\0tle: x\n", 19));
  EXPECT_EQ(refusal(file.path(), {}), Lines{"2:3: error: not a text file: it has a zero byte"});
}

TEST(BadFile, TooManyValuesAreRefused) {
  std::string text = "muldi: 1\ntitle: [";
  for (int i = 0; i < 1'000'001; ++i) text += "1,";
  const OwnFile file(text + "1]\n");
  // The map, two keys, a number and the list come first: item 999995 is one too many, two columns each from column 9
  // on.
  EXPECT_EQ(refusal(file.path(), {}), Lines{"2:1999999: error: title: more than 1000000 values"});
}

TEST(BadFile, MissingFileAndFolderAreRefused) {
  EXPECT_EQ(refusal(folder / "nowhere.yml", {}), Lines{"error: cannot read: No such file or directory"});
  EXPECT_EQ(refusal(folder / "tables", {}), Lines{"error: cannot read: it is a folder"});
}

}  // namespace
}  // namespace muldi::scene
