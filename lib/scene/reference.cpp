#include "scene/reference.hpp"

#include <algorithm>
#include <string_view>

#include "base/text.hpp"
#include "scene/explain.hpp"
#include "scene/read_scene.hpp"

namespace muldi::scene {
namespace {

constexpr std::string_view head = R"(# Scene reference

Every key of a scene. Written by `muldi-sim schema --markdown` from the descriptions that the reader, the schema and
`muldi-sim explain` follow; a test compares. A `<name>` is free, `[]` stands for the items of a list. Units are those of bare
numbers in the default units (mm, g, ms, A); a quantity may carry its own, as `30 kV/mm`. *Needed*: `yes`, or with which word.
Where a key takes one of several words, they follow its table. Begin with a scene of `muldi-sim new`, not with this page.

)";

/// Text in a cell of a table, where a bar would end it and `<` begin a tag.
std::string cell(std::string_view text) {
  std::string escaped;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '|') escaped += '\\';
    if (c == '<' && i + 1 < text.size() && text[i + 1] != '=' && text[i + 1] != ' ') {
      escaped += "&lt;";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string first_key(const std::string& path) { return path.substr(0, path.find_first_of(".[")); }

/// `number, > 0, default 1`.
std::string kind_text(const KeyHelp& help) {
  std::string text = help.words.empty() ? help.kind : "word";
  if (!help.range.empty()) text += ", " + help.range;
  if (!help.standard.empty()) text += ", default " + help.standard;
  return text;
}

std::string row_of(const KeyHelp& help) {
  return base::format("| `{}` | {} | {} | {} | {} |\n", help.path, cell(help.doc), cell(kind_text(help)),
                      cell(help.unit), help.need == "no" ? "" : cell(help.need));
}

std::string words_of(const KeyHelp& help) {
  std::string text = base::format("\n`{}` is one of\n\n", help.path);
  for (const auto& [word, doc] : help.words) text += base::format("- `{}`{}\n", word, doc.empty() ? "" : ": " + doc);
  return text;
}

}  // namespace

std::string reference_text() {
  std::vector<std::string> sections;
  std::vector<std::string> said;
  std::string text(head);
  std::string words;
  for (const DocumentedField& field : documented_fields()) {
    if (std::find(said.begin(), said.end(), field.path) != said.end()) continue;
    said.push_back(field.path);
    // Definitions stand beside the scene; they are reached through the keys that use them.
    const std::optional<KeyHelp> help = field.path.starts_with("where") ? std::nullopt : find_key(field.path);
    if (!help) continue;
    const std::string section = first_key(field.path);
    if (sections.empty() || sections.back() != section) {
      text +=
          words + base::format("{}## {}\n\n| key | meaning | kind | unit | needed |\n| --- | --- | --- | --- | --- |\n",
                               sections.empty() ? "" : "\n", section);
      words.clear();
      sections.push_back(section);
    }
    text += row_of(*help);
    if (!help->words.empty()) words += words_of(*help);
  }
  return text + words;
}

}  // namespace muldi::scene
