#include "pipeline/study/parameters.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "base/text.hpp"
#include "scene/explain.hpp"

namespace muldi::pipeline {
namespace {

constexpr double relative_step = 1.0 / 128.0;
constexpr double least_scale = 1e-3;  // of the distance of the bounds, where a value is near 0
constexpr int most_halvings = 24;     // of the step, near the end of what a key may be

/// Central differences of order 8.
struct StencilPoint {
  int place;
  double weight;
};
constexpr std::array<StencilPoint, 8> stencil{{{1, 4.0 / 5.0},
                                               {-1, -4.0 / 5.0},
                                               {2, -1.0 / 5.0},
                                               {-2, 1.0 / 5.0},
                                               {3, 4.0 / 105.0},
                                               {-3, -4.0 / 105.0},
                                               {4, -1.0 / 280.0},
                                               {-4, 1.0 / 280.0}}};

/// A message of the scene about a value, as one of the study about its key.
void blame(const base::InputError& error, const scene::Origin& origin, const std::string& value,
           std::vector<base::Diagnostic>& errors) {
  for (const base::Diagnostic& found : error.diagnostics()) {
    base::Diagnostic here = scene::error_at(origin, base::format("with {}: {}{}{}", base::in_quotes(value), found.path,
                                                                 found.path.empty() ? "" : ": ", found.message));
    if (std::find(errors.begin(), errors.end(), here) == errors.end()) errors.push_back(std::move(here));
  }
}

}  // namespace

Parameters::Parameters(const scene::CalibrateStudy& study, const scene::SceneText& scene) : text_(scene) {
  const auto n = static_cast<Eigen::Index>(study.fit.items.size());
  lower_ = upper_ = start_ = Eigen::VectorXd::Zero(n);
  std::vector<base::Diagnostic> errors;
  const scene::Node base_tree = scene::resolved_tree(scene.read({}));
  const bool usual_units = scene.read({}).units == base::UnitSystem();
  for (Eigen::Index k = 0; k < n; ++k) {
    const scene::FittedKey& key = study.fit.items[static_cast<std::size_t>(k)];
    names_.push_back(key.path);
    const auto help = scene::find_key(key.path);
    units_.push_back(help && usual_units && help->unit != "1" ? help->unit : "");
    targets_.push_back(scene.keys(key.path, key.origin, errors));
    if (targets_.back().empty()) continue;
    const auto number = [&](const std::string& value) {
      std::vector<std::string> all;
      for (const std::string& target : targets_.back()) all.push_back(base::format("{}={}", target, value));
      try {
        const auto found = scene::number_at(text_.read(all), targets_.back().front());
        if (found) return *found;
        errors.push_back(scene::error_at(key.origin, base::in_quotes(value) + " is no number"));
      } catch (const base::InputError& error) {
        blame(error, key.origin, value, errors);
      }
      return std::nan("");
    };
    lower_[k] = number(key.range.min);
    upper_[k] = number(key.range.max);
    if (lower_[k] >= upper_[k]) errors.push_back(scene::error_at(key.origin, "min must be below max"));
    if (key.range.start) {
      start_[k] = number(*key.range.start);
    } else if (const auto own = scene::number_at(base_tree, targets_.back().front())) {
      start_[k] = *own;
    } else {
      errors.push_back(scene::error_at(key.origin, "the scene does not have this key: give `start`"));
      continue;
    }
    if (start_[k] < lower_[k] || start_[k] > upper_[k]) {
      errors.push_back(scene::error_at(
          key.origin,
          base::format("the start {:.6g} is not between min and max: widen them or give `start`", start_[k])));
    }
  }
  if (!errors.empty()) throw base::InputError(std::move(errors));
}

std::vector<std::string> Parameters::overrides(const Eigen::VectorXd& theta) const {
  std::vector<std::string> all;
  for (std::size_t k = 0; k < size(); ++k) {
    for (const std::string& target : targets_[k]) {
      all.push_back(base::format("{}={}", target, base::number_text(theta[static_cast<Eigen::Index>(k)])));
    }
  }
  return all;
}

std::vector<Variant> Parameters::variants(const Eigen::VectorXd& theta, std::size_t k) const {
  const auto at = static_cast<Eigen::Index>(k);
  double step = relative_step * std::max(std::abs(theta[at]), least_scale * (upper_[at] - lower_[at]));
  for (int halving = 0;; ++halving, step *= 0.5) {
    try {
      std::vector<Variant> all;
      for (const StencilPoint& point : stencil) {
        Eigen::VectorXd moved = theta;
        moved[at] += point.place * step;
        Variant& variant = all.emplace_back();
        variant.offset = moved[at] - theta[at];
        variant.weight = point.weight / step;
        variant.scene = scene_at(moved);
        variant.built = build::build_model(variant.scene);
      }
      return all;
    } catch (const base::InputError&) {
      if (halving == most_halvings) throw;
    }
  }
}

}  // namespace muldi::pipeline
