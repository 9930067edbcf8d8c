#pragma once
/// One located message about the input, as the user sees it.
#include <string>
#include <string_view>
#include <vector>

namespace muldi::base {

/// A place in a text file; line and column count from 1, 0 means "no place".
struct Place {
  std::string file = {};
  int line = 0;
  int column = 0;

  friend bool operator==(const Place&, const Place&) = default;
};

enum class Severity { note, warning, error };

/// `file:line:column: error: key.path: message`.
struct Diagnostic {
  Place place = {};
  Severity severity = Severity::error;
  std::string path = {};     ///< key path in the scene, e.g. `muscles.upper.to.body`; may be empty
  std::string message = {};  ///< what is wrong, what was got, how to mend it

  friend bool operator==(const Diagnostic&, const Diagnostic&) = default;
};

/// `file:line:column`; parts without content are left out.
std::string to_string(const Place& place);

/// The line that is printed; parts without content are left out.
std::string to_string(const Diagnostic& diagnostic);

/// All lines, one diagnostic each.
std::string to_string(const std::vector<Diagnostic>& diagnostics);

/// The candidate nearest to `word` in edit distance, or empty if none is near (" (did you mean 'x'?)" is the caller's).
std::string_view nearest(std::string_view word, const std::vector<std::string>& candidates);

/// The end of a message about an unknown word: " (did you mean 'x'?)", or " (known: a, b)" when none is near and the
/// list is short, or nothing.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace muldi::base
