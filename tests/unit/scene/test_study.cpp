/// Study files: what the reader says, and scenes edited by studies.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "scene/read_scene.hpp"
#include "scene/study.hpp"

namespace muldi::scene {
namespace {

const std::string joint = MULDI_SOURCE_DIR "/scenes/revolute_joint_lumped.yaml";

/// A file of this text in a folder of its own.
class TextFile {
 public:
  explicit TextFile(const std::string& text) : path_("study" + std::to_string(::getpid()) + ".yaml") {
    std::ofstream(path_) << text;
  }
  ~TextFile() { std::filesystem::remove(path_); }
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// All that the reader says, the file's name left out.
template <class Read>
std::string mistakes_in(const Read& read, const std::string& text) {
  const TextFile file(text);
  try {
    static_cast<void>(read(file.path()));
  } catch (const base::InputError& error) {
    std::string all = error.what();
    for (std::size_t at = all.find(file.path()); at != std::string::npos; at = all.find(file.path(), at)) {
      all.replace(at, file.path().size(), "f");
    }
    return all;
  }
  return {};
}

TEST(SweepStudy, ReportsAllMistakesAtOnceWithPlaceAndCure) {
  const std::string errors = mistakes_in(read_sweep_study,
                                         "sweep: 1\n"
                                         "scene: joint.yaml\n"
                                         "desing: grid\n"
                                         "vary:\n"
                                         "  a.b: {linspce: [0, 1, 3]}\n"
                                         "  a.c: {linspace: [0, 1]}\n"
                                         "  a.d: []\n"
                                         "  a.e: {min: 0, max: 1}\n"
                                         "outputs: {x y: time}\n");
  EXPECT_EQ(
      errors,
      "f:3:1: error: desing: unknown key (did you mean 'design'?)\n"
      "f:5:8: error: vary.a.b: needs a map with one of values, linspace, logspace, got a map with "
      "'linspce' (did you mean 'linspace'?)\n"
      "f:6:19: error: vary.a.c.linspace: needs [first, last, number], got a list of 2\n"
      "f:7:8: error: vary.a.d: needs a list of values, got a list of 0\n"
      "f:8:3: error: vary.a.e: {min, max} belongs to design: lhs; give values, linspace or logspace\n"
      "f:9:11: error: outputs.x y: the name 'x y' must be letters, digits, '_' and '-' and start with a letter or '_'");
}

TEST(SweepStudy, AsksForWhatADesignNeeds) {
  EXPECT_EQ(mistakes_in(read_sweep_study,
                        "sweep: 1\nscene: s.yaml\ndesign: lhs\nvary: {a.b: [1, 2]}\noutputs: {x: \"time[-1]\"}\n"),
            "f:1:1: error: missing key 'samples' (of design: lhs)\n"
            "f:4:8: error: vary.a.b: needs {min, max}, as every key of design: lhs");
  EXPECT_EQ(
      mistakes_in(read_sweep_study,
                  "sweep: 1\nscene: s.yaml\ndesign: list\nvary: {a.b: [1, 2], a.c: [1, 2, 3]}\noutputs: {x: t}\n"),
      "f:4:21: error: vary.a.c: has 3 values, the keys before 2: design: list needs as many of each");
}

TEST(SweepStudy, IsNoScene) {
  EXPECT_EQ(mistakes_in(read_sweep_study, "muldi: 1\n"),
            "f:1:1: error: needs a map that starts with 'sweep: 1', got a map");
}

TEST(CalibrateStudy, AsksForTheColumnOfATable) {
  EXPECT_EQ(mistakes_in(read_calibrate_study,
                        "calibrate: 1\nscene: s.yaml\nreference: d.csv\n"
                        "fit: {a.b: {min: 1}}\n"
                        "compare:\n  joints.j.coordinate: {unit: parsecs, wieght: 1}\n"),
            "f:4:12: error: fit.a.b: missing key 'max'\n"
            "f:6:3: error: compare.joints.j.coordinate: missing key 'column': the reference is a CSV file\n"
            "f:6:3: error: compare.joints.j.coordinate: no unit 'parsecs'\n"
            "f:6:40: error: compare.joints.j.coordinate.wieght: unknown key (did you mean 'weight'?)");
}

TEST(SceneText, ExpandsStarsAndRefusesNamesThatTheSceneDoesNotHave) {
  const SceneText text(joint, {});
  std::vector<base::Diagnostic> errors;
  const std::vector<std::string> both{"muscles.upper.rest_length", "muscles.lower.rest_length"};
  EXPECT_EQ(text.keys("muscles.*.rest_length", {}, errors), both);
  EXPECT_TRUE(errors.empty());
  text.keys("controls.agonst.field", {}, errors);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].message, "the scene has no control 'agonst' (did you mean 'agonist'?)");
}

TEST(SceneText, KeepsCommentsWhereEntriesAreReplaced) {
  const SceneText text(joint, {});
  const std::vector<std::string> overrides{"materials.silicone.electric.relative_permittivity=3.25",
                                           "muscles.upper.section.diameter=10.5",
                                           "muscles.lower.section.diameter=10.5"};
  const std::string edited = text.replaced(overrides, "# fitted\n");
  EXPECT_EQ(edited.find("# fitted\n"), edited.find('\n') + 1);  // after the modeline
  EXPECT_NE(edited.find("# Revolute joint with two antagonistic lumped muscles"), std::string::npos);
  EXPECT_NE(edited.find("relative_permittivity: 3.25}"), std::string::npos);
  EXPECT_NE(edited.find("upper: &muscle"), std::string::npos);
  EXPECT_EQ(read_scene_text(edited, joint), text.read(overrides));
}

TEST(SceneText, WritesTheTreeWhereAKeyStandsInNoLine) {
  const SceneText text(joint, {});
  const std::vector<std::string> overrides{"muscles.upper.section.diameter=10.5"};  // of the two that share a line
  const std::string edited = text.replaced(overrides, "");
  EXPECT_EQ(edited.find('&'), std::string::npos);
  EXPECT_EQ(read_scene_text(edited, joint), text.read(overrides));
}

TEST(SceneText, GivesNumbersInTheUnitsOfTheScene) {
  const Scene scene = SceneText(joint, {}).read({"controls.agonist.field=20 kV/mm"});
  EXPECT_EQ(number_at(scene, "controls.agonist.field"), 20000.0);
  EXPECT_EQ(number_at(scene, "joints.hinge.axis[2]"), 1.0);
  EXPECT_FALSE(number_at(scene, "muscles.upper.model"));
}

}  // namespace
}  // namespace muldi::scene
