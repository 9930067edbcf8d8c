#include "scene/csv.hpp"

#include <cmath>

#include "base/text.hpp"

namespace muldi::scene {
namespace {

/// Takes the next cell from the line; false if there is none.
bool take_cell(std::string_view& line, std::string_view& cell) {
  line = base::trimmed(line);
  if (line.empty()) return false;
  const std::size_t end = line.find_first_of(",; \t");
  cell = base::trimmed(line.substr(0, end));
  line.remove_prefix(end == line.npos ? line.size() : end);
  line = base::trimmed(line);
  if (!line.empty() && (line.front() == ',' || line.front() == ';')) line.remove_prefix(1);
  return true;
}

}  // namespace

CsvColumns read_csv(std::string_view text, int column) {
  CsvColumns columns;
  bool heading_allowed = true;
  int line_number = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = base::trimmed(text.substr(0, end));
    text.remove_prefix(end == text.npos ? text.size() : end + 1);
    ++line_number;
    if (line.empty() || line.front() == '#') continue;
    double numbers[2] = {0.0, 0.0};
    std::string_view cell;
    for (int c = 1; c <= column && columns.error.empty(); ++c) {
      if (!take_cell(line, cell)) {
        columns.error = "has no column " + std::to_string(column);
      } else if (c == 1 || c == column) {
        const auto number = base::parse_number(cell);
        if (number && std::isfinite(*number)) {
          numbers[c == 1 ? 0 : 1] = *number;
        } else {
          columns.error = "needs a finite number in column " + std::to_string(c) + ", got " + base::in_quotes(cell);
        }
      }
    }
    const bool heading = heading_allowed && !columns.error.empty();
    heading_allowed = false;
    if (heading) {
      columns.error.clear();
      continue;
    }
    if (!columns.error.empty()) {
      columns.error_line = line_number;
      return columns;
    }
    columns.first.push_back(numbers[0]);
    columns.other.push_back(numbers[1]);
    columns.lines.push_back(line_number);
  }
  return columns;
}

}  // namespace muldi::scene
