#include "scene/read_context.hpp"

#include <algorithm>

#include "scene/scene.hpp"

namespace muldi::scene {

std::string with_anchor(std::string message, int anchor_line) {
  if (anchor_line > 0) message += " (anchor at line " + std::to_string(anchor_line) + ")";
  return message;
}

base::Diagnostic error_at(const Origin& origin, std::string message) {
  return {.place = origin.place,
          .severity = base::Severity::error,
          .path = origin.path,
          .message = with_anchor(std::move(message), origin.anchor_line)};
}

base::Diagnostic warning_at(const Origin& origin, std::string message) {
  base::Diagnostic diagnostic = error_at(origin, std::move(message));
  diagnostic.severity = base::Severity::warning;
  return diagnostic;
}

const base::UnitSystem& ReadContext::units() const { return scene_.units; }

void ReadContext::error(const Mark& mark, std::string message) { add(error_at(origin(mark), std::move(message))); }

void ReadContext::error_elsewhere(base::Place place, std::string message) {
  add({.place = std::move(place), .severity = base::Severity::error, .path = path_, .message = std::move(message)});
}

base::Place ReadContext::place(const Mark& mark) const {
  return {.file = sources_[static_cast<std::size_t>(mark.source)], .line = mark.line, .column = mark.column};
}

Origin ReadContext::origin(const Mark& mark) const {
  return {.place = place(mark), .path = path_, .anchor_line = mark.anchor_line};
}

bool ReadContext::failed(std::string_view path) const {
  return std::any_of(diagnostics_.begin(), diagnostics_.end(), [path](const base::Diagnostic& diagnostic) {
    const std::string_view other = diagnostic.path;
    if (other.substr(0, path.size()) != path) return false;
    return other.size() == path.size() || other[path.size()] == '.' || other[path.size()] == '[';
  });
}

ReadContext::Scope::Scope(ReadContext& context, std::string_view key)
    : context_(context), length_(context.path_.size()) {
  if (length_ > 0) context_.path_ += '.';
  context_.path_ += key;
}

ReadContext::Scope::Scope(ReadContext& context, std::size_t index) : context_(context), length_(context.path_.size()) {
  context_.path_ += "[" + std::to_string(index) + "]";
}

}  // namespace muldi::scene
