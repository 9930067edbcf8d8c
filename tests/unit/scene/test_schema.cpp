#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "scene/read_scene.hpp"
#include "scene/reference.hpp"
#include "scene/yaml.hpp"

namespace muldi::scene {
namespace {

/// The schema as a tree; JSON is YAML.
Node schema() {
  std::vector<base::Diagnostic> diagnostics;
  std::optional<Node> root = parse_yaml(schema_text(), "schema", 0, diagnostics);
  EXPECT_EQ(to_string(diagnostics), "");
  return root ? *root : Node();
}

const Node& at(const Node& node, std::initializer_list<std::string_view> keys) {
  const Node* found = &node;
  for (const std::string_view key : keys) {
    found = found->find(key);
    if (found == nullptr) throw std::runtime_error("no key " + std::string(key));
  }
  return *found;
}

TEST(Schema, FileIsFresh) {
  std::ifstream file(std::string(MULDI_SOURCE_DIR) + "/schemas/scene.schema.json");
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), schema_text()) << "write it anew: muldi-sim schema > schemas/scene.schema.json";
}

TEST(Reference, PageIsFresh) {
  std::ifstream file(std::string(MULDI_SOURCE_DIR) + "/schemas/SCENE.md");
  std::ostringstream text;
  text << file.rdbuf();
  EXPECT_EQ(text.str(), reference_text()) << "write it anew: muldi-sim schema --markdown > schemas/SCENE.md";
}

TEST(Reference, HasEveryKeyOnce) {
  const std::string text = reference_text();
  for (const DocumentedField& field : documented_fields()) {
    if (field.path.starts_with("where")) continue;
    const std::string row = "\n| `" + field.path + "` | ";
    const std::size_t first = text.find(row);
    ASSERT_NE(first, std::string::npos) << field.path;
    EXPECT_EQ(text.find(row, first + 1), std::string::npos) << field.path;
  }
  EXPECT_NE(
      text.find("| `materials.<name>.elastic.poisson` | Poisson's ratio; 0.5 is incompressible | number, > -1 and "
                "<= 0.5 |  |  |\n"),
      std::string::npos);
  EXPECT_NE(text.find("- `revolute`: one rotation about an axis; coordinate: angle\n"), std::string::npos);
}

TEST(Schema, DescribesFieldsWithUnitsRangesAndDefaults) {
  const Node root = schema();
  EXPECT_EQ(at(root, {"$schema"}).text, "http://json-schema.org/draft-07/schema#");
  const Node& mass = at(root, {"properties", "bodies", "additionalProperties", "properties", "mass"});
  EXPECT_EQ(at(mass, {"exclusiveMinimum"}).text, "0");
  EXPECT_EQ(at(mass, {"x-unit"}).text, "g");
  EXPECT_EQ(at(root, {"properties", "solver", "properties", "max_iterations", "default"}).text, "30");
  EXPECT_EQ(at(root, {"properties", "dynamics", "required"}).items.size(), 2u);
  EXPECT_EQ(at(root, {"additionalProperties"}).text, "false");
}

TEST(Schema, NamesEveryJointTypeAndWhatItNeeds) {
  const Node root = schema();
  const Node& joint = at(root, {"properties", "joints", "additionalProperties"});
  EXPECT_EQ(at(joint, {"properties", "type", "oneOf"}).items.size(), multibody::JointTypes::size);
  const Node& conditions = at(joint, {"allOf"});
  const auto needs = [&](const std::string& type) -> std::vector<std::string> {
    for (const Node& condition : conditions.items) {
      if (at(condition, {"if", "properties", "type", "const"}).text != type) continue;
      std::vector<std::string> keys;
      for (const Node& key : at(condition, {"then", "required"}).items) keys.push_back(key.text);
      return keys;
    }
    return {};
  };
  EXPECT_EQ(needs("universal"), (std::vector<std::string>{"axis", "axis2"}));
  EXPECT_EQ(needs("planar"), std::vector<std::string>{"normal"});
  EXPECT_TRUE(needs("free").empty());
}

TEST(Documentation, HasARowForEachField) {
  const std::vector<DocumentedField> rows = documented_fields();
  const auto row = [&](const std::string& path) {
    const auto found = std::find_if(rows.begin(), rows.end(), [&](const DocumentedField& r) { return r.path == path; });
    return found == rows.end() ? DocumentedField{} : *found;
  };
  const DocumentedField mass = row("bodies.<name>.mass");
  EXPECT_EQ(mass.kind, "number");
  EXPECT_EQ(mass.unit, "g");
  EXPECT_EQ(mass.range, "> 0");
  EXPECT_TRUE(mass.required);
  EXPECT_EQ(mass.doc, "mass");
  EXPECT_EQ(row("gravity").kind, "list of 3 x number");
  EXPECT_EQ(row("joints.<name>.frame").kind, "one of scene, from, to");
  EXPECT_EQ(row("controls.<name>.field").kind, "function of time");
  EXPECT_EQ(row("controls.<name>.field").unit, "V/mm");
  EXPECT_EQ(row("springs.<name>.from.body").kind, "name");
  EXPECT_FALSE(row("dynamics.integrator").required);
  for (const DocumentedField& each : rows) EXPECT_FALSE(each.doc.empty()) << each.path;
}

}  // namespace
}  // namespace muldi::scene
