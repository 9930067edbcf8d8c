#include "pipeline/study/prediction.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/text.hpp"
#include "build/permittivity.hpp"
#include "pipeline/node_rows.hpp"
#include "pipeline/required_size.hpp"
#include "pipeline/run_statics.hpp"
#include "pipeline/study/output_expression.hpp"
#include "pipeline/study/simulated_equilibria.hpp"
#include "pipeline/study/simulated_motion.hpp"
#include "results/memory_recorder.hpp"

namespace muldi::pipeline {
namespace {

constexpr double same_place = 1e-9;  // of the range of the axis

/// `materials.<name>.permittivity_by_force`, or `..._by_capacity`.
struct MaterialCurve {
  std::string material = {};
  bool by_force = false;
};

MaterialCurve material_curve(const ReferenceCurve& curve) {
  const std::size_t dot = curve.path.rfind('.');
  MaterialCurve found{.material = curve.path.substr(10, dot < 10 ? 0 : dot - 10)};
  found.by_force = curve.path.substr(dot + 1) == "permittivity_by_force";
  return found;
}

void check_material(const scene::Scene& scene, const ReferenceCurve& curve, std::vector<base::Diagnostic>& errors) {
  const MaterialCurve wanted = material_curve(curve);
  const std::string quantity = curve.path.substr(curve.path.rfind('.') + 1);
  const std::vector<std::string> known{"permittivity_by_capacity", "permittivity_by_force"};
  const auto* entry = scene.materials.find(wanted.material);
  if (entry == nullptr) {
    errors.push_back(scene::error_at(curve.origin, "the scene has no material " + base::in_quotes(wanted.material) +
                                                       base::did_you_mean(wanted.material, scene.materials.names())));
  } else if (!entry->value.electric) {
    errors.push_back(scene::error_at(curve.origin, "the material is no dielectric"));
  }
  if (std::find(known.begin(), known.end(), quantity) == known.end()) {
    errors.push_back(scene::error_at(
        curve.origin, "a material has no curve " + base::in_quotes(quantity) + base::did_you_mean(quantity, known)));
  }
}

/// Where a dotted path with its component is recorded, one column a component of the reference.
std::vector<RecordedColumn> columns_of(const results::Layout& layout, const ReferenceCurve& curve) {
  const results::DeclaredChannel* channel = channel_of(layout, curve.path);
  std::vector<RecordedColumn> columns;
  for (Eigen::Index c = 0; c < curve.values.cols(); ++c) {
    columns.push_back({channel->spec.path,
                       curve.component < 0 ? static_cast<std::size_t>(c) : static_cast<std::size_t>(curve.component)});
  }
  return columns;
}

/// What a scene would record.
void declare(const scene::Scene& scene, const build::BuiltModel& built, results::MemoryRecorder& recorder) {
  if (scene.statics) NodeRows(recorder, scene, built, NodeRows::Kind::statics, 1);
  if (scene.dynamics) NodeRows(recorder, scene, built, NodeRows::Kind::dynamics, 1);
}

void check_recorded(const scene::Scene& scene, const build::BuiltModel& built, const results::Layout& layout,
                    ReferenceCurve& curve, std::vector<base::Diagnostic>& errors) {
  const auto fail = [&](std::string message) { errors.push_back(scene::error_at(curve.origin, std::move(message))); };
  const bool statics = curve.axis == AxisKind::load;
  if (statics ? !scene.statics : !scene.dynamics) {
    fail(statics ? "the scene has no statics" : "the scene has no dynamics");
    return;
  }
  if (statics && scene.statics->continuation == scene::Continuation::arc_length) {
    fail("an arc length has no value at a given load: take continuation: natural");
  }
  const results::DeclaredChannel* channel = channel_of(layout, curve.path);
  if (channel == nullptr) {
    std::vector<std::string> known;
    for (const results::DeclaredChannel& each : layout.channels) {
      known.push_back(each.spec.path);
      std::replace(known.back().begin(), known.back().end(), '/', '.');
    }
    fail("the result has no data set " + base::in_quotes(curve.path) + base::did_you_mean(curve.path, known));
    return;
  }
  if (curve.unit.empty()) curve.unit = channel->spec.unit;
  const auto width = static_cast<Eigen::Index>(results::count(channel->spec.shape));
  if (channel->spec.type != results::ValueType::float64) fail("counts have no derivatives");
  if (built.manifold->n_loop_rows() > 0 && curve.path.ends_with(".reaction")) {
    fail("reactions of closed loops have no sensitivities");
  }
  if (curve.component >= width || (curve.component < 0 && curve.values.cols() != width)) {
    fail(base::format("the data set has {} component{}, the reference {}: give [component] behind the path", width,
                      width == 1 ? "" : "s", curve.values.cols()));
  }
}

/// Keeps the points of a curve inside of [first, last].
void cut(ReferenceCurve& curve, double first, double last, std::vector<base::Diagnostic>& errors) {
  const double low = std::min(first, last);
  const double high = std::max(first, last);
  const double slack = same_place * (high - low);
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < curve.at.size(); ++i) {
    if (curve.at[i] >= low - slack && curve.at[i] <= high + slack) kept.push_back(i);
  }
  if (kept.empty()) {
    errors.push_back(scene::error_at(
        curve.origin,
        base::format("no point of the reference lies in what the scene runs, {:.6g} to {:.6g}", low, high)));
    return;
  }
  Eigen::VectorXd at(static_cast<Eigen::Index>(kept.size()));
  Eigen::MatrixXd values(at.size(), curve.values.cols());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    at[static_cast<Eigen::Index>(i)] = curve.at[kept[i]];
    values.row(static_cast<Eigen::Index>(i)) = curve.values.row(kept[i]);
  }
  curve.at = at;
  curve.values = values;
}

bool any_of_kind(const std::vector<ReferenceCurve>& curves, AxisKind kind) {
  return std::any_of(curves.begin(), curves.end(), [&](const ReferenceCurve& curve) { return curve.axis == kind; });
}

Eigen::VectorXd permittivities(const scene::Scene& scene, const ReferenceCurve& curve) {
  const MaterialCurve wanted = material_curve(curve);
  const scene::Material& material = scene.materials.find(wanted.material)->value;
  Eigen::VectorXd values(curve.at.size());
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    values[i] = wanted.by_force ? build::force_permittivity(scene, material, curve.at[i])
                                : build::capacity_permittivity(scene, material, curve.at[i]);
  }
  return values;
}

}  // namespace

Eigen::MatrixXd interpolation(const Eigen::VectorXd& axis, const Eigen::VectorXd& at) {
  const Eigen::Index n = axis.size();
  const Eigen::Index n_used = std::min<Eigen::Index>(n, 4);
  const double direction = n > 1 && axis[n - 1] < axis[0] ? -1.0 : 1.0;
  const double slack = same_place * std::abs(axis[n - 1] - axis[0]);
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(at.size(), n);
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    Eigen::Index after = 0;
    while (after < n && direction * (axis[after] - at[i]) < -slack) ++after;
    if (after < n && std::abs(axis[after] - at[i]) <= slack) {
      weights(i, after) = 1.0;
      continue;
    }
    const Eigen::Index first = std::clamp<Eigen::Index>(after - n_used / 2, 0, n - n_used);
    for (Eigen::Index j = first; j < first + n_used; ++j) {
      double weight = 1.0;
      for (Eigen::Index k = first; k < first + n_used; ++k) {
        if (k != j) weight *= (at[i] - axis[k]) / (axis[j] - axis[k]);
      }
      weights(i, j) = weight;
    }
  }
  return weights;
}

Predictor::Predictor(const Parameters& parameters, std::vector<ReferenceCurve>& curves)
    : parameters_(parameters), curves_(curves) {
  const scene::Scene scene = parameters.scene_at(parameters.start());
  std::vector<base::Diagnostic> errors;
  build::BuiltModel built;
  results::MemoryRecorder recorder;
  if (any_of_kind(curves, AxisKind::time) || any_of_kind(curves, AxisKind::load)) {
    built = build::build_model(scene);
    const std::string why = why_not_differentiable(scene, built);
    if (!why.empty()) throw base::InputError({scene::error_at(scene.origin, why)});
    require_size_in_memory(scene, built);
    declare(scene, built, recorder);
  }
  for (ReferenceCurve& curve : curves) {
    if (curve.axis == AxisKind::stretch) {
      check_material(scene, curve, errors);
      continue;
    }
    const std::size_t n_errors = errors.size();
    check_recorded(scene, built, recorder.declared(), curve, errors);
    if (errors.size() > n_errors) continue;
    if (curve.axis == AxisKind::time) {
      cut(curve, 0.0, static_cast<double>(scene.dynamics->n_steps()) * scene.dynamics->step, errors);
    } else {
      const bool swept = scene.statics->control.has_value();
      cut(curve, swept ? scene.statics->from : 0.0, swept ? *scene.statics->to : 1.0, errors);
    }
  }
  if (!errors.empty()) throw base::InputError(std::move(errors));
}

Outcome Predictor::predict(const Eigen::VectorXd& theta, bool with_slopes, std::vector<PredictedCurve>& out) const {
  std::vector<std::vector<Variant>> variants;
  if (with_slopes) {
    for (std::size_t k = 0; k < parameters_.size(); ++k) variants.push_back(parameters_.variants(theta, k));
  }
  out.assign(curves_.size(), {});
  for (const AxisKind kind : {AxisKind::stretch, AxisKind::load, AxisKind::time}) {
    if (!any_of_kind(curves_, kind)) continue;
    Outcome outcome = predict_group(kind, theta, variants, out);
    if (!outcome.completed()) return outcome;
  }
  return {};
}

Outcome Predictor::predict_group(AxisKind kind, const Eigen::VectorXd& theta,
                                 const std::vector<std::vector<Variant>>& variants,
                                 std::vector<PredictedCurve>& out) const {
  const scene::Scene scene = parameters_.scene_at(theta);
  if (kind == AxisKind::stretch) {
    for (std::size_t i = 0; i < curves_.size(); ++i) {
      if (curves_[i].axis != kind) continue;
      out[i].values = permittivities(scene, curves_[i]);
      for (const std::vector<Variant>& of : variants) {
        out[i].slopes.emplace_back(derivative(std::span<const Variant>(of), [&](const Variant& variant, std::size_t) {
          return permittivities(variant.scene, curves_[i]);
        }));
      }
    }
    return {};
  }
  const build::BuiltModel built = build::build_model(scene);
  results::MemoryRecorder recorder;
  declare(scene, built, recorder);
  std::vector<RecordedColumn> columns;
  for (const ReferenceCurve& curve : curves_) {
    if (curve.axis != kind) continue;
    const std::vector<RecordedColumn> own = columns_of(recorder.declared(), curve);
    columns.insert(columns.end(), own.begin(), own.end());
  }
  Eigen::VectorXd axis;
  Eigen::MatrixXd values;
  std::vector<Eigen::MatrixXd> slopes;
  if (kind == AxisKind::time) {
    Motion motion;
    Outcome outcome = simulate(scene, built, motion);
    if (!outcome.completed()) return outcome;
    const auto n = static_cast<Eigen::Index>(motion.path.x.size());
    axis = Eigen::VectorXd::LinSpaced(n, 0.0, static_cast<double>(n - 1)) * motion.path.step;
    values = observe(scene, built, motion.path, columns);
    if (!variants.empty()) slopes = sensitivities(scene, built, motion, variants, columns);
  } else {
    std::vector<EquilibriumPoint> points;
    Outcome outcome = find_equilibria(scene, built, points);
    if (!outcome.completed()) return outcome;
    axis.resize(static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) axis[static_cast<Eigen::Index>(i)] = points[i].load;
    values = observe_equilibria(scene, built, points, columns);
    if (!variants.empty()) slopes = equilibrium_sensitivities(scene, built, points, variants, columns);
  }
  Eigen::Index column = 0;
  for (std::size_t i = 0; i < curves_.size(); ++i) {
    if (curves_[i].axis != kind) continue;
    const Eigen::MatrixXd weights = interpolation(axis, curves_[i].at);
    const Eigen::Index width = curves_[i].values.cols();
    out[i].values = weights * values.middleCols(column, width);
    for (const Eigen::MatrixXd& slope : slopes) out[i].slopes.emplace_back(weights * slope.middleCols(column, width));
    column += width;
  }
  return {};
}

}  // namespace muldi::pipeline
