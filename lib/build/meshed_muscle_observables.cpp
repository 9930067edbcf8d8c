#include "build/meshed_muscle_observables.hpp"

#include <memory>

#include "build/build_ties.hpp"

namespace muldi::build {
namespace {

namespace dim = base::dimension;
using model::NodeView;

/// Values of one muscle at a node in time.
class MuscleAt {
 public:
  explicit MuscleAt(MeshedMuscleRecord record) : record_(std::move(record)) {}

  double length(const NodeView& at) const { return line(at).norm(); }
  double stretch(const NodeView& at) const { return length(at) / record_.length; }
  double force(const NodeView& at) const {
    const Eigen::Vector3d along = line(at).normalized();
    const fem::Solid& solid = record_.records.solid();
    const Eigen::Vector3d on_from = wrench_on(solid, record_.at_from, at).force;
    const Eigen::Vector3d on_to = wrench_on(solid, record_.at_to, at).force;
    return 0.5 * along.dot(on_from - on_to);
  }
  double field(const NodeView& at) const { return record_.input.value(at.u); }
  double true_field(const NodeView& at) const { return field(at) / stretch(at); }
  double layer_voltage(const NodeView& at) const { return field(at) * *record_.layer_thickness; }
  double charge(const NodeView& at) const {
    return record_.driven.empty() ? 0.0 : record_.records.charge(record_.driven, at) / record_.layers;
  }
  /// The cells are as many layers in parallel, of the voltage of their own thickness.
  double capacitance(const NodeView& at) const {
    const fem::Solid& solid = record_.records.solid();
    const double of_cells = solid.capacitance(solid.positions(at.q), record_.driven, false) / record_.layers;
    return of_cells * cell_thickness() / *record_.layer_thickness;
  }
  model::TerminalValues terminal(const NodeView& at) const {
    return {.potential = field(at) * cell_thickness(), .charge = record_.records.charge(record_.driven, at)};
  }

 private:
  double cell_thickness() const { return record_.length / record_.layers; }
  Eigen::Vector3d line(const NodeView& at) const { return record_.to.value(at.q) - record_.from.value(at.q); }

  MeshedMuscleRecord record_;
};

}  // namespace

void add_muscle_observables(MeshedMuscleRecord record, model::Model& model) {
  const std::string name = record.name;
  const std::string folder = "muscles/" + name + "/";
  const bool has_layers = record.layer_thickness.has_value();
  const bool is_driven = !record.driven.empty();
  const model::ElectricRecord wanted = record.wanted;
  const auto muscle = std::make_shared<const MuscleAt>(std::move(record));
  const auto add = [&](const char* what, base::Dimension unit, const char* doc,
                       double (MuscleAt::*value)(const NodeView&) const) {
    model.observables.push_back(
        {.path = folder + what,
         .shape = {},
         .unit = unit,
         .doc = doc,
         .evaluate = [muscle, value](const NodeView& at, std::span<double> out) { out[0] = ((*muscle).*value)(at); }});
  };
  add("length", dim::length, "distance of the ends", &MuscleAt::length);
  add("force", dim::force, "force with which the muscle pulls its ends together", &MuscleAt::force);
  add("stretch", dim::none, "length over reference length", &MuscleAt::stretch);
  add("field", dim::field, "nominal field: voltage over reference length", &MuscleAt::field);
  add("true_field", dim::field, "field in the deformed muscle, its mean along the line of the ends",
      &MuscleAt::true_field);
  if (has_layers) {
    add("layer_voltage", dim::voltage, "voltage of one layer", &MuscleAt::layer_voltage);
    add("charge", dim::charge, "charge on one layer", &MuscleAt::charge);
  }
  if (!is_driven || !wanted.any()) return;
  if (has_layers && wanted.capacitance) {
    add("capacitance", dim::capacitance, "charge a voltage of one layer at this shape", &MuscleAt::capacitance);
  }
  model::add_terminal("muscles/" + name, {.values = [muscle](const NodeView& at) { return muscle->terminal(at); }},
                      wanted, model);
}

}  // namespace muldi::build
