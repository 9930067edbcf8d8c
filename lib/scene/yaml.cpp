#include "scene/yaml.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <numeric>
#include <sstream>
#include <utility>

#include "base/text.hpp"

namespace muldi::scene {
namespace {

using base::Diagnostic;

/// Ends the parse; the diagnostic has been written.
struct Stop {};

std::size_t count(const Node& node) {
  std::size_t n = 1;
  for (const Node& item : node.items) n += count(item);
  for (const MapEntry& entry : node.entries) n += count(entry.value);
  return n;
}

void move_to(Node& node, const Mark& mark) {
  node.mark = mark;
  for (Node& item : node.items) move_to(item, mark);
  for (MapEntry& entry : node.entries) {
    entry.mark = mark;
    move_to(entry.value, mark);
  }
}

class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& file, int source, std::vector<Diagnostic>& diagnostics)
      : file_(file), source_(source), diagnostics_(diagnostics) {}

  bool has_root() const { return has_root_; }
  Node take_root() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (n_documents_++ > 0) stop(at(mark), "a second document starts here; a scene is one document");
  }
  void OnDocumentEnd() override {}
  void OnAnchor(const YAML::Mark& mark, const std::string&) override { anchor_line_ = mark.line + 1; }

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add(made(Node::Kind::null, mark), anchor); }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    check_tag(mark, tag);
    Node node = made(Node::Kind::scalar, mark);
    node.text = value;
    node.quoted = tag != "?";
    add(std::move(node), anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t id) override {
    const Anchor* anchor = id < anchors_.size() ? &anchors_[id] : nullptr;
    if (anchor == nullptr || !anchor->complete) stop(at(mark), "the alias stands inside its own anchor");
    n_nodes_ += anchor->n_nodes;
    if (n_nodes_ > most_nodes) {
      stop(at(mark), "aliases expand to more than " + std::to_string(most_nodes) + " values");
    }
    Node copy = anchor->node;
    Mark use = at(mark);
    use.anchor_line = anchor->line;
    move_to(copy, use);
    place(std::move(copy));
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    check_tag(mark, tag);
    open(made(Node::Kind::sequence, mark), anchor);
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    check_tag(mark, tag);
    open(made(Node::Kind::map, mark), anchor);
  }
  void OnMapEnd() override {
    check_duplicates(frames_.back().node);
    merge(frames_.back().node);
    close();
  }

 private:
  struct Anchor {
    Node node;
    std::size_t n_nodes = 0;
    int line = 0;
    bool complete = false;
  };
  /// A collection that is being read.
  struct Frame {
    Node node;
    YAML::anchor_t anchor = 0;
    MapEntry entry;
    bool has_key = false;
  };

  Mark at(const YAML::Mark& mark) const {
    return {.source = source_, .line = mark.line + 1, .column = mark.column + 1, .anchor_line = 0};
  }
  Node made(Node::Kind kind, const YAML::Mark& mark) {
    if (++n_nodes_ > most_nodes) stop(at(mark), "more than " + std::to_string(most_nodes) + " values");
    Node node;
    node.kind = kind;
    node.mark = at(mark);
    return node;
  }

  void error(const Mark& mark, std::string message, const std::string& key = {}) {
    diagnostics_.push_back({.place = {.file = file_, .line = mark.line, .column = mark.column},
                            .path = path(key),
                            .message = std::move(message)});
  }
  [[noreturn]] void stop(const Mark& mark, std::string message) {
    error(mark, std::move(message));
    throw Stop{};
  }
  /// Key path of the collection that is being read, then `key`.
  std::string path(const std::string& key) const {
    std::string text;
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      const Frame& frame = frames_[i];
      const bool last = i + 1 == frames_.size();
      if (frame.node.is_sequence()) {
        if (!last) text += "[" + std::to_string(frame.node.items.size()) + "]";
      } else if (!last || !key.empty()) {
        text += (text.empty() ? "" : ".") + (last ? key : frame.entry.key);
      }
    }
    return text;
  }

  void check_tag(const YAML::Mark& mark, const std::string& tag) {
    if (tag.size() > 1 && tag.rfind("tag:yaml.org,2002:", 0) != 0)
      stop(at(mark), "unknown tag " + base::in_quotes(tag));
  }

  void add(Node node, YAML::anchor_t anchor) {
    remember(anchor, node, anchor_line_);
    place(std::move(node));
  }
  void remember(YAML::anchor_t id, const Node& node, int line) {
    if (id == 0) return;
    if (id >= anchors_.size()) anchors_.resize(id + 1);
    anchors_[id] = {.node = node, .n_nodes = count(node), .line = line, .complete = true};
  }
  void open(Node node, YAML::anchor_t anchor) {
    if (frames_.size() >= deepest_nesting) {
      frames_.clear();  // the key path would fill the screen
      stop(node.mark, "nested deeper than " + std::to_string(deepest_nesting) + " levels");
    }
    if (anchor != 0) {
      if (anchor >= anchors_.size()) anchors_.resize(anchor + 1);
      anchors_[anchor].line = anchor_line_;
    }
    frames_.push_back({.node = std::move(node), .anchor = anchor, .entry = {}, .has_key = false});
  }
  void close() {
    Frame frame = std::move(frames_.back());
    frames_.pop_back();
    if (frame.anchor != 0) remember(frame.anchor, frame.node, anchors_[frame.anchor].line);
    place(std::move(frame.node));
  }
  /// Puts a complete node where it belongs.
  void place(Node node) {
    if (frames_.empty()) {
      root_ = std::move(node);
      has_root_ = true;
      return;
    }
    Frame& frame = frames_.back();
    if (frame.node.is_sequence()) {
      frame.node.items.push_back(std::move(node));
    } else if (!frame.has_key) {
      if (!node.is_scalar()) stop(node.mark, "a key must be a word, got " + shown(node));
      frame.entry.key = std::move(node.text);
      frame.entry.mark = node.mark;
      frame.has_key = true;
    } else {
      frame.entry.value = std::move(node);
      frame.node.entries.push_back(std::move(frame.entry));
      frame.entry = {};
      frame.has_key = false;
    }
  }

  /// Reports and removes all but the first of equal keys.
  void check_duplicates(Node& map) {
    std::vector<MapEntry>& entries = map.entries;
    std::vector<std::size_t> order(entries.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return entries[a].key < entries[b].key; });
    std::vector<std::size_t> repeated;
    std::size_t first = 0;
    for (std::size_t i = 1; i < order.size(); ++i) {
      if (entries[order[i]].key != entries[order[first]].key) {
        first = i;
        continue;
      }
      error(entries[order[i]].mark,
            "duplicate key, first at line " + std::to_string(entries[order[first]].mark.line) + "; keep one",
            entries[order[i]].key);
      repeated.push_back(order[i]);
    }
    std::sort(repeated.rbegin(), repeated.rend());
    for (const std::size_t i : repeated) entries.erase(entries.begin() + static_cast<std::ptrdiff_t>(i));
  }

  /// Replaces `<<` by the entries of its maps that the map has not.
  void merge(Node& map) {
    const auto found =
        std::find_if(map.entries.begin(), map.entries.end(), [](const MapEntry& e) { return e.key == "<<"; });
    if (found == map.entries.end()) return;
    const MapEntry merged = std::move(*found);
    map.entries.erase(found);
    if (merged.value.is_sequence()) {
      for (const Node& part : merged.value.items) merge_from(map, part);
    } else {
      merge_from(map, merged.value);
    }
  }
  void merge_from(Node& map, const Node& part) {
    if (!part.is_map()) {
      error(part.mark, "needs a map or a list of maps, got " + shown(part), "<<");
      return;
    }
    for (const MapEntry& entry : part.entries) {
      if (map.find(entry.key) == nullptr) map.entries.push_back(entry);
    }
  }

  const std::string& file_;
  const int source_;
  std::vector<Diagnostic>& diagnostics_;
  std::vector<Frame> frames_;
  std::vector<Anchor> anchors_;
  std::size_t n_nodes_ = 0;
  int n_documents_ = 0;
  int anchor_line_ = 0;
  bool has_root_ = false;
  Node root_;
};

/// The first tab in the white space at the start of a line, as offset; npos if there is none.
std::size_t find_tab_indent(std::string_view text) {
  bool at_start = true;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\t' && at_start) return i;
    if (text[i] == '\n') {
      at_start = true;
    } else if (text[i] != ' ' && text[i] != '\r') {
      at_start = false;
    }
  }
  return text.npos;
}

base::Place place_of(std::string_view text, std::size_t offset, const std::string& file) {
  const std::string_view before = text.substr(0, offset);
  const std::size_t line_start = before.rfind('\n') + 1;  // npos + 1 is 0
  return {.file = file,
          .line = static_cast<int>(std::count(before.begin(), before.end(), '\n')) + 1,
          .column = static_cast<int>(offset - line_start) + 1};
}

}  // namespace

std::string too_large(std::size_t bytes) {
  return "it has " + std::to_string(bytes) + " bytes, at most " + std::to_string(largest_input) + " are read";
}

std::optional<Node> parse_yaml(std::string_view text, const std::string& file, int source,
                               std::vector<base::Diagnostic>& diagnostics) {
  const auto refuse = [&](base::Place place, std::string message) {
    diagnostics.push_back({.place = std::move(place), .message = std::move(message)});
    return std::nullopt;
  };
  if (text.size() > largest_input) {
    return refuse({.file = file, .line = 0, .column = 0}, "cannot read: " + too_large(text.size()));
  }
  const std::size_t nul = text.find('\0');
  if (nul != text.npos) return refuse(place_of(text, nul, file), "not a text file: it has a zero byte");
  const std::size_t tab = find_tab_indent(text);
  if (tab != text.npos) return refuse(place_of(text, tab, file), "tab character in the indentation; use spaces");

  TreeBuilder builder(file, source, diagnostics);
  try {
    std::istringstream stream{std::string(text)};
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::Exception& failure) {
    const bool located = !failure.mark.is_null();
    return refuse(
        {.file = file, .line = located ? failure.mark.line + 1 : 0, .column = located ? failure.mark.column + 1 : 0},
        "not valid YAML: " + failure.msg);
  } catch (const Stop&) {
    return {};
  }
  if (!builder.has_root())
    return refuse({.file = file, .line = 0, .column = 0}, "empty: a scene starts with 'muldi: 1'");
  return builder.take_root();
}

}  // namespace muldi::scene
