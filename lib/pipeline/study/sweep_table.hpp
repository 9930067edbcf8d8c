#pragma once
/// The table of a sweep: one row a point in the order of the design, as HDF5 and as CSV.
#include <string>
#include <vector>

#include "pipeline/study/design.hpp"
#include "pipeline/study/journal.hpp"

namespace muldi::pipeline {

/// What the table is made of.
struct SweepTable {
  const SweepPlan& plan;
  const std::vector<std::string>& names;  ///< of the outputs
  const std::vector<std::string>& units;  ///< of these
  std::vector<FinishedPoint> rows;        ///< one a point, in order; status `missing` where there is none
  std::string study;                      ///< file name of the study
};

/// The rows of all points, with NaN and `missing` for those that are not finished.
std::vector<FinishedPoint> all_rows(const SweepPlan& plan, std::size_t n_outputs, std::vector<FinishedPoint> finished);

/// Writes FILE.h5 and FILE.csv (`path` is the .h5), each by a rename, so that a reader sees the old or the new one.
/// EnvironmentError if they cannot be written.
void write_table(const SweepTable& table, const std::string& path);

}  // namespace muldi::pipeline
