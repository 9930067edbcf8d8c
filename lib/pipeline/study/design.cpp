#include "pipeline/study/design.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "base/error.hpp"
#include "base/text.hpp"
#include "scene/explain.hpp"

namespace muldi::pipeline {
namespace {

using scene::VariedKey;
using scene::VariedValues;

constexpr std::size_t most_points = 1'000'000;
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// A number that reads back to the same bits, in a form that YAML takes for a number.
std::string number_text(double value) { return base::number_text(value); }

/// A uniform number in [0, 1): the same on every machine.
double uniform(std::mt19937_64& engine) { return static_cast<double>(engine() >> 11U) * 0x1.0p-53; }

class Planner {
 public:
  Planner(const scene::SweepStudy& study, const scene::SceneText& text) : study_(study), text_(text) {}

  SweepPlan plan() {
    const bool usual_units = text_.read({}).units == base::UnitSystem();
    for (const VariedKey& key : study_.vary.items) {
      plan_.keys.push_back(key.path);
      const auto help = scene::find_key(key.path);
      plan_.units.push_back(help && usual_units ? help->unit : "");
      targets_.push_back(text_.keys(key.path, key.origin, errors_));
    }
    stop();
    for (std::size_t k = 0; k < study_.vary.items.size(); ++k) values_.push_back(values_of(k));
    stop();
    make_points();
    check_points();
    stop();
    return std::move(plan_);
  }

 private:
  void stop() {
    if (!errors_.empty()) throw base::InputError(std::move(errors_));
  }

  std::vector<std::string> overrides(std::size_t key, const std::string& value) const {
    std::vector<std::string> all;
    for (const std::string& target : targets_[key]) {
      all.push_back(target);
      all.back() += "=" + value;
    }
    return all;
  }

  /// Errors of the scene about a value, as errors of the study about its key.
  void blame(const base::InputError& error, const scene::Origin& origin, const std::string& value) {
    for (const base::Diagnostic& found : error.diagnostics()) {
      base::Diagnostic here =
          scene::error_at(origin, base::format("with {}: {}{}{}", base::in_quotes(value), found.path,
                                               found.path.empty() ? "" : ": ", found.message));
      if (std::find(errors_.begin(), errors_.end(), here) == errors_.end()) errors_.push_back(std::move(here));
    }
  }

  /// The number that a value of a key is, in the scene's units.
  double number_of(std::size_t key, const std::string& value) {
    const scene::Origin& origin = study_.vary.items[key].origin;
    try {
      const auto number = scene::number_at(text_.read(overrides(key, value)), targets_[key].front());
      if (number) return *number;
      errors_.push_back(scene::error_at(origin, base::in_quotes(value) + " is no number"));
    } catch (const base::InputError& error) {
      blame(error, origin, value);
    }
    return nan_value;
  }

  std::vector<std::string> values_of(std::size_t key) {
    const VariedValues& said = study_.vary.items[key].values;
    if (said.kind == VariedValues::Kind::values) return said.texts;
    const double from = number_of(key, said.from);
    const double to = number_of(key, said.to);
    const bool logarithmic = said.kind == VariedValues::Kind::logspace || said.logarithmic;
    if (logarithmic && !(from > 0.0 && to > 0.0) && !std::isnan(from + to)) {
      errors_.push_back(scene::error_at(study_.vary.items[key].origin, "logarithms need positive ends"));
    }
    if (said.kind == VariedValues::Kind::range) return sampled(from, to, logarithmic);
    std::vector<std::string> values;
    for (int i = 0; i < said.count; ++i) {
      const double part = said.count > 1 ? static_cast<double>(i) / (said.count - 1) : 0.0;
      values.push_back(number_text(between(from, to, part, logarithmic)));
    }
    return values;
  }

  static double between(double from, double to, double part, bool logarithmic) {
    if (part == 0.0) return from;
    if (part == 1.0) return to;
    return logarithmic ? from * std::pow(to / from, part) : from + part * (to - from);
  }

  /// One value in each of n equal parts, in random order; keys are drawn in the order of the file.
  std::vector<std::string> sampled(double from, double to, bool logarithmic) {
    const auto n = static_cast<std::size_t>(study_.samples.value_or(1));
    std::vector<std::size_t> order(n);
    for (std::size_t i = 0; i < n; ++i) order[i] = i;
    for (std::size_t i = n; i > 1; --i) {
      std::swap(order[i - 1], order[static_cast<std::size_t>(uniform(engine_) * static_cast<double>(i))]);
    }
    std::vector<std::string> values;
    for (const std::size_t part : order) {
      const double place = (static_cast<double>(part) + uniform(engine_)) / static_cast<double>(n);
      values.push_back(number_text(between(from, to, place, logarithmic)));
    }
    return values;
  }

  void make_points() {
    const bool grid = study_.design == scene::Design::grid;
    std::size_t n = grid ? 1 : values_.front().size();
    for (std::size_t k = 0; k < values_.size() && grid; ++k) {
      n *= values_[k].size();
      if (n > most_points) {
        errors_.push_back(scene::error_at(study_.vary.items[k].origin, "more than a million points"));
        stop();
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      DesignPoint& point = plan_.points.emplace_back();
      std::size_t rest = i;
      point.texts.resize(values_.size());
      for (std::size_t k = values_.size(); k-- > 0;) {
        point.texts[k] = values_[k][grid ? rest % values_[k].size() : i];
        rest /= values_[k].size();
      }
      for (std::size_t k = 0; k < values_.size(); ++k) {
        const auto own = overrides(k, point.texts[k]);
        point.overrides.insert(point.overrides.end(), own.begin(), own.end());
      }
    }
  }

  /// Reads every point before the first one runs.
  void check_points() {
    std::map<std::pair<std::size_t, std::string>, double> numbers;
    for (DesignPoint& point : plan_.points) {
      point.numbers.assign(values_.size(), nan_value);
      try {
        const scene::Scene scene = text_.read(point.overrides);
        scene::Node resolved;
        for (std::size_t k = 0; k < values_.size(); ++k) {
          const auto [place, is_new] = numbers.try_emplace({k, point.texts[k]}, nan_value);
          if (is_new) {
            if (resolved.is_null()) resolved = scene::resolved_tree(scene);
            place->second = scene::number_at(resolved, targets_[k].front()).value_or(nan_value);
          }
          point.numbers[k] = place->second;
        }
      } catch (const base::InputError& error) {
        blame_point(error, point);
      }
    }
  }

  /// Each error belongs to the key whose override it names, else to the whole point.
  void blame_point(const base::InputError& error, const DesignPoint& point) {
    for (const base::Diagnostic& found : error.diagnostics()) {
      std::size_t guilty = values_.size();
      for (std::size_t k = 0; k < values_.size(); ++k) {
        for (const std::string& override : overrides(k, point.texts[k])) {
          if (found.place.file == "--set " + override) guilty = k;
        }
      }
      if (guilty == values_.size()) {
        blame(base::InputError(std::vector<base::Diagnostic>{found}), study_.origin, base::joined(point.overrides));
      } else {
        blame(base::InputError(std::vector<base::Diagnostic>{found}), study_.vary.items[guilty].origin,
              point.texts[guilty]);
      }
    }
  }

  const scene::SweepStudy& study_;
  const scene::SceneText& text_;
  std::mt19937_64 engine_{static_cast<std::uint64_t>(study_.seed)};
  std::vector<std::vector<std::string>> targets_;  // of every key
  std::vector<std::vector<std::string>> values_;
  std::vector<base::Diagnostic> errors_;
  SweepPlan plan_;
};

}  // namespace

SweepPlan plan_sweep(const scene::SweepStudy& study, const scene::SceneText& scene) {
  return Planner(study, scene).plan();
}

}  // namespace muldi::pipeline
