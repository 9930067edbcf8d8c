#include "muscles/muscle_observables.hpp"

#include <functional>
#include <span>
#include <string>
#include <tuple>
#include <utility>

namespace muldi::muscles {
namespace {

/// Length, rate and field at a node in time.
struct AxialState {
  double z = 0.0;
  double zd = 0.0;
  double field = 0.0;
};

using StateAt = std::function<AxialState(const model::NodeView&)>;
using Value = std::function<double(const AxialState&)>;

model::Observable scalar(std::string path, base::Dimension unit, std::string doc, StateAt state, Value value) {
  return {.path = std::move(path),
          .shape = {},
          .unit = unit,
          .doc = std::move(doc),
          .evaluate = [state = std::move(state), value = std::move(value)](
                          const model::NodeView& at, std::span<double> out) { out[0] = value(state(at)); }};
}

std::vector<model::Observable> of_muscle(const std::string& name, const LumpedDea& element, const StateAt& state,
                                         std::optional<double> layer_thickness) {
  namespace dimension = base::dimension;
  const std::string folder = "muscles/" + name + "/";
  std::vector<model::Observable> list;
  const auto add = [&](const char* what, base::Dimension unit, const char* doc, Value value) {
    list.push_back(scalar(folder + what, unit, doc, state, std::move(value)));
  };
  add("length", dimension::length, "distance of the ends", [](const AxialState& s) { return s.z; });
  add("stretch", dimension::none, "length over reference length",
      [element](const AxialState& s) { return s.z / element.length; });
  add("force", dimension::force, "force with which the muscle pulls its ends together",
      [element](const AxialState& s) { return element.pull(s.z, s.zd, s.field); });
  add("field", dimension::field, "nominal field: voltage over reference length",
      [](const AxialState& s) { return s.field; });
  add("true_field", dimension::field, "field in the deformed muscle",
      [element](const AxialState& s) { return element.true_field(s.z, s.field); });
  if (layer_thickness) {
    add("layer_voltage", dimension::voltage, "voltage of one layer",
        [t = *layer_thickness](const AxialState& s) { return s.field * t; });
    add("charge", dimension::charge, "charge on one layer",
        [element](const AxialState& s) { return element.layer_charge(s.z, s.field); });
  }
  return list;
}

template <class Component>
StateAt ends_of(const Component& component) {
  return [component](const model::NodeView& at) {
    const auto x = component.state(at.q, at.v, at.u);
    const Line line(x);
    AxialState state{.z = line.z, .zd = line.zd};
    if constexpr (std::tuple_size_v < decltype(x.e) >> 0) state.field = x.e[0];
    return state;
  };
}

}  // namespace

std::vector<model::Observable> muscle_observables(const TwoPointComponent<LumpedDea>& muscle,
                                                  std::optional<double> layer_thickness) {
  return of_muscle(muscle.name, muscle.element, ends_of(muscle), layer_thickness);
}

std::vector<model::Observable> muscle_observables(const FreeActuator& actuator, std::optional<double> layer_thickness) {
  const StateAt state = [actuator](const model::NodeView& at) {
    return AxialState{.z = at.q[actuator.dof], .zd = at.v[actuator.dof], .field = actuator.field.value(at.u)};
  };
  return of_muscle(actuator.name, actuator.element, state, layer_thickness);
}

std::vector<model::Observable> spring_observables(const TwoPointComponent<Spring>& spring) {
  const std::string folder = "springs/" + spring.name + "/";
  const StateAt state = ends_of(spring);
  return {scalar(folder + "length", base::dimension::length, "distance of the ends", state,
                 [](const AxialState& s) { return s.z; }),
          scalar(folder + "force", base::dimension::force, "force with which the spring pulls its ends together", state,
                 [element = spring.element](const AxialState& s) { return element.pull(s.z, s.zd); })};
}

}  // namespace muldi::muscles
