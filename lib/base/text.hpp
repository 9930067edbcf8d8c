#pragma once
/// Text from values and values from text; the only file pair that includes fmt.
#include <fmt/core.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace muldi::base {

/// The text of a fmt format string (checked at compile time) with its arguments.
template <class... Arguments>
std::string format(fmt::format_string<Arguments...> pattern, Arguments&&... arguments) {
  return fmt::format(pattern, std::forward<Arguments>(arguments)...);
}

/// The shortest decimal text that reads back as the same number.
std::string number_text(double value);

/// `digits` significant digits, without trailing zeros.
std::string number_text(double value, int digits);

/// The word in single quotes as messages show what was got: shortened in the middle over 60 characters, control
/// characters as '?'.
std::string in_quotes(std::string_view word);

/// `a, b, c`.
template <class Words>
std::string joined(const Words& words, std::string_view separator = ", ") {
  std::string text;
  bool first = true;
  for (const auto& word : words) {
    if (!first) text += separator;
    text += word;
    first = false;
  }
  return text;
}

/// The text without white space at both ends.
std::string_view trimmed(std::string_view text);

/// The number that the whole text is (decimal, optional sign and exponent); empty if it is none. May be infinite or NaN
/// where the text says so; a number beyond the range of double is infinite.
std::optional<double> parse_number(std::string_view text);

/// Reads the number at the start of `text` and moves `text` behind it; empty if there is none.
std::optional<double> take_number(std::string_view& text);

}  // namespace muldi::base
