#pragma once
/// Named entries of the sections of a scene, references between them, and where they were written.
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/diagnostic.hpp"

namespace muldi::scene {

/// Where an entry stands in the input, for messages of later stages. Beside the content: all origins are equal.
struct Origin {
  base::Place place = {};
  std::string path = {};  ///< key path, e.g. `muscles.upper.to.body`
  int anchor_line = 0;    ///< line of the anchor if the entry came through an alias or a merge key, else 0

  friend bool operator==(const Origin&, const Origin&) { return true; }
};

/// An error about what stands at `origin`.
base::Diagnostic error_at(const Origin& origin, std::string message);
/// A warning about what stands at `origin`.
base::Diagnostic warning_at(const Origin& origin, std::string message);

/// One entry `name: value` of a section.
template <class T>
struct Entry {
  std::string name = {};
  Origin origin = {};
  T value = {};

  friend bool operator==(const Entry&, const Entry&) = default;
};

/// A section `{name: value, ...}` in the order of the input; names are unique.
template <class T>
class Named {
 public:
  /// The entry of this name, or null.
  const Entry<T>* find(std::string_view name) const {
    for (const Entry<T>& entry : entries_) {
      if (entry.name == name) return &entry;
    }
    return nullptr;
  }
  /// The position of this name in the section, or -1.
  int index(std::string_view name) const {
    const Entry<T>* entry = find(name);
    return entry == nullptr ? -1 : static_cast<int>(entry - entries_.data());
  }
  /// All names in order.
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const Entry<T>& entry : entries_) all.push_back(entry.name);
    return all;
  }
  Entry<T>& add(Entry<T> entry) { return entries_.emplace_back(std::move(entry)); }

  bool empty() const { return entries_.empty(); }
  std::size_t size() const { return entries_.size(); }
  const Entry<T>& operator[](std::size_t i) const { return entries_[i]; }
  auto begin() const { return entries_.begin(); }
  auto end() const { return entries_.end(); }
  auto begin() { return entries_.begin(); }
  auto end() { return entries_.end(); }

  friend bool operator==(const Named&, const Named&) = default;

 private:
  std::vector<Entry<T>> entries_;
};

/// What a name in a scene refers to.
enum class Family { body, joint, control, material, solid };

/// The name of an entry of another section; the reader has made sure that it exists.
template <Family family>
struct Reference {
  std::string name = {};
  Origin origin = {};

  friend bool operator==(const Reference&, const Reference&) = default;
};
using BodyName = Reference<Family::body>;  ///< may be `ground`
using JointName = Reference<Family::joint>;
using ControlName = Reference<Family::control>;
using MaterialName = Reference<Family::material>;
using SolidName = Reference<Family::solid>;

/// The body that does not move; world axes.
inline constexpr std::string_view ground = "ground";

}  // namespace muldi::scene
