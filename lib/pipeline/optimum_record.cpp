#include "pipeline/optimum_record.hpp"

#include "base/text.hpp"

namespace muldi::pipeline {
namespace {

std::string folder_of(int stage) { return base::format("optimum/{}", stage + 1); }

std::string shown(const std::vector<control::ActiveBound>& active) {
  std::vector<std::string> lines;
  for (const control::ActiveBound& bound : active) {
    std::vector<std::string> nodes;
    for (const int node : bound.nodes) nodes.push_back(base::format("{}", node));
    lines.push_back(base::format("{} {}: {}", bound.name, bound.upper ? "upper" : "lower", base::joined(nodes, " ")));
  }
  return base::joined(lines, "\n");
}

}  // namespace

OptimumRecord::OptimumRecord(results::Recorder& recorder, const scene::Scene& scene)
    : recorder_(recorder), scene_(scene) {
  const std::size_t n_stages = scene.optimal_control->stages.size();
  stages_.reserve(n_stages);
  for (std::size_t i = 0; i < n_stages; ++i) {
    const std::string folder = folder_of(static_cast<int>(i)) + "/iterates/";
    Channels channels;
    channels.series =
        recorder.declare_series({.axis = folder + "iteration", .unit = "1", .doc = "iteration", .expected_rows = 64});
    const auto declare = [&](const char* name, const char* doc, results::ValueType type) {
      return recorder.declare_channel(channels.series, {.path = folder + name, .unit = "1", .doc = doc, .type = type});
    };
    const auto real = [&](const char* name, const char* doc) {
      return declare(name, doc, results::ValueType::float64);
    };
    channels.start = declare("start", "which guess, from 0", results::ValueType::int64);
    channels.restoration =
        declare("restoration", "1 where the solver works on the infeasibility alone", results::ValueType::int64);
    channels.objective = real("objective", "weighted sum of the objectives");
    channels.infeasibility = real("infeasibility", "largest scaled violation of a constraint");
    channels.dual_infeasibility = real("dual_infeasibility", "violation of the scaled optimality conditions");
    channels.barrier = real("barrier", "barrier parameter");
    channels.step_size = real("step_size", "largest component of the step");
    channels.primal_step = real("primal_step", "part of the step that is taken, unknowns");
    channels.dual_step = real("dual_step", "part of the step that is taken, multipliers");
    channels.regularisation = real("regularisation", "added to the diagonal of the Hessian");
    stages_.push_back(channels);
  }
}

void OptimumRecord::write(int stage, int start, const control::Iterate& iterate) {
  const Channels& to = stages_[static_cast<std::size_t>(stage)];
  recorder_.append(to.start, start);
  recorder_.append(to.restoration, iterate.restoration ? 1 : 0);
  recorder_.append(to.objective, iterate.objective);
  recorder_.append(to.infeasibility, iterate.infeasibility);
  recorder_.append(to.dual_infeasibility, iterate.dual_infeasibility);
  recorder_.append(to.barrier, iterate.barrier);
  recorder_.append(to.step_size, iterate.step_size);
  recorder_.append(to.primal_step, iterate.primal_step);
  recorder_.append(to.dual_step, iterate.dual_step);
  recorder_.append(to.regularisation, iterate.regularisation);
  recorder_.append(to.series.axis, iterate.iteration);
}

void OptimumRecord::write_scalar(const std::string& path, double value, const std::string& unit,
                                 const std::string& doc) {
  recorder_.declare_fixed({.path = path, .shape = {}, .unit = unit, .doc = doc}, std::span<const double>(&value, 1));
}

void OptimumRecord::write_end(int stage, const control::SolveResult& result, double sum_squared_field) {
  const std::string folder = folder_of(stage);
  write_scalar(folder + "/objective", result.objective, "1", "weighted sum of the objectives");
  write_scalar(folder + "/infeasibility", result.infeasibility, "1", "largest scaled violation of a constraint");
  if (!scene_.muscles.empty()) {
    write_scalar(folder + "/sum_squared_field", sum_squared_field, "(kV/mm)^2",
                 "squared nominal field, summed over intervals and muscles");
  }
  const auto set = [&](const char* name, results::AttributeValue value) {
    recorder_.set_attribute(folder, name, std::move(value));
  };
  const auto set_count = [&](const char* name, int value) { set(name, std::int64_t{value}); };
  set("status", control::name_of(result.status));
  set("sentence", result.sentence);
  set_count("iterations", result.iterations);
  set_count("n_variables", result.n_variables);
  set_count("n_constraints", result.n_constraints);
  set("worst_constraint", result.worst_constraint);
  set("worst_time", result.worst_time);
  set("worst_violation", result.worst_violation);
  set("active_bounds", shown(result.active));
  set("wall_time", result.times.total);
  set("wall_time.functions", result.times.functions);
  set("wall_time.hessian", result.times.hessian);
}

void OptimumRecord::write_trajectory(const build::BuiltModel& built, const control::Trajectory& trajectory) {
  const std::string folder = "optimum/trajectory/";
  const auto write_rows = [&](const std::string& path, const auto& rows, const char* doc) {
    const auto n_columns = static_cast<std::size_t>(rows.front().size());
    std::vector<double> values;
    values.reserve(rows.size() * n_columns);
    for (const auto& row : rows) values.insert(values.end(), row.data(), row.data() + n_columns);
    recorder_.declare_fixed({.path = folder + path, .shape = {rows.size(), n_columns}, .unit = "1", .doc = doc},
                            std::span<const double>(values));
  };
  write_scalar(folder + "step", trajectory.step, scene_.units.time(), "time step");
  write_rows("coordinates", trajectory.x, "coordinates of the joints at the nodes, in the order of the model");
  if (!built.model->controls.empty()) {
    write_rows("controls", trajectory.u, "controls of the intervals, in the order of the model");
  }
  if (!trajectory.multipliers.empty() && trajectory.multipliers.front().size() > 0) {
    write_rows("multipliers", trajectory.multipliers, "impulses of the loop-closing joints at the nodes");
  }
}

void OptimumRecord::write_starts(const std::vector<StartEnd>& starts) {
  std::vector<double> objectives;
  std::vector<double> fields;
  std::vector<std::int64_t> optimal;
  for (const StartEnd& start : starts) {
    objectives.push_back(start.objective);
    fields.push_back(start.sum_squared_field);
    optimal.push_back(start.optimal ? 1 : 0);
  }
  const results::Shape shape{starts.size()};
  const std::string folder = "optimum/starts/";
  recorder_.declare_fixed({.path = folder + "objective", .shape = shape, .unit = "1", .doc = "of each guess"},
                          std::span<const double>(objectives));
  recorder_.declare_fixed(
      {.path = folder + "sum_squared_field", .shape = shape, .unit = "(kV/mm)^2", .doc = "of each guess"},
      std::span<const double>(fields));
  recorder_.declare_fixed(
      {.path = folder + "optimal", .shape = shape, .unit = "1", .doc = "1 where the guess led to an optimum"},
      std::span<const std::int64_t>(optimal));
}

}  // namespace muldi::pipeline
