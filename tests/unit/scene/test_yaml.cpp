#include "scene/yaml.hpp"

#include <gtest/gtest.h>

namespace muldi::scene {
namespace {

Node tree(const std::string& text) {
  std::vector<base::Diagnostic> diagnostics;
  std::optional<Node> root = parse_yaml(text, "f", 0, diagnostics);
  EXPECT_EQ(to_string(diagnostics), "");
  return root ? *root : Node();
}

std::string faults(const std::string& text) {
  std::vector<base::Diagnostic> diagnostics;
  parse_yaml(text, "f", 0, diagnostics);
  return to_string(diagnostics);
}

/// `line:column`, then the line of the anchor.
std::string place(const Node& node) {
  return std::to_string(node.mark.line) + ":" + std::to_string(node.mark.column) +
         (node.mark.anchor_line > 0 ? "@" + std::to_string(node.mark.anchor_line) : "");
}

TEST(Yaml, KnowsKindsAndPlaces) {
  const Node root = tree("a: 1\nb:\n  - x\n  - {c: ~}\n");
  EXPECT_EQ(root.find("a")->text, "1");
  EXPECT_EQ(place(*root.find("a")), "1:4");
  EXPECT_EQ(root.entries[1].mark.line, 2);
  const Node& list = *root.find("b");
  EXPECT_EQ(place(list.items[0]), "3:5");
  EXPECT_EQ(place(*list.items[1].find("c")), "4:9");
  EXPECT_TRUE(list.items[1].find("c")->is_null());
  EXPECT_EQ(root.find("c"), nullptr);
}

TEST(Yaml, TellsQuotedText) {
  const Node root = tree("a: 'null'\nb: null\nc: \"1\"\nd: 1\n");
  EXPECT_TRUE(root.find("a")->is_scalar());
  EXPECT_TRUE(root.find("a")->quoted);
  EXPECT_TRUE(root.find("b")->is_null());
  EXPECT_TRUE(root.find("c")->quoted);
  EXPECT_FALSE(root.find("d")->quoted);
}

TEST(Yaml, AliasesStandWhereTheyAreUsed) {
  const Node root = tree("a: &x\n  k: [1, 2]\nb: *x\n");
  const Node& b = *root.find("b");
  EXPECT_EQ(b.find("k")->items[1].text, "2");
  EXPECT_EQ(place(b), "3:4@1");
  EXPECT_EQ(place(b.find("k")->items[1]), "3:4@1");
  EXPECT_EQ(place(root.find("a")->find("k")->items[1]), "2:10");
}

TEST(Yaml, AnchorsMayBeRedefined) {
  const Node root = tree("a: &x 1\nb: *x\nc: &x 2\nd: *x\n");
  EXPECT_EQ(root.find("b")->text, "1");
  EXPECT_EQ(root.find("d")->text, "2");
  EXPECT_EQ(place(*root.find("d")), "4:4@3");
}

TEST(Yaml, MergesShallowAndOwnKeysWin) {
  const Node root = tree("a: &a {p: 1, q: {r: 2, s: 3}}\nb: {<<: *a, q: {r: 9}, t: 4}\n");
  const Node& b = *root.find("b");
  EXPECT_EQ(b.find("p")->text, "1");
  EXPECT_EQ(b.find("q")->find("r")->text, "9");
  EXPECT_EQ(b.find("q")->find("s"), nullptr);
  EXPECT_EQ(b.find("t")->text, "4");
  EXPECT_EQ(b.find("<<"), nullptr);
  EXPECT_EQ(place(*b.find("p")), "2:9@1");
}

TEST(Yaml, MergesListsWhereEarlierMapsWin) {
  const Node root = tree("a: &a {p: 1}\nb: &b {p: 2, q: 3}\nc: {<<: [*a, *b, {r: 5}]}\n");
  const Node& c = *root.find("c");
  EXPECT_EQ(c.find("p")->text, "1");
  EXPECT_EQ(c.find("q")->text, "3");
  EXPECT_EQ(c.find("r")->text, "5");
  EXPECT_EQ(c.entries.size(), 3u);
}

TEST(Yaml, MergesOfMergesCarryOn) {
  const Node root = tree("a: &a {p: 1}\nb: &b {<<: *a, q: 2}\nc: {<<: *b, r: 3}\n");
  EXPECT_EQ(root.find("c")->find("p")->text, "1");
  EXPECT_EQ(place(*root.find("c")->find("p")), "3:9@2");
}

TEST(Yaml, ReportsEveryDuplicateOnce) {
  EXPECT_EQ(faults("a: 1\nb: {x: 1, x: 2, x: 3}\na: 2\n"),
            "f:2:11: error: b.x: duplicate key, first at line 2; keep one\n"
            "f:2:17: error: b.x: duplicate key, first at line 2; keep one\n"
            "f:3:1: error: a: duplicate key, first at line 1; keep one");
}

TEST(Yaml, PathsOfFaultsCountListEntries) {
  EXPECT_EQ(faults("a:\n  - {b: [1, {c: 1, c: 2}]}\n"),
            "f:2:20: error: a[0].b[1].c: duplicate key, first at line 2; keep one");
}

TEST(Yaml, TabsAreAllowedInsideLines) { EXPECT_EQ(tree("a:\t1\t# text\n").find("a")->text, "1"); }

TEST(Yaml, WindowsLinesAreRead) { EXPECT_EQ(tree("a: 1\r\nb: 2\r\n").find("b")->text, "2"); }

TEST(Yaml, DeepNestingEndsBeforeTheStackDoes) {
  const std::string deep = std::string(10'000, '[') + std::string(10'000, ']');
  EXPECT_EQ(faults("a: " + deep), "f:1:67: error: nested deeper than 64 levels");  // the map is the first level
}

TEST(ToYaml, WritesWhatReadsBack) {
  const std::string text =
      "a: 1\n"
      "b:\n"
      "  c: {d: [1, 2, ~], e: \"x: y\"}\n"
      "  f: {}\n"
      "g: [{h: 1}, [2]]\n";
  EXPECT_EQ(to_yaml(tree(text)), text);
}

TEST(ToJson, EscapesText) {
  Node map = Node::map();
  map.with("a\"b", Node::scalar("x\n\\\x01", true)).with("n", Node::scalar("1.5")).with("z", Node());
  EXPECT_EQ(to_json(map), "{\n  \"a\\\"b\": \"x\\n\\\\\\u0001\",\n  \"n\": 1.5,\n  \"z\": null\n}\n");
}

}  // namespace
}  // namespace muldi::scene
