#include "pipeline/node_rows.hpp"

#include <algorithm>

namespace muldi::pipeline {

namespace dim = base::dimension;

NodeRows::NodeRows(results::Recorder& recorder, const scene::Scene& scene, const build::BuiltModel& built, Kind kind,
                   std::size_t expected_rows)
    : recorder_(recorder),
      built_(built),
      kind_(kind),
      units_(scene.units),
      prefix_(kind == Kind::statics  ? "statics/"
              : kind == Kind::replay ? "replay/"
                                     : ""),
      record_every_(scene.record.every) {
  results::SeriesSpec axis{.axis = prefix_ + "time",
                           .unit = units_.unit_name(dim::time),
                           .doc = "time of the nodes",
                           .expected_rows = expected_rows};
  if (kind == Kind::statics) {
    const bool swept = scene.statics->control.has_value();
    axis.axis = "statics/load";
    axis.unit = swept ? units_.unit_name(scene.statics->unit) : "1";
    axis.doc = swept ? "value of the swept control" : "factor of all controls at t = 0";
  }
  series_ = recorder_.declare_series(axis);
  fields_.emplace(
      recorder, built, units_,
      FieldAxis{
          .prefix = prefix_, .name = kind == Kind::statics ? "load" : "times", .unit = axis.unit, .doc = axis.doc},
      expected_rows);
  declare_common();
  if (kind == Kind::statics) {
    declare_statics();
  } else {
    declare_dynamics();
  }
}

results::Channel NodeRows::declare(const std::string& path, results::Shape shape, base::Dimension unit,
                                   const std::string& doc) {
  return recorder_.declare_channel(
      series_, {.path = prefix_ + path, .shape = std::move(shape), .unit = units_.unit_name(unit), .doc = doc});
}

void NodeRows::declare_common() {
  std::size_t next = 0;
  for (const model::Observable& observable : built_.model->observables) {
    if (kind_ == Kind::statics && observable.of_motion) continue;
    recorded_.push_back(
        {&observable, declare(observable.path, observable.shape, observable.unit, observable.doc), next});
    next += observable.size();
  }
  observed_.assign(next, 0.0);
  for (std::size_t c = 0; c < built_.n_named_controls; ++c) {
    const model::Control& control = built_.model->controls[c];
    controls_.push_back(
        declare("controls/" + control.name, {}, control.unit, "value over the interval that ends here"));
  }
  for (const std::string& part : built_.model->parts()) {
    parts_.push_back(
        declare("energy/parts/" + part, {4}, dim::energy, "kinetic, elastic, electric (enthalpy) and gravity energy"));
  }
  channel_.elastic = declare("energy/elastic", {}, dim::energy, "elastic energy");
  channel_.electric = declare("energy/electric", {}, dim::energy, "electric enthalpy -1/2 C U^2, sources included");
  channel_.gravity = declare("energy/gravity", {}, dim::energy, "potential energy in gravity");
  channel_.total = declare("energy/total", {}, dim::energy, "sum of the energies");
  channel_.residual = declare("solver/residual", {}, dim::none, "residual over its largest term");
  channel_.violation =
      declare("solver/constraint_violation", {}, dim::none, "largest violation of a constraint, gaps over scene size");
  channel_.iterations = recorder_.declare_channel(series_, {.path = prefix_ + "solver/iterations",
                                                            .unit = "1",
                                                            .doc = "Newton iterations",
                                                            .type = results::ValueType::int64});
}

void NodeRows::declare_dynamics() {
  channel_.kinetic = declare("energy/kinetic", {}, dim::energy, "kinetic energy");
  channel_.electric_after =
      declare("energy/electric_after", {}, dim::energy, "electric enthalpy under the controls of the next interval");
  channel_.dissipated = declare("energy/dissipated", {}, dim::energy, "energy dissipated since t = 0");
  channel_.external =
      declare("energy/external", {}, dim::energy, "work of loads, drives and prescribed motions since t = 0");
  channel_.source = declare("energy/source", {}, dim::energy, "work of changes of the controls since t = 0");
  channel_.balance = declare("energy/balance", {}, dim::energy,
                             "total + dissipated - external - source, less its value at t = 0; zero for dt to 0");
  channel_.linear = declare("momentum/linear", {3}, dim::momentum, "linear momentum of the system");
  channel_.angular = declare("momentum/angular", {3}, dim::momentum * dim::length, "angular momentum about the origin");
  channel_.factorisations = recorder_.declare_channel(series_, {.path = prefix_ + "solver/factorisations",
                                                                .unit = "1",
                                                                .doc = "factorisations of the step that ends here",
                                                                .type = results::ValueType::int64});
}

void NodeRows::declare_statics() {
  channel_.stable = recorder_.declare_channel(series_, {.path = "statics/stable",
                                                        .unit = "1",
                                                        .doc = "1 where the equilibrium is stable",
                                                        .type = results::ValueType::int64});
}

void NodeRows::write_common(const model::NodeView& view, std::span<const model::Energy> parts) {
  for (const Recorded& recorded : recorded_) {
    const std::span<double> out(observed_.data() + recorded.first, recorded.observable->size());
    recorded.observable->evaluate(view, out);
    recorder_.append(recorded.channel, std::span<const double>(out));
  }
  for (std::size_t c = 0; c < controls_.size(); ++c) recorder_.append(controls_[c], view.u[c]);
  model::Energy total;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double row[4] = {parts[i].kinetic, parts[i].elastic, parts[i].electric, parts[i].gravity};
    recorder_.append(parts_[i], std::span<const double>(row));
    total += parts[i];
  }
  recorder_.append(channel_.elastic, total.elastic);
  recorder_.append(channel_.electric, total.electric);
  recorder_.append(channel_.gravity, total.gravity);
  recorder_.append(channel_.total, total.kinetic + total.potential());
  if (kind_ != Kind::statics) recorder_.append(channel_.kinetic, total.kinetic);
}

void NodeRows::write(const variational::NodeRecord& node) {
  model::NodeView view = variational::view_of(node);
  view.serial = serial_++;
  write_common(view, node.values.parts);
  const double total = node.values.total.kinetic + node.values.total.potential();
  const variational::Ledger& ledger = node.ledger;
  recorder_.append(channel_.electric_after, node.values.electric_after);
  recorder_.append(channel_.dissipated, ledger.dissipated);
  recorder_.append(channel_.external, ledger.external);
  recorder_.append(channel_.source, ledger.source);
  recorder_.append(channel_.balance,
                   total - ledger.initial_total + ledger.dissipated - ledger.external - ledger.source);
  recorder_.append(channel_.linear, std::span<const double>(node.values.linear_momentum.data(), 3));
  recorder_.append(channel_.angular, std::span<const double>(node.values.angular_momentum.data(), 3));
  recorder_.append(channel_.residual, node.report.residual);
  recorder_.append(channel_.violation, std::max(built_.manifold->violation(node.state.q), node.report.violation));
  recorder_.append(channel_.iterations, node.report.iterations);
  recorder_.append(channel_.factorisations, node.report.factorisations);
  fields_->write(view, node.t, node.step / record_every_, node.last);
  recorder_.append(series_.axis, node.t);
}

void NodeRows::write(const Equilibrium& equilibrium, const model::NodeView& at) {
  model::NodeView view = at;
  view.serial = serial_++;
  fields_->write(view, equilibrium.load, view.serial, equilibrium.last);
  write_common(view, equilibrium.parts);
  recorder_.append(channel_.residual, equilibrium.residual);
  recorder_.append(channel_.violation, equilibrium.violation);
  recorder_.append(channel_.iterations, equilibrium.iterations);
  recorder_.append(channel_.stable, equilibrium.stable ? 1 : 0);
  recorder_.append(series_.axis, equilibrium.load);
}

}  // namespace muldi::pipeline
