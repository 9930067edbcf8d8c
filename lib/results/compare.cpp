#include "results/compare.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "base/text.hpp"
#include "results/result_file.hpp"

namespace muldi::results {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Counters of the solver and the state to go on with: they may change where the physics does not.
const std::vector<std::string> not_physics{"solver", "*/solver", "checkpoint", "*/checkpoint"};

/// Shell glob with `*` (any characters, slashes too) and `?` (one character).
bool glob(std::string_view pattern, std::string_view text) {
  std::size_t p = 0, t = 0, star = std::string_view::npos, resume = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++resume;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

bool matches(const std::string& path, const std::vector<std::string>& patterns) {
  return std::ranges::any_of(patterns, [&](std::string pattern) {
    if (pattern.starts_with('/')) pattern.erase(0, 1);
    if (pattern.ends_with('/')) pattern.pop_back();
    return glob(pattern, path) || glob(pattern + "/*", path);
  });
}

bool selected(const std::string& path, const CompareOptions& options) {
  if (matches(path, options.ignore)) return false;
  return options.only.empty() ? !matches(path, not_physics) : matches(path, options.only);
}

std::string text_of(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (const std::size_t number : numbers) text += (text.empty() ? "" : ", ") + std::to_string(number);
  return "[" + text + "]";
}

double tolerance_of(const ResultFile& file, const std::string& path, const std::string& name, double otherwise) {
  const auto value = file.attribute(path, name);
  return value && std::holds_alternative<double>(*value) ? std::get<double>(*value) : otherwise;
}

/// |a - b| over the tolerance; 0 where they agree although the quotient is not defined.
double excess_of(double a, double b, double tolerance) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0.0;
  const double error = std::abs(a - b);
  if (!std::isfinite(error) || tolerance == 0.0) return infinity;
  return error / tolerance;
}

std::vector<std::size_t> index_of(std::size_t position, const Shape& shape) {
  std::vector<std::size_t> index(shape.size());
  for (std::size_t i = shape.size(); i-- > 0; position /= shape[i]) index[i] = position % shape[i];
  return index;
}

/// The worst value; `excess` is 0 if all agree.
Difference compare_values(const Array& a, const Array& b, double rtol, double atol) {
  double largest = 0.0;
  for (const double value : a.values) {
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  }
  const double tolerance = atol + rtol * largest;
  Difference worst;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const double excess = excess_of(a.values[i], b.values[i], tolerance);
    if (excess > 1.0) ++worst.count;
    if (excess > 1.0 && excess > worst.excess) {
      worst.excess = excess;
      worst.index = index_of(i, a.shape);
      worst.left = a.values[i];
      worst.right = b.values[i];
    }
  }
  return worst;
}

Difference difference(Difference::Kind kind, const std::string& path, std::string first, std::string second) {
  return {.kind = kind,
          .path = "/" + path,
          .first = std::move(first),
          .second = std::move(second),
          .time = std::numeric_limits<double>::quiet_NaN(),
          .excess = infinity};
}

/// The largest difference of each row.
std::vector<double> differences_of_rows(const Array& a, const Array& b) {
  const std::size_t width = a.values.size() / a.shape[0];
  std::vector<double> rows(a.shape[0], 0.0);
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    rows[i / width] = std::max(rows[i / width], std::abs(a.values[i] - b.values[i]));
  }
  return rows;
}

/// Straight line through the logarithms of the differences between round-off and a hundredth of the largest value:
/// exponential growth where it climbs by six orders of magnitude and explains nearly all of their spread (of a power of
/// time three quarters).
std::optional<Divergence> divergence_of(const Array& a, const Array& b, const Array& time) {
  double largest = 0.0;
  for (const double value : a.values) largest = std::max(largest, std::abs(value));
  const std::vector<double> rows = differences_of_rows(a, b);
  double n = 0.0, t1 = 0.0, y1 = 0.0, tt = 0.0, ty = 0.0, yy = 0.0, peak = 0.0, low = infinity;
  Divergence found{.unit = time.unit, .first_time = infinity, .visible_time = infinity};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    peak = std::max(peak, rows[i]);
    if (rows[i] > 1e-3 * largest) found.visible_time = std::min(found.visible_time, time.values[i]);
    // The envelope counts: differences of oscillations pass through zero.
    if (!(rows[i] > 1e-15 * largest) || rows[i] < peak || peak > 1e-2 * largest) continue;
    found.first_time = std::min(found.first_time, time.values[i]);
    const double t = time.values[i], y = std::log(rows[i]);
    low = std::min(low, y);
    n += 1.0, t1 += t, y1 += y, tt += t * t, ty += t * y, yy += y * y;
  }
  const double spread_t = n * tt - t1 * t1, spread_y = n * yy - y1 * y1, both = n * ty - t1 * y1;
  const double climbed = std::log(std::max(std::min(peak, 1e-2 * largest), 1e-300)) - low;
  const bool many = n >= 10.0 && climbed > std::log(1e6);
  if (!many || both <= 0.0 || both * both < 0.88 * spread_t * spread_y) return std::nullopt;
  found.rate = both / spread_t;
  return found;
}

class Comparer {
 public:
  Comparer(const std::string& first, const std::string& second, const CompareOptions& options)
      : first_(first), second_(second), options_(options) {
    result_.first_file = first;
    result_.second_file = second;
  }

  Comparison compare_all() {
    for (const char* name : {"status", "units"}) {
      const auto kind = std::string_view(name) == "status" ? Difference::Kind::status : Difference::Kind::unit;
      const std::string a = first_.text(name), b = second_.text(name);
      if (options_.only.empty() && a != b) result_.differences.push_back(difference(kind, name, a, b));
    }
    std::set<std::string> paths(first_.data_sets().begin(), first_.data_sets().end());
    paths.insert(second_.data_sets().begin(), second_.data_sets().end());
    for (const std::string& path : paths) {
      if (selected(path, options_)) compare_one(path);
    }
    std::ranges::stable_sort(result_.differences, std::ranges::greater{}, &Difference::excess);
    return std::move(result_);
  }

 private:
  void compare_one(const std::string& path) {
    ++result_.n_data_sets;
    if (!first_.contains(path) || !second_.contains(path)) {
      result_.differences.push_back(difference(Difference::Kind::missing, path, first_.contains(path) ? "present" : "-",
                                               second_.contains(path) ? "present" : "-"));
      return;
    }
    const Array a = first_.read(path), b = second_.read(path);
    if (a.unit != b.unit) result_.differences.push_back(difference(Difference::Kind::unit, path, a.unit, b.unit));
    if (a.shape != b.shape) {
      result_.differences.push_back(difference(Difference::Kind::shape, path, text_of(a.shape), text_of(b.shape)));
      return;
    }
    result_.n_values += a.values.size();
    Difference worst = compare_values(a, b, tolerance_of(first_, path, "rtol", options_.rtol),
                                      tolerance_of(first_, path, "atol", options_.atol));
    if (worst.count == 0) return;
    worst.path = "/" + path;
    const auto axis = first_.axis_of(path);
    worst.time = axis ? first_.read(*axis).values[worst.index[0]] : std::numeric_limits<double>::quiet_NaN();
    look_for_chaos(path, a, b, axis);
    result_.differences.push_back(std::move(worst));
  }

  void look_for_chaos(const std::string& path, const Array& a, const Array& b, const std::optional<std::string>& axis) {
    // Positions and angles: energies and momenta may be conserved, rates and forces are noisier.
    const bool of_motion = path.starts_with("bodies/") || path.starts_with("joints/") || path.starts_with("points/");
    if (!axis || *axis != "time" || !of_motion || result_.divergence) return;
    result_.divergence = divergence_of(a, b, first_.read(*axis));
    if (result_.divergence) result_.divergence->path = "/" + path;
  }

  ResultFile first_, second_;
  const CompareOptions& options_;
  Comparison result_;
};

using Cells = std::array<std::string, 6>;

Cells cells_of(const Difference& found) {
  switch (found.kind) {
    case Difference::Kind::missing:
      return {found.path, "data set", "", found.first, found.second, ""};
    case Difference::Kind::status:
      return {found.path, "status", "", found.first, found.second, ""};
    case Difference::Kind::shape:
      return {found.path, "shape", "", found.first, found.second, ""};
    case Difference::Kind::unit:
      return {found.path, "unit", "", found.first, found.second, ""};
    case Difference::Kind::value:
      break;
  }
  return {found.path,
          text_of(found.index),
          std::isnan(found.time) ? "" : base::number_text(found.time, 10),
          base::number_text(found.left),
          base::number_text(found.right),
          base::number_text(found.excess, 3)};
}

std::string text_of(const Divergence& found) {
  std::string text =
      base::format("exponential growth: {} drifts apart tenfold every {:.3g} {}, from round-off at t = {:.4g} {}",
                   found.path, std::log(10.0) / found.rate, found.unit, found.first_time, found.unit);
  if (std::isfinite(found.visible_time)) {
    text += base::format(" to a thousandth of its size at t = {:.4g} {}", found.visible_time, found.unit);
  }
  return text +
         "\n  why: an unstable or chaotic motion forgets its start, round-off is enough: neither of the two is wrong\n"
         "  try: compare energies and momenta (--only 'energy/*' --only 'momentum/*'), or a shorter time\n";
}

}  // namespace

Comparison compare(const std::string& first, const std::string& second, const CompareOptions& options) {
  return Comparer(first, second, options).compare_all();
}

std::string to_text(const Comparison& comparison, std::size_t max_lines) {
  const std::size_t n = comparison.differences.size();
  if (comparison.same()) {
    return base::format("'{}' and '{}' agree: {} data sets, {} values\n", comparison.first_file, comparison.second_file,
                        comparison.n_data_sets, comparison.n_values);
  }
  std::vector<Cells> lines{{"data set", "index", "time", "first", "second", "|a-b|/tolerance"}};
  for (std::size_t i = 0; i < std::min(n, max_lines); ++i) lines.push_back(cells_of(comparison.differences[i]));
  std::array<std::size_t, std::tuple_size_v<Cells>> widths{};
  for (const Cells& line : lines) {
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
  }
  std::string text = base::format("'{}' and '{}' differ: {} in {} data sets, the worst first\n", comparison.first_file,
                                  comparison.second_file, n, comparison.n_data_sets);
  for (const Cells& line : lines) {
    std::string row;
    for (std::size_t c = 0; c < line.size(); ++c) row += base::format("{:<{}}  ", line[c], widths[c]);
    text += row.substr(0, row.find_last_not_of(' ') + 1) + "\n";
  }
  if (n > max_lines) text += base::format("and {} more\n", n - max_lines);
  if (comparison.divergence) text += text_of(*comparison.divergence);
  return text;
}

}  // namespace muldi::results
