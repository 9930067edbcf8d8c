#pragma once
/// What is recorded of muscles and springs (scene-format, section 4).
///
/// <folder>/<name>/length and force (> 0 pulls, damping included) of every element, and what the element itself adds:
///
///     template <class Add>
///     void observe(Add add) const {
///       add("stretch", base::dimension::none, "length over reference length",
///           [*this](const AxialState<n_controls>& at) { return at.z / length; });
///     }
#include <concepts>
#include <string>
#include <string_view>
#include <vector>

#include "model/observable.hpp"
#include "model/supply.hpp"
#include "muscles/free_actuator_term.hpp"
#include "muscles/two_point_term.hpp"

namespace muldi::muscles {

/// `state` and `pull` give the AxialState and the force at a NodeView; all are copied.
template <TwoPointElement Element, class StateAt, class PullAt>
std::vector<model::Observable> element_observables(const std::string& name, const Element& element,
                                                   const StateAt& state, const PullAt& pull) {
  const std::string folder = std::string(Element::folder) + "/" + name + "/";
  std::vector<model::Observable> list;
  const auto scalar = [&](std::string_view what, base::Dimension unit, const std::string& doc, const auto& value_at) {
    list.push_back(
        {.path = folder + std::string(what),
         .shape = {},
         .unit = unit,
         .doc = doc,
         .evaluate = [value_at](const model::NodeView& at, std::span<double> out) { out[0] = value_at(at); }});
  };
  const auto add = [&](std::string_view what, base::Dimension unit, std::string_view doc, auto value) {
    scalar(what, unit, std::string(doc), [state, value](const model::NodeView& at) { return value(state(at)); });
  };
  add("length", base::dimension::length, "distance of the ends", [](const auto& at) { return at.z; });
  scalar("force", base::dimension::force,
         "force with which the " + std::string(Element::noun) + " pulls its ends together", pull);
  if constexpr (requires { element.observe(add); }) element.observe(add);
  return list;
}

/// The AxialState of a component at a NodeView.
template <TwoPointElement Element>
auto state_at(const TwoPointComponent<Element>& component) {
  return [component](const model::NodeView& at) {
    const auto x = component.state(at.q, at.v, at.u);
    const Line line(x);
    return AxialState<Element::n_controls>{line.z, line.zd, x.e};
  };
}
template <TwoPointElement Element>
auto state_at(const FreeActuator<Element>& actuator) {
  return [actuator](const model::NodeView& at) { return actuator.state(at.q, at.v, at.u); };
}

template <TwoPointElement Element>
std::vector<model::Observable> observables_of(const TwoPointComponent<Element>& component) {
  const auto force = [component](const model::NodeView& at) {
    return pull(component.element, component.state(at.q, at.v, at.u));
  };
  return element_observables(component.name, component.element, state_at(component), force);
}

template <TwoPointElement Element>
std::vector<model::Observable> observables_of(const FreeActuator<Element>& actuator) {
  const auto force = [actuator](const model::NodeView& at) {
    return pull(Isolated<Element>{actuator.element}, actuator.state(at.q, at.v, at.u));
  };
  return element_observables(actuator.name, actuator.element, state_at(actuator), force);
}

/// An element that is a capacitor, driven by its nominal field.
template <class E>
concept Capacitor = E::n_controls == 1 && requires(const E& element) {
  { element.layer_charge(1.0, 1.0) } -> std::convertible_to<double>;
  { element.layer_capacitance(1.0, 1.0) } -> std::convertible_to<double>;
  { element.length } -> std::convertible_to<double>;
};

/// Gives the model what is wanted of a component that is a capacitor: <folder>/<name>/capacitance of one layer, where
/// the thickness of the layers is known, and the energies of all of them. They are one capacitor under the voltage of
/// the whole length with the charge of a single layer (numerics, 1.10).
template <class Component>
void add_electric(const Component& component, const model::ElectricRecord& wanted, model::Model& model) {
  using Element = decltype(component.element);
  if constexpr (Capacitor<Element>) {
    const std::string folder = std::string(Element::folder) + "/" + component.name;
    const auto state = state_at(component);
    const Element element = component.element;
    if (wanted.capacitance && element.layer_thickness) {
      model.observables.push_back({.path = folder + "/capacitance",
                                   .shape = {},
                                   .unit = base::dimension::capacitance,
                                   .doc = "charge a voltage of one layer at this shape",
                                   .evaluate = [state, element](const model::NodeView& at, std::span<double> out) {
                                     out[0] = element.layer_capacitance(state(at).z, *element.layer_thickness);
                                   }});
    }
    model::add_terminal(folder,
                        {.values =
                             [state, element](const model::NodeView& at) {
                               const auto now = state(at);
                               return model::TerminalValues{.potential = element.length * now.e[0],
                                                            .charge = element.layer_charge(now.z, now.e[0])};
                             }},
                        wanted, model);
  }
}

}  // namespace muldi::muscles
