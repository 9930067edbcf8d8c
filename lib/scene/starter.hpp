#pragma once
/// Scenes to begin with, whose comments come from the description of the format.
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace muldi::scene {

/// A scene without comments beside its keys.
struct StarterText {
  std::string_view kind;
  std::string_view doc;  ///< one sentence
  std::string_view text;
};

/// All of them; the first is the usual one.
std::span<const StarterText> starter_texts();

/// The scene of this kind, each key with its meaning, unit and default beside it.
/// InputError if there is no such kind.
std::string starter(std::string_view kind);

/// YAML in blocks with the meaning of each key as a comment at the end of its line: once a key, not where a comment
/// stands already, nor inside braces and lists.
std::string with_meanings(std::string_view yaml);

}  // namespace muldi::scene
