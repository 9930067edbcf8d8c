#pragma once
/// Rows of fields over meshes: a series for each solid whose fields are recorded, with a cadence of its own.
#include <string>
#include <vector>

#include "build/built_model.hpp"
#include "results/recorder.hpp"

namespace muldi::pipeline {

/// The axis of the fields' series.
struct FieldAxis {
  std::string prefix = {};  ///< of all paths: empty or "statics/"
  std::string name = {};    ///< of the axis below the folder of each solid
  std::string unit = {};
  std::string doc = {};
};

class FieldRows {
 public:
  /// Declares mesh and channels of all histories of the model. In statics (a prefix)
  /// those of motion are left out.
  FieldRows(results::Recorder& recorder, const build::BuiltModel& built, const base::UnitSystem& units,
            const FieldAxis& axis, std::size_t expected_records);

  /// Writes the histories whose turn it is: every `every`-th record of the run, and the last.
  void write(const model::NodeView& view, double axis_value, long record, bool last);

 private:
  struct History {
    int every = 1;
    results::Series series;
    std::vector<std::pair<const model::Observable*, results::Channel>> fields;
  };
  void declare(const model::FieldHistory& history, const base::UnitSystem& units, const FieldAxis& axis,
               std::size_t expected_records);

  results::Recorder& recorder_;
  std::vector<History> histories_;
  std::vector<double> row_;
};

}  // namespace muldi::pipeline
