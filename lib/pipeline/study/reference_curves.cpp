#include "pipeline/study/reference_curves.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "base/text.hpp"
#include "results/result_file.hpp"
#include "scene/csv.hpp"
#include "scene/input_file.hpp"

namespace muldi::pipeline {
namespace {

std::string dotted(std::string path) {
  std::replace(path.begin(), path.end(), '/', '.');
  return path;
}

AxisKind axis_of(const std::string& path) {
  if (path.starts_with("statics.")) return AxisKind::load;
  return path.starts_with("materials.") ? AxisKind::stretch : AxisKind::time;
}

/// `path[2]` into path and component; false if the index is none.
bool split(const std::string& text, ReferenceCurve& curve) {
  const std::size_t bracket = text.find('[');
  curve.path = text.substr(0, bracket);
  if (bracket == std::string::npos) return true;
  const char* const end = text.data() + text.size() - 1;
  const auto [stop, fault] = std::from_chars(text.data() + bracket + 1, end, curve.component);
  return fault == std::errc() && stop == end && *end == ']' && curve.component >= 0;
}

class Reader {
 public:
  Reader(const scene::CalibrateStudy& study, const base::UnitSystem& units)
      : study_(study), units_(units), file_(scene::path_of_file(study.origin, study.reference)) {}

  std::vector<ReferenceCurve> read() {
    const bool table = file_.ends_with(".csv");
    if (!table && !file_.ends_with(".h5")) {
      throw base::InputError({scene::error_at(study_.origin, "reference: needs a file that ends in .h5 or .csv, got " +
                                                                 base::in_quotes(study_.reference))});
    }
    std::optional<results::ResultFile> result;
    if (table) {
      scene::InputFile text = scene::read_input_file(file_);
      if (!text.error.empty())
        fail(study_.origin, "cannot read the reference " + base::in_quotes(file_) + ": " + text.error);
      text_ = std::move(text.text);
    } else {
      result.emplace(file_);
      warn_of_units(*result);
    }
    stop();
    for (const scene::ComparedKey& key : study_.compare.items) {
      ReferenceCurve curve{.name = key.path, .weight = key.comparison.weight, .origin = key.origin};
      if (!split(key.path, curve)) {
        fail(key.origin, "needs a data set such as joints.hinge.coordinate, perhaps with [component]");
        continue;
      }
      curve.axis = axis_of(curve.path);
      const std::size_t n_errors = errors_.size();
      if (table) {
        from_table(key, curve);
      } else {
        from_result(*result, key, curve);
      }
      if (errors_.size() > n_errors) continue;
      const double largest = curve.values.cwiseAbs().maxCoeff();
      curve.scale = key.comparison.scale.value_or(largest > 0.0 ? largest : 1.0);
      curves_.push_back(std::move(curve));
    }
    stop();
    return std::move(curves_);
  }

 private:
  void fail(const scene::Origin& origin, std::string message) {
    errors_.push_back(scene::error_at(origin, std::move(message)));
  }
  void stop() {
    if (!errors_.empty()) throw base::InputError(std::move(errors_));
  }

  /// A result in another system of units cannot be compared number by number.
  void warn_of_units(const results::ResultFile& result) {
    const std::string own =
        base::joined(std::vector<std::string>{units_.length(), units_.mass(), units_.time(), units_.current()});
    const std::string theirs = result.text("units");
    if (!theirs.empty() && theirs != own) {
      fail(study_.origin, base::format("the reference is in the units {}, the scene in {}", theirs, own));
    }
  }

  void from_result(const results::ResultFile& result, const scene::ComparedKey& key, ReferenceCurve& curve) {
    const std::string wanted = key.comparison.data_set.value_or(curve.path);
    std::vector<std::string> known;
    for (const std::string& path : result.data_sets()) {
      known.push_back(dotted(path));
      if (known.back() != wanted) continue;
      const auto axis = result.axis_of(path);
      if (!axis) break;
      const results::Array values = result.read(path);
      const results::Array at = result.read(*axis);
      const auto n = static_cast<Eigen::Index>(at.values.size());
      const auto width = static_cast<Eigen::Index>(values.values.size()) / std::max<Eigen::Index>(n, 1);
      if (n == 0) break;
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      const Eigen::MatrixXd all = Eigen::Map<const RowMajor>(values.values.data(), n, width);
      curve.at = Eigen::Map<const Eigen::VectorXd>(at.values.data(), n);
      curve.unit = values.unit;
      if (curve.component >= width) {
        fail(key.origin, base::format("the data set has {} component{}", width, width == 1 ? "" : "s"));
        return;
      }
      curve.values = curve.component < 0 ? all : Eigen::MatrixXd(all.col(curve.component));
      return;
    }
    fail(key.origin, "the reference has no data set " + base::in_quotes(wanted) + base::did_you_mean(wanted, known));
  }

  /// The factor from a unit of the table to the scene's.
  double factor_of(const std::string& name) const { return units_.from(1.0, *base::parse_unit(name)); }

  void from_table(const scene::ComparedKey& key, ReferenceCurve& curve) {
    const scene::CsvColumns columns = scene::read_csv(text_, *key.comparison.column);
    if (!columns.error.empty()) {
      errors_.push_back({.place = {.file = file_, .line = columns.error_line, .column = 0}, .message = columns.error});
      return;
    }
    const auto n = static_cast<Eigen::Index>(columns.first.size());
    if (n == 0) {
      fail(key.origin, "the reference has no rows");
      return;
    }
    curve.at = Eigen::Map<const Eigen::VectorXd>(columns.first.data(), n);
    curve.values = Eigen::Map<const Eigen::VectorXd>(columns.other.data(), n);
    if (key.comparison.unit) curve.values *= factor_of(*key.comparison.unit);
    if (!study_.time_unit) return;
    const auto unit = base::parse_unit(*study_.time_unit);
    if (!unit) {
      fail(study_.origin, "time_unit: no unit " + base::in_quotes(*study_.time_unit));
    } else {
      curve.at *= units_.from(1.0, *unit);
    }
  }

  const scene::CalibrateStudy& study_;
  const base::UnitSystem& units_;
  std::string file_;
  std::string text_;
  std::vector<ReferenceCurve> curves_;
  std::vector<base::Diagnostic> errors_;
};

}  // namespace

std::vector<ReferenceCurve> read_references(const scene::CalibrateStudy& study, const base::UnitSystem& units) {
  return Reader(study, units).read();
}

}  // namespace muldi::pipeline
