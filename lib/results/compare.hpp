#pragma once
/// Comparison of two result files: physics, not run metadata.
#include <optional>
#include <string>
#include <vector>

namespace muldi::results {

/// What is compared, and how closely.
///
/// Two values agree if |a - b| <= atol + rtol * max|a|, the maximum taken over the data set of the first file; NaN
/// agrees with NaN only. A data set of the first file may carry its own attributes `rtol` and `atol`, which go before.
/// A pattern is a glob of `*` (any characters, slashes too) and `?` (one character); one that names a group stands for
/// all below it.
struct CompareOptions {
  double rtol = 1e-9;
  double atol = 1e-12;
  std::vector<std::string> only = {};    ///< if not empty, only what matches one of them
  std::vector<std::string> ignore = {};  ///< what matches one of them is left out
};

/// The worst difference of one data set.
struct Difference {
  enum class Kind { missing, status, shape, unit, value };
  Kind kind = Kind::value;
  std::string path = {};   ///< with its leading slash
  std::string first = {};  ///< what the first file has: shape, unit, status; empty for missing and value
  std::string second = {};
  std::vector<std::size_t> index = {};  ///< of the value that is furthest beyond its tolerance
  double time = 0.0;                    ///< value of the axis in that row; NaN if the data set has no axis
  double left = 0.0;                    ///< value in the first file
  double right = 0.0;                   ///< value in the second file
  double excess = 0.0;                  ///< |a - b| over its tolerance; infinite where no tolerance helps
  std::size_t count = 0;                ///< values beyond their tolerance
};

/// How the two motions leave each other, where that is exponential over many orders of magnitude: chaos.
struct Divergence {
  std::string path = {};      ///< the data set that shows it most clearly, with its leading slash
  std::string unit = {};      ///< of the time
  double rate = 0.0;          ///< of growth, in 1/unit
  double first_time = 0.0;    ///< first difference above round-off
  double visible_time = 0.0;  ///< where the difference passes a thousandth of the largest value
};

/// Result of a comparison: differences sorted, the worst first; all but values count as worst.
struct Comparison {
  std::string first_file = {};
  std::string second_file = {};
  std::vector<Difference> differences = {};
  std::optional<Divergence> divergence = {};
  std::size_t n_data_sets = 0;  ///< compared
  std::size_t n_values = 0;     ///< compared
  bool same() const { return differences.empty(); }
};

/// Compares two files. Run metadata, `solver` and `checkpoint` groups (unless `only` names them) are left out; status,
/// units, shapes, values and presence are compared. Throws InputError if a file cannot be read.
Comparison compare(const std::string& first, const std::string& second, const CompareOptions& options = {});

/// One sentence and, if there are differences, a table of at most `max_lines` of them; ends with a newline.
std::string to_text(const Comparison& comparison, std::size_t max_lines = 30);

}  // namespace muldi::results
