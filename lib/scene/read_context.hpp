#pragma once
/// What all parts of the reader share: where it is, what it has found.
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/diagnostic.hpp"
#include "base/units.hpp"
#include "scene/entries.hpp"
#include "scene/node.hpp"

namespace muldi::scene {

struct Scene;

/// A reference that was read, to be looked up when all sections are known.
struct PendingReference {
  Family family = Family::body;
  std::string name = {};
  Origin origin = {};
};

class ReadContext {
 public:
  /// `sources[0]` is the scene file, the others stand for the overrides.
  ReadContext(std::vector<std::string> sources, Scene& scene) : sources_(std::move(sources)), scene_(scene) {}

  /// The scene as read so far; units come first, joints before the initial state, controls before statics.
  const Scene& scene() const { return scene_; }
  const base::UnitSystem& units() const;

  /// An error at a node and the current key path.
  void error(const Mark& mark, std::string message);
  /// An error at a place in another file, and the current key path.
  void error_elsewhere(base::Place place, std::string message);
  /// Where an entry stands, at the current key path.
  Origin origin(const Mark& mark) const;
  base::Place place(const Mark& mark) const;

  const std::string& path() const { return path_; }
  /// Whether something under the key path has been reported already.
  bool failed(std::string_view path) const;

  void add(base::Diagnostic diagnostic) { diagnostics_.push_back(std::move(diagnostic)); }
  std::vector<base::Diagnostic>& diagnostics() { return diagnostics_; }
  std::vector<PendingReference>& references() { return references_; }

  /// Extends the key path as long as it lives.
  class Scope {
   public:
    Scope(ReadContext& context, std::string_view key);
    Scope(ReadContext& context, std::size_t index);
    ~Scope() { context_.path_.resize(length_); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    ReadContext& context_;
    std::size_t length_;
  };

 private:
  std::vector<std::string> sources_;
  Scene& scene_;
  std::string path_;
  std::vector<base::Diagnostic> diagnostics_;
  std::vector<PendingReference> references_;
};

/// The message with "(anchor at line n)" where the node came through an alias.
std::string with_anchor(std::string message, int anchor_line);

}  // namespace muldi::scene
