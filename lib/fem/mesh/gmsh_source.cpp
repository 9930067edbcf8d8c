#include "fem/mesh/gmsh_source.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "base/error.hpp"
#include "base/text.hpp"

namespace muldi::fem {
namespace {

constexpr std::string_view white = " \t\r\n";

}  // namespace

void GmshSource::fail(const std::string& message) const {
  base::Diagnostic diagnostic{.place = {.file = name_}, .message = message};
  if (binary_) {
    diagnostic.message += " (at byte " + std::to_string(start_) + ")";
  } else {
    const std::size_t end = std::min(start_, content_.size());
    diagnostic.place.line = 1 + static_cast<int>(std::count(content_.begin(), content_.begin() + end, '\n'));
  }
  throw base::InputError({diagnostic});
}

void GmshSource::fail_file(const std::string& message) const {
  throw base::InputError({base::Diagnostic{.place = {.file = name_}, .message = message}});
}

std::string_view GmshSource::word() {
  start_ = std::min(content_.find_first_not_of(white, at_), content_.size());
  at_ = std::min(content_.find_first_of(white, start_), content_.size());
  return content_.substr(start_, at_ - start_);
}

std::string_view GmshSource::needed_word() {
  const std::string_view next = word();
  if (next.empty()) fail_file("ends within $" + section_);
  return next;
}

std::string_view GmshSource::line() {
  start_ = at_;
  const std::size_t end = std::min(content_.find('\n', at_), content_.size());
  at_ = std::min(end + 1, content_.size());
  return base::trimmed(content_.substr(start_, end - start_));
}

bool GmshSource::skip_past(std::string_view marker) {
  const std::size_t found = content_.find(marker, at_);
  if (found == content_.npos) return false;
  at_ = found + marker.size();
  return true;
}

void GmshSource::expect_end() {
  const std::string_view next = needed_word();
  if (next != "$End" + section_) fail("needs $End" + section_ + ", got " + base::in_quotes(next));
}

long GmshSource::text_integer() {
  const std::string_view next = needed_word();
  const std::optional<double> number = base::parse_number(next);
  if (!number || *number != std::floor(*number) || std::abs(*number) > 9e15) {
    fail("$" + section_ + " needs a whole number, got " + base::in_quotes(next));
  }
  return static_cast<long>(*number);
}

double GmshSource::text_real() {
  const std::string_view next = needed_word();
  const std::optional<double> number = base::parse_number(next);
  if (!number || !std::isfinite(*number)) fail("$" + section_ + " needs a number, got " + base::in_quotes(next));
  return *number;
}

template <class T>
T GmshSource::raw() {
  start_ = at_;
  if (content_.size() - at_ < sizeof(T)) fail_file("ends within $" + section_);
  std::array<char, sizeof(T)> bytes{};
  std::memcpy(bytes.data(), content_.data() + at_, sizeof(T));
  at_ += sizeof(T);
  if (swapped_) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

long GmshSource::integer() { return binary_ ? static_cast<long>(raw<std::int32_t>()) : text_integer(); }

long GmshSource::size() {
  if (!binary_) return text_integer();
  const auto value = raw<std::uint64_t>();
  if (value > static_cast<std::uint64_t>(std::numeric_limits<long>::max())) fail("$" + section_ + " has no valid size");
  return static_cast<long>(value);
}

double GmshSource::real() {
  if (!binary_) return text_real();
  const double value = raw<double>();
  if (!std::isfinite(value)) fail("$" + section_ + " has a number that is not finite");
  return value;
}

long GmshSource::count_of(long n, std::string_view what, std::size_t bytes) {
  if (n < 0) fail("$" + section_ + " has a negative number of " + std::string(what));
  if (static_cast<std::size_t>(n) > (content_.size() - at_) / bytes) {
    fail("$" + section_ + " announces " + std::to_string(n) + " " + std::string(what) + ", more than the file holds");
  }
  return n;
}

}  // namespace muldi::fem
