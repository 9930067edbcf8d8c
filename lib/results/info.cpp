#include "results/info.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/text.hpp"
#include "results/live_file.hpp"
#include "results/result_file.hpp"

namespace muldi::results {
namespace {

constexpr std::size_t max_values_shown = 9;
constexpr int digits = 10;
constexpr std::string_view wall_time = "wall_time.";

std::string text_of(const AttributeValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  return base::number_text(std::get<double>(value), digits);
}

std::string list_text(const std::vector<double>& values) {
  std::string text;
  for (const double number : values) text += (text.empty() ? "" : ", ") + base::number_text(number, digits);
  return "[" + text + "]";
}

std::string size_text(std::uint64_t bytes) {
  if (bytes < 10'000) return base::format("{} bytes", bytes);
  if (bytes < 10'000'000) return base::format("{:.1f} kB", static_cast<double>(bytes) / 1e3);
  return base::format("{:.1f} MB", static_cast<double>(bytes) / 1e6);
}

bool is_solver(const std::string& path) { return path.starts_with("solver/") || path.find("/solver/") != path.npos; }

/// `  name   value`, names padded to one width.
class Table {
 public:
  void add(std::string name, std::string value) { lines_.emplace_back(std::move(name), std::move(value)); }
  void append_to(std::string& text, std::string_view heading) const {
    if (lines_.empty()) return;
    text += base::format("{}\n", heading);
    std::size_t width = 0;
    for (const auto& [name, value] : lines_) width = std::max(width, name.size());
    for (const auto& [name, value] : lines_) text += base::format("  {:<{}}  {}\n", name, width, value);
  }

 private:
  std::vector<std::pair<std::string, std::string>> lines_;
};

std::string with_unit(const std::string& text, const std::string& unit) {
  return unit.empty() ? text : text + " " + unit;
}

std::string values_text(const Array& row) {
  const auto& values = row.values;
  if (values.empty()) return "no rows yet";
  if (values.size() == 1) return with_unit(base::number_text(values[0], digits), row.unit);
  if (values.size() <= max_values_shown) return with_unit(list_text(values), row.unit);
  const auto [low, high] = std::ranges::minmax(values);
  return with_unit(base::format("{} values from {} to {}", values.size(), base::number_text(low, digits),
                                base::number_text(high, digits)),
                   row.unit);
}

std::string statistics_text(const Array& array) {
  const auto& values = array.values;
  if (values.empty()) return "no rows yet";
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  std::string text = base::format("mean {}, largest {}", base::number_text(sum / static_cast<double>(values.size()), 4),
                                  base::number_text(std::ranges::max(values), 4));
  if (array.type == ValueType::int64) text += ", sum " + base::number_text(sum);
  return with_unit(text, array.unit);
}

std::string status_text(const ResultFile& file) {
  std::string text = file.text("status").empty() ? "unknown (not a muldi-sim result)" : file.text("status");
  if (text == "running" && !LiveFile::is_live(file.path())) text += " (no process writes it: it was killed)";
  const auto time = file.attribute({}, "status_time");
  if (time && std::holds_alternative<double>(*time) && !std::isnan(std::get<double>(*time))) {
    const bool has_axis = file.contains("time");
    text += " at " + with_unit(text_of(*time), has_axis ? file.last_row("time").unit : "");
  }
  const std::string where = file.text("status_where");
  return where.empty() ? text : text + ": " + where;
}

std::string axis_text(const ResultFile& file, const std::string& axis, std::size_t rows) {
  if (rows == 0) return "no rows yet";
  const Array values = file.read(axis);
  return with_unit(base::format("{} rows from {} to {}", rows, base::number_text(values.values.front(), digits),
                                base::number_text(values.values.back(), digits)),
                   values.unit);
}

Table run_table(const ResultFile& file) {
  Table table;
  table.add("status", status_text(file));
  for (const char* name :
       {"title", "created", "command_line", "muldi_version", "git_hash", "compiler", "libraries", "threads", "units"}) {
    if (const auto value = file.attribute({}, name)) table.add(name, text_of(*value));
  }
  table.add("size", base::format("{} in {} data sets", size_text(file.bytes()), file.data_sets().size()));
  for (const auto& [axis, rows] : file.axes()) table.add("/" + axis, axis_text(file, axis, rows));
  return table;
}

}  // namespace

std::string info(const std::string& path) {
  const ResultFile file(path);
  Table final_values, solver, phases;
  for (const std::string& name : file.data_sets()) {
    const auto axis = file.axis_of(name);
    if (!axis || *axis == name) continue;
    if (is_solver(name)) {
      solver.add("/" + name, statistics_text(file.read(name)));
    } else {
      final_values.add("/" + name, values_text(file.last_row(name)));
    }
  }
  for (const Attribute& attribute : file.attributes({})) {
    if (!attribute.name.starts_with(wall_time)) continue;
    phases.add(attribute.name.substr(wall_time.size()), text_of(attribute.value) + " s");
  }
  std::string text;
  run_table(file).append_to(text, path);
  final_values.append_to(text, "final values");
  solver.append_to(text, "solver");
  phases.append_to(text, "wall time");
  return text;
}

}  // namespace muldi::results
