#include "scene/field_reader.hpp"

#include <algorithm>

#include "base/text.hpp"
#include "scene/read_values.hpp"

namespace muldi::scene {
namespace {

bool contains(const std::vector<std::string>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

FieldReader::FieldReader(ReadContext& context, const Node& map)
    : context_(context), map_(map), taken_(map.entries.size(), false) {}

const Node* FieldReader::take(std::string_view key, bool required) {
  if (foreign_) {
    others_.emplace_back(key);
    return nullptr;
  }
  if (!contains(known_, key)) known_.emplace_back(key);
  for (std::size_t i = 0; i < map_.entries.size(); ++i) {
    if (map_.entries[i].key != key) continue;
    taken_[i] = true;
    return &map_.entries[i].value;
  }
  if (required && reading_) missing_.emplace_back(key);
  return nullptr;
}

void FieldReader::finish() {
  std::vector<std::string> candidates;  // keys that could have been meant: those that do not stand here already
  for (const std::string& key : known_) {
    if (map_.find(key) == nullptr) candidates.push_back(key);
  }
  for (std::size_t i = 0; i < map_.entries.size(); ++i) {
    if (taken_[i]) continue;
    const MapEntry& entry = map_.entries[i];
    const ReadContext::Scope scope(context_, entry.key);
    if (contains(others_, entry.key) && !contains(known_, entry.key)) {
      context_.error(entry.mark, "key does not belong to " + component_);
      continue;
    }
    const std::string meant(base::nearest(entry.key, candidates));
    context_.error(entry.mark, "unknown key" + base::did_you_mean(entry.key, meant.empty() ? known_ : candidates));
    // A misspelt key is one error, not two.
    missing_.erase(std::remove(missing_.begin(), missing_.end(), meant), missing_.end());
  }
  for (const std::string& key : missing_) context_.error(map_.mark, "missing key '" + key + "'");
}

}  // namespace muldi::scene
