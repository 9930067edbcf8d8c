#include "pipeline/study/sweep_table.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/build_info.hpp"
#include "base/error.hpp"
#include "base/text.hpp"
#include "results/hdf5_recorder.hpp"

namespace muldi::pipeline {
namespace {

namespace fs = std::filesystem;

/// A name beside the file that no other process takes.
std::string temporary(const std::string& path) { return base::format("{}.{}.part", path, ::getpid()); }

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + "\"";
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() || unit == "1" ? name : base::format("{} [{}]", name, unit);
}

void write_csv(const SweepTable& table, const std::string& path) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  std::vector<std::string> heading{"point"};
  for (std::size_t k = 0; k < table.plan.keys.size(); ++k) {
    heading.push_back(quoted(with_unit(table.plan.keys[k], table.plan.units[k])));
  }
  for (std::size_t k = 0; k < table.names.size(); ++k) {
    heading.push_back(quoted(with_unit(table.names[k], table.units[k])));
  }
  heading.emplace_back("status");
  out << base::joined(heading, ",") << "\n";
  for (const FinishedPoint& row : table.rows) {
    const DesignPoint& point = table.plan.points[row.point];
    out << row.point;
    for (std::size_t k = 0; k < point.texts.size(); ++k) {
      out << "," << (std::isnan(point.numbers[k]) ? quoted(point.texts[k]) : base::number_text(point.numbers[k]));
    }
    for (const double value : row.outputs) out << "," << base::number_text(value);
    out << "," << row.status << "\n";
  }
  out.flush();
  if (!out) throw base::EnvironmentError("cannot write '" + path + "'");
}

/// The words of a column in the order of their first use.
std::vector<std::string> words_of(const std::vector<std::string>& column) {
  std::vector<std::string> words;
  for (const std::string& word : column) {
    if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
  }
  return words;
}

std::int64_t index_of(const std::vector<std::string>& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) - words.begin();
}

void write_hdf5(const SweepTable& table, const std::string& path) {
  results::Hdf5Recorder recorder({.path = path, .mode = results::Output::Mode::overwrite});
  recorder.set_attribute("", "format", "muldi-sim sweep");
  recorder.set_attribute("", "muldi_version", std::string(base::build_info().version));
  recorder.set_attribute("", "study", table.study);
  const results::Series points = recorder.declare_series(
      {.axis = "point", .unit = "1", .doc = "number in the design, from 0", .expected_rows = table.rows.size()});
  std::vector<results::Channel> keys;
  std::vector<std::vector<std::string>> key_words(table.plan.keys.size());
  for (std::size_t k = 0; k < table.plan.keys.size(); ++k) {
    const std::string name = "parameters/" + table.plan.keys[k];
    bool numeric = true;
    std::vector<std::string> column;
    for (const DesignPoint& point : table.plan.points) {
      numeric &= !std::isnan(point.numbers[k]);
      column.push_back(point.texts[k]);
    }
    if (!numeric) key_words[k] = words_of(column);
    const std::string& unit = table.plan.units[k];
    keys.push_back(recorder.declare_channel(
        points, {.path = name,
                 .unit = numeric && !unit.empty() ? unit : "1",
                 .doc = numeric ? "value of the key" : "number of the word in the attribute `words`"}));
    if (!numeric) recorder.set_attribute(name, "words", base::joined(key_words[k], "\n"));
  }
  std::vector<results::Channel> outputs;
  for (std::size_t k = 0; k < table.names.size(); ++k) {
    outputs.push_back(recorder.declare_channel(
        points, {.path = "outputs/" + table.names[k], .unit = table.units[k], .doc = "NaN where the point failed"}));
  }
  std::vector<std::string> column{"completed"};
  for (const FinishedPoint& row : table.rows) column.push_back(row.status);
  const std::vector<std::string> statuses = words_of(column);
  const results::Channel status =
      recorder.declare_channel(points, {.path = "status",
                                        .unit = "1",
                                        .doc = "number of the word in the attribute `words`",
                                        .type = results::ValueType::int64});
  recorder.set_attribute("status", "words", base::joined(statuses, "\n"));
  recorder.start();
  for (const FinishedPoint& row : table.rows) {
    const DesignPoint& point = table.plan.points[row.point];
    for (std::size_t k = 0; k < keys.size(); ++k) {
      const bool words = !key_words[k].empty();
      recorder.append(keys[k], words ? static_cast<double>(index_of(key_words[k], point.texts[k])) : point.numbers[k]);
    }
    for (std::size_t k = 0; k < outputs.size(); ++k) recorder.append(outputs[k], row.outputs[k]);
    recorder.append(status, index_of(statuses, row.status));
    recorder.append(points.axis, static_cast<double>(row.point));
  }
  const auto failed = static_cast<std::int64_t>(std::count_if(
      table.rows.begin(), table.rows.end(), [](const FinishedPoint& row) { return row.status != "completed"; }));
  recorder.set_attribute("", "failed_points", failed);
  recorder.close({.status = "completed", .where = {}, .time = 0.0});
}

void put_in_place(const std::string& from, const std::string& to) {
  std::error_code fault;
  fs::rename(from, to, fault);
  if (fault) throw base::EnvironmentError("cannot write '" + to + "': " + fault.message());
}

}  // namespace

std::vector<FinishedPoint> all_rows(const SweepPlan& plan, std::size_t n_outputs, std::vector<FinishedPoint> finished) {
  std::vector<FinishedPoint> rows(plan.points.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i] = {.point = i,
               .status = "missing",
               .outputs = std::vector<double>(n_outputs, std::numeric_limits<double>::quiet_NaN())};
  }
  for (FinishedPoint& point : finished) {
    if (point.point < rows.size()) rows[point.point] = std::move(point);
  }
  return rows;
}

void write_table(const SweepTable& table, const std::string& path) {
  const std::string csv = fs::path(path).replace_extension(".csv").string();
  write_csv(table, temporary(csv));
  write_hdf5(table, temporary(path));
  put_in_place(temporary(csv), csv);
  put_in_place(temporary(path), path);
}

}  // namespace muldi::pipeline
