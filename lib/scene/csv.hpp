#pragma once
/// Columns of numbers from CSV text.
#include <string>
#include <string_view>
#include <vector>

namespace muldi::scene {

/// Two columns of a table; `lines` are the line numbers of the rows.
struct CsvColumns {
  std::vector<double> first;
  std::vector<double> other;
  std::vector<int> lines;
  std::string error;   ///< empty if the text was read
  int error_line = 0;  ///< line of the error
};

/// Reads the first and the `column`-th (from 1) number of each line. Separators are commas, semicolons, tabs or blanks;
/// lines that start with '#' and empty lines are skipped, and one line of headings at the start.
CsvColumns read_csv(std::string_view text, int column);

}  // namespace muldi::scene
