#include <gtest/gtest.h>

#include "base/error.hpp"
#include "scene/explain.hpp"
#include "scene/read_scene.hpp"
#include "scene/starter.hpp"

namespace muldi::scene {
namespace {

std::string refusal(const std::string& path) {
  try {
    look_up(path);
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Explain, TellsUnitRangeAndNeed) {
  EXPECT_EQ(explain("dynamics.step"),
            "dynamics.step\n"
            "  time step\n"
            "  kind     number\n"
            "  unit     ms for bare numbers; or text with its own unit\n"
            "  range    > 0\n"
            "  needed   yes\n");
}

TEST(Explain, TellsWordsWithTheirMeaningAndTheDefault) {
  EXPECT_EQ(explain("joints.*.frame"),
            "joints.<name>.frame\n"
            "  axes of the vectors of this joint\n"
            "  kind     one of scene, from, to\n"
            "  default  scene\n"
            "  needed   no\n"
            "words\n"
            "  scene  world axes in the scene pose\n"
            "  from   body axes of `from`\n"
            "  to     body axes of `to`\n");
}

TEST(Explain, TellsWhichWordOfANeighbourAsksForAKey) {
  EXPECT_EQ(look_up("muscles.upper.section.diameter").need, "with shape: round");
  EXPECT_EQ(look_up("joints.hinge.axis2").need, "with type: universal");
  EXPECT_EQ(look_up("joints.hinge.damping").need, "no");
}

TEST(Explain, TakesAnyNameStarOrBracketsForAnEntry) {
  const KeyHelp mass = look_up("bodies.pendulum.mass");
  EXPECT_EQ(mass.path, "bodies.<name>.mass");
  for (const char* path : {"bodies.*.mass", "bodies.<name>.mass"}) EXPECT_EQ(look_up(path).doc, mass.doc) << path;
  EXPECT_EQ(look_up("solids.cube.conditions[2].where").path, "solids.<name>.conditions[].where");
  EXPECT_EQ(look_up("solids.cube.conditions.where").path, "solids.<name>.conditions[].where");
}

TEST(Explain, KnowsEveryDocumentedField) {
  const std::vector<DocumentedField> rows = documented_fields();
  ASSERT_GT(rows.size(), 100u);
  for (const DocumentedField& row : rows) {
    // Definitions stand beside the scene; they are reached through the keys that use them.
    if (row.path.starts_with("where")) continue;
    const std::optional<KeyHelp> help = find_key(row.path);
    ASSERT_TRUE(help) << row.path;
    EXPECT_NE(help->doc.find(row.doc), std::string::npos) << row.path;
    EXPECT_NE(help->unit.find(row.unit), std::string::npos) << row.path;
  }
}

TEST(Explain, RefusesUnknownKeysWithTheNearestOne) {
  EXPECT_EQ(refusal("joints.hinge.typ"), "error: joints.<name>: no key 'typ' (did you mean 'type'?)");
  EXPECT_EQ(refusal("dynamic.step"), "error: scene: no key 'dynamic' (did you mean 'dynamics'?)");
  EXPECT_EQ(refusal("dynamics.step.size"), "error: dynamics.step: has no keys, got 'size'");
  EXPECT_EQ(refusal("title[2]"), "error: title: has no keys, got '[]'");
}

TEST(Starter, IsAValidSceneOfEveryKind) {
  for (const StarterText& each : starter_texts()) {
    const Scene scene = read_scene_text(starter(each.kind), std::string(each.kind));
    EXPECT_TRUE(scene.warnings.empty()) << each.kind;
    // Comments change nothing.
    EXPECT_EQ(resolved_text(scene), resolved_text(read_scene_text(each.text, std::string(each.kind)))) << each.kind;
  }
}

TEST(Starter, SaysTheMeaningOfEachKeyOnce) {
  EXPECT_EQ(with_meanings("dynamics:\n  duration: 1 s\n  step: 1 ms\n\n# mine\nrecord:\n  every: 5 # mine\n"),
            "dynamics:                                                  # motion to compute\n"
            "  duration: 1 s                                            # simulated time, a multiple of the step [ms]\n"
            "  step: 1 ms                                               # time step [ms]\n"
            "\n"
            "# mine\n"
            "record:                                                    # what is recorded\n"
            "  every: 5 # mine\n");
  const std::string joints = starter("trunk");
  const std::string meaning = "# joint type";
  EXPECT_EQ(joints.find(meaning), joints.rfind(meaning));
}

TEST(Starter, RefusesUnknownKinds) {
  try {
    starter("soild");
    ADD_FAILURE() << "no error";
  } catch (const base::InputError& error) {
    EXPECT_STREQ(
        error.what(),
        "error: no starter scene 'soild' (did you mean 'solid'?); known: joint, muscle, trunk, solid, optimal");
  }
}

}  // namespace
}  // namespace muldi::scene
