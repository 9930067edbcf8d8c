#include "base/text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

namespace muldi::base {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

}  // namespace

std::string number_text(double value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  return {buffer.data(), end};
}

std::string number_text(double value, int digits) { return fmt::format("{:.{}g}", value, digits); }

std::string in_quotes(std::string_view word) {
  const std::size_t longest = 60;
  std::string text(word);
  if (text.size() > longest) text = text.substr(0, longest / 2) + "..." + text.substr(text.size() - longest / 3);
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  return "'" + text + "'";
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<double> take_number(std::string_view& text) {
  std::string_view rest = text;
  if (!rest.empty() && rest.front() == '+') {
    rest.remove_prefix(1);
    if (!rest.empty() && (rest.front() == '-' || rest.front() == '+')) return {};
  }
  double value = 0.0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (error == std::errc::invalid_argument) return {};
  if (error == std::errc::result_out_of_range) {
    // Both ends of the range report the same error; only an exponent below zero underflows.
    const std::string_view taken(rest.data(), static_cast<std::size_t>(end - rest.data()));
    const bool tiny = taken.find("e-") != taken.npos || taken.find("E-") != taken.npos;
    value = tiny ? 0.0 : std::numeric_limits<double>::infinity();
    if (rest.front() == '-') value = -value;
  }
  text = rest.substr(static_cast<std::size_t>(end - rest.data()));
  return value;
}

std::optional<double> parse_number(std::string_view text) {
  std::string_view rest = trimmed(text);
  const std::string_view digits =
      (!rest.empty() && (rest.front() == '-' || rest.front() == '+')) ? rest.substr(1) : rest;
  if (digits == ".inf" || digits == ".Inf" || digits == ".INF") {
    return rest.front() == '-' ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
  }
  if (rest == ".nan" || rest == ".NaN" || rest == ".NAN") return std::numeric_limits<double>::quiet_NaN();
  const std::optional<double> value = take_number(rest);
  return rest.empty() ? value : std::nullopt;
}

}  // namespace muldi::base
