#include "pipeline/field_rows.hpp"

#include <algorithm>

namespace muldi::pipeline {

FieldRows::FieldRows(results::Recorder& recorder, const build::BuiltModel& built, const base::UnitSystem& units,
                     const FieldAxis& axis, std::size_t expected_records)
    : recorder_(recorder) {
  for (const model::FieldHistory& history : built.model->histories) declare(history, units, axis, expected_records);
}

void FieldRows::declare(const model::FieldHistory& history, const base::UnitSystem& units, const FieldAxis& axis,
                        std::size_t expected_records) {
  const bool at_rest = !axis.prefix.empty();
  const auto skipped = [&](const model::FieldHistory::Field& field) { return at_rest && field.observable.of_motion; };
  if (std::all_of(history.fields.begin(), history.fields.end(), skipped)) return;
  const std::string folder = axis.prefix + history.folder + "/";
  recorder_.declare_fixed({.path = folder + "reference",
                           .shape = {history.reference.size() / 3, 3},
                           .unit = units.unit_name(base::dimension::length),
                           .doc = "positions of the nodes in the scene pose"},
                          std::span<const double>(history.reference));
  recorder_.declare_fixed(
      {.path = folder + "cells", .shape = {history.cells.size() / 8, 8}, .unit = "1", .doc = "nodes of the hexahedra"},
      std::span<const std::int64_t>(history.cells));
  History& made = histories_.emplace_back();
  made.every = history.every;
  made.series =
      recorder_.declare_series({.axis = folder + axis.name,
                                .unit = axis.unit,
                                .doc = axis.doc,
                                .expected_rows = expected_records / static_cast<std::size_t>(history.every) + 2});
  for (const model::FieldHistory::Field& field : history.fields) {
    if (skipped(field)) continue;
    const model::Observable& observable = field.observable;
    const std::string path = axis.prefix + observable.path;
    made.fields.emplace_back(&observable,
                             recorder_.declare_channel(made.series, {.path = path,
                                                                     .shape = observable.shape,
                                                                     .unit = units.unit_name(observable.unit),
                                                                     .doc = observable.doc}));
    recorder_.set_attribute(path, "located", std::string(field.at_nodes ? "at the nodes" : "in the cells"));
    row_.resize(std::max(row_.size(), observable.size()));
  }
}

void FieldRows::write(const model::NodeView& view, double axis_value, long record, bool last) {
  for (const History& history : histories_) {
    if (record % history.every != 0 && !last) continue;
    for (const auto& [observable, channel] : history.fields) {
      const std::span<double> out(row_.data(), observable->size());
      observable->evaluate(view, out);
      recorder_.append(channel, std::span<const double>(out));
    }
    recorder_.append(history.series.axis, axis_value);
  }
}

}  // namespace muldi::pipeline
