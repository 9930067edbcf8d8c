#pragma once
/// Numbers taken from a result: `joints.hinge.coordinate[-1]`, `max(points.arm.tip[:, 1])`.
#include <string>
#include <vector>

#include "results/memory_recorder.hpp"

namespace muldi::pipeline {

/// What is made of the rows of a data set.
enum class Reduction { none, final, min, max, mean, largest };

/// A parsed expression: a data set (path with dots), which row, which component, which reduction.
///
/// The first index is the row: [0] the first, [-1] the last, [:] all of them (the default under a reduction, else the
/// last row must be asked for); further indices are components. `max`, `min`, `mean`, `final`, `largest` (in absolute
/// value) reduce the rows. A path without such a data set may be a number that the run left as an attribute, e.g.
/// `statics.critical_load_above`.
struct OutputExpression {
  std::string text = {};
  std::string path = {};  ///< with dots
  Reduction reduction = Reduction::none;
  bool all_rows = true;
  long row = 0;  ///< from the end where negative
  std::vector<long> component = {};
};

/// Parses; where it is none, `error` gets a sentence.
OutputExpression parse_output(const std::string& text, std::string& error);

/// Why the expression fits none of the data sets that were declared, with the nearest; empty if it fits. `unit` gets
/// that of the data set.
std::string why_no_output(const OutputExpression& output, const results::Layout& layout, std::string& unit);

/// Its value in a finished record; NaN where the row or the attribute is missing.
double value_of(const OutputExpression& output, const results::MemoryRecorder& record);

/// The declared channel that a path with dots names; null if there is none.
const results::DeclaredChannel* channel_of(const results::Layout& layout, const std::string& dotted);

}  // namespace muldi::pipeline
