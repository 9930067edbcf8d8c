#include "scene/starter.hpp"

#include <algorithm>

#include "base/diagnostic.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "scene/explain.hpp"

namespace muldi::scene {
namespace {

constexpr std::size_t comment_column = 58;

struct OpenKey {
  std::size_t indent = 0;
  std::string path;
};

/// Meaning, unit, default of a key in one line.
std::string meaning_of(const KeyHelp& help) {
  std::string text = help.doc;
  if (!help.unit.empty()) text += base::format(" [{}]", help.unit);
  if (!help.standard.empty()) text += base::format("; default {}", help.standard);
  return text;
}

bool is_comment_or_empty(std::string_view line) {
  const std::string_view content = base::trimmed(line);
  return content.empty() || content.front() == '#';
}

class Annotator {
 public:
  std::string annotated(std::string_view line) {
    if (is_comment_or_empty(line) || line.find(" #") != line.npos) return std::string(line);
    const std::size_t indent = line.find_first_not_of(' ');
    const std::size_t colon = line.find(':');
    if (line[indent] == '-' || colon == line.npos) return std::string(line);
    while (!open_.empty() && open_.back().indent >= indent) open_.pop_back();
    const std::string key(line.substr(indent, colon - indent));
    const std::string path = open_.empty() ? key : open_.back().path + "." + key;
    open_.push_back({indent, path});
    const std::optional<KeyHelp> help = find_key(path);
    if (!help || help->doc.empty() || help->path.ends_with("<name>")) return std::string(line);
    if (std::find(said_.begin(), said_.end(), help->path) != said_.end()) return std::string(line);
    said_.push_back(help->path);
    return base::format("{:<{}} # {}", line, comment_column, meaning_of(*help));
  }

 private:
  std::vector<OpenKey> open_;
  std::vector<std::string> said_;
};

}  // namespace

std::string with_meanings(std::string_view yaml) {
  Annotator annotator;
  std::string text;
  while (!yaml.empty()) {
    const std::size_t end = std::min(yaml.find('\n'), yaml.size());
    text += annotator.annotated(yaml.substr(0, end)) + "\n";
    yaml.remove_prefix(std::min(end + 1, yaml.size()));
  }
  return text;
}

std::string starter(std::string_view kind) {
  std::vector<std::string> kinds;
  for (const StarterText& each : starter_texts()) {
    if (each.kind == kind) return with_meanings(each.text);
    kinds.emplace_back(each.kind);
  }
  throw base::InputError(base::format(
      "no starter scene {}{}; known: {}", base::in_quotes(kind),
      base::nearest(kind, kinds).empty() ? "" : base::format(" (did you mean '{}'?)", base::nearest(kind, kinds)),
      base::joined(kinds)));
}

}  // namespace muldi::scene
