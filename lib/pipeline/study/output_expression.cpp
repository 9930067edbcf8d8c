#include "pipeline/study/output_expression.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "base/diagnostic.hpp"
#include "base/text.hpp"

namespace muldi::pipeline {
namespace {

struct ReductionWord {
  std::string_view word;
  Reduction reduction;
};
constexpr ReductionWord reductions[] = {{"final", Reduction::final},
                                        {"min", Reduction::min},
                                        {"max", Reduction::max},
                                        {"mean", Reduction::mean},
                                        {"largest", Reduction::largest}};

std::string dotted(std::string path) {
  std::replace(path.begin(), path.end(), '/', '.');
  return path;
}

/// One entry of `[...]`; false if it is neither a whole number nor, as a row, `:`.
bool parse_index(std::string_view word, bool is_row, OutputExpression& out) {
  word = base::trimmed(word);
  if (is_row && word == ":") return true;
  long value = 0;
  const auto [stop, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (fault != std::errc() || stop != word.data() + word.size()) return false;
  if (is_row) {
    out.all_rows = false;
    out.row = value;
  } else {
    out.component.push_back(value);
  }
  return true;
}

/// The indices behind a path: `[-1]`, `[-1][2]`, `[:, 1]`.
bool parse_indices(std::string_view text, OutputExpression& out) {
  bool is_row = true;
  while (!text.empty()) {
    const std::size_t end = text.find(']');
    if (text.front() != '[' || end == text.npos) return false;
    std::string_view inside = text.substr(1, end - 1);
    text.remove_prefix(end + 1);
    for (bool more = true; more; is_row = false) {
      const std::size_t comma = inside.find(',');
      more = comma != inside.npos;
      if (!parse_index(inside.substr(0, comma), is_row, out)) return false;
      inside.remove_prefix(more ? comma + 1 : inside.size());
    }
  }
  return true;
}

/// Place of a component in a row; the size of a row if it is out of range.
std::size_t place_of(const OutputExpression& output, const results::Shape& shape) {
  std::size_t place = 0;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    const auto extent = static_cast<long>(shape[i]);
    const long said = i < output.component.size() ? output.component[i] : 0;
    const long index = said < 0 ? said + extent : said;
    if (index < 0 || index >= extent) return results::count(shape);
    place = place * shape[i] + static_cast<std::size_t>(index);
  }
  return place;
}

double reduce(Reduction reduction, const std::vector<double>& values) {
  switch (reduction) {
    case Reduction::min:
      return *std::min_element(values.begin(), values.end());
    case Reduction::max:
      return *std::max_element(values.begin(), values.end());
    case Reduction::largest: {
      double largest = 0.0;
      for (const double value : values) largest = std::max(largest, std::abs(value));
      return largest;
    }
    case Reduction::mean: {
      double sum = 0.0;
      for (const double value : values) sum += value;
      return sum / static_cast<double>(values.size());
    }
    default:
      return values.back();
  }
}

/// A number that the run has put down as an attribute of a group.
double attribute_of(const std::string& path, const results::MemoryRecorder& record) {
  const auto matches = [&](const results::Attribute& attribute) {
    const std::string object = dotted(attribute.object);
    return path == (object.empty() ? attribute.name : object + "." + attribute.name);
  };
  const auto number = [](const results::Attribute& attribute) {
    if (const auto* real = std::get_if<double>(&attribute.value)) return *real;
    if (const auto* whole = std::get_if<std::int64_t>(&attribute.value)) return static_cast<double>(*whole);
    return std::numeric_limits<double>::quiet_NaN();
  };
  for (const results::Attribute& attribute : record.late_attributes()) {
    if (matches(attribute)) return number(attribute);
  }
  for (const results::Attribute& attribute : record.declared().attributes) {
    if (matches(attribute)) return number(attribute);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// What a run may put down as attributes.
bool may_be_attribute(const std::string& path) {
  static const std::vector<std::string> known{"statics.critical_load_above", "statics.critical_load_below",
                                              "statics.limit_load", "statics.branch_load"};
  return std::find(known.begin(), known.end(), path) != known.end();
}

}  // namespace

OutputExpression parse_output(const std::string& text, std::string& error) {
  OutputExpression out{.text = text};
  std::string_view rest = base::trimmed(text);
  const std::size_t bracket = rest.find('(');
  if (bracket != rest.npos) {
    const std::string word(base::trimmed(rest.substr(0, bracket)));
    const auto* const found = std::find_if(std::begin(reductions), std::end(reductions),
                                           [&](const ReductionWord& each) { return each.word == word; });
    if (found == std::end(reductions) || rest.back() != ')') {
      std::vector<std::string> words;
      for (const ReductionWord& each : reductions) words.emplace_back(each.word);
      error = rest.back() != ')' ? "the bracket is not closed"
                                 : "no reduction " + base::in_quotes(word) + base::did_you_mean(word, words);
      return out;
    }
    out.reduction = found->reduction;
    rest = base::trimmed(rest.substr(bracket + 1, rest.size() - bracket - 2));
  }
  const std::size_t indices = rest.find('[');
  out.path = dotted(std::string(base::trimmed(rest.substr(0, indices))));
  if (out.path.empty() || (indices != rest.npos && !parse_indices(rest.substr(indices), out))) {
    error = "needs a data set with indices such as joints.hinge.coordinate[-1] or max(points.arm.tip[:, 1])";
  }
  return out;
}

const results::DeclaredChannel* channel_of(const results::Layout& layout, const std::string& path) {
  for (const results::DeclaredChannel& channel : layout.channels) {
    if (dotted(channel.spec.path) == path) return &channel;
  }
  return nullptr;
}

std::string why_no_output(const OutputExpression& output, const results::Layout& layout, std::string& unit) {
  const results::DeclaredChannel* channel = channel_of(layout, output.path);
  if (channel == nullptr) {
    if (may_be_attribute(output.path)) return {};
    std::vector<std::string> known;
    for (const results::DeclaredChannel& each : layout.channels) known.push_back(dotted(each.spec.path));
    return "the result has no data set " + base::in_quotes(output.path) + base::did_you_mean(output.path, known);
  }
  unit = channel->spec.unit;
  const results::Shape& shape = channel->spec.shape;
  const std::size_t size = results::count(shape);
  if (output.component.size() > shape.size() || (size > 1 && output.component.size() < shape.size())) {
    std::string form = "(rows";
    for (const std::size_t extent : shape) form += ", " + std::to_string(extent);
    return base::format("the data set is {}): give the row and {} component{}", form, shape.size(),
                        shape.size() == 1 ? "" : "s");
  }
  if (place_of(output, shape) >= size) return "the component is out of range";
  if (output.all_rows && output.reduction == Reduction::none) {
    return "is a series: give a row such as [-1], or a reduction such as max(...)";
  }
  return {};
}

double value_of(const OutputExpression& output, const results::MemoryRecorder& record) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const results::DeclaredChannel* channel = channel_of(record.declared(), output.path);
  if (channel == nullptr) return attribute_of(output.path, record);
  const std::size_t width = results::count(channel->spec.shape);
  const std::size_t place = place_of(output, channel->spec.shape);
  std::vector<double> all;
  if (channel->spec.type == results::ValueType::int64) {
    const auto whole = record.integers(channel->spec.path);
    all.assign(whole.begin(), whole.end());
  } else {
    const auto reals = record.reals(channel->spec.path);
    all.assign(reals.begin(), reals.end());
  }
  const auto n_rows = static_cast<long>(all.size() / width);
  std::vector<double> values;
  const long row = output.row < 0 ? output.row + n_rows : output.row;
  if (!output.all_rows && (row < 0 || row >= n_rows)) return none;
  const long first = output.all_rows ? 0 : row;
  const long last = output.all_rows ? n_rows : row + 1;
  for (long i = first; i < last; ++i) values.push_back(all[static_cast<std::size_t>(i) * width + place]);
  return values.empty() || place >= width ? none : reduce(output.reduction, values);
}

}  // namespace muldi::pipeline
