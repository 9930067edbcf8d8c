/// What is recorded of the conductors of a solid beside their charges: capacitances, energies of their sources.
#include <algorithm>

#include "fem/solid/solid_observables.hpp"

namespace muldi::fem {
namespace {

bool same(const Value& a, const Value& b) {
  return a.control == b.control && a.factor == b.factor && a.constant == b.constant;
}

/// Nodes of one prescribed potential that belong to no electrode.
struct Unnamed {
  Value value;
  std::vector<int> nodes;
};

/// Those of potential zero are left out: no work is done on their charges.
std::vector<Unnamed> unnamed_conductors(const SolidDescription& data, const Member& member) {
  std::vector<char> named(static_cast<std::size_t>(data.X.size() / 3), 0);
  for (const Electrode& electrode : data.electrodes) {
    for (const int node : electrode.nodes) named[static_cast<std::size_t>(node)] = 1;
  }
  std::vector<Unnamed> found;
  for (const PrescribedPotential& said : data.potentials) {
    char& is_taken = named[static_cast<std::size_t>(said.node)];
    const bool is_own = said.node >= member.first_node && said.node < member.first_node + member.n_nodes;
    if (!is_own || is_taken != 0 || said.value.is_zero()) continue;
    is_taken = 1;
    auto one = std::find_if(found.begin(), found.end(), [&](const Unnamed& at) { return same(at.value, said.value); });
    if (one == found.end()) one = found.insert(found.end(), {said.value, {}});
    one->nodes.push_back(said.node);
  }
  return found;
}

}  // namespace

model::Terminal SolidRecords::terminal_of(const std::vector<int>& nodes) const {
  return {.values = [this, nodes](const model::NodeView& at) {
    return model::TerminalValues{.potential = potentials(at)[nodes.front()], .charge = charge(nodes, at)};
  }};
}

model::Terminal SolidRecords::terminal_of(const FloatingElectrode& electrode) const {
  return {.gives_charge = true, .values = [this, &electrode](const model::NodeView& at) {
            return model::TerminalValues{.potential = potentials(at)[electrode.nodes.front()],
                                         .charge = electrode.charge.at(at.u)};
          }};
}

model::Terminal SolidRecords::terminal_of(const SurfaceCharge& charge) const {
  // What is put on a node of given potential is counted there.
  WeightedNodes where;
  for (std::size_t k = 0; k < charge.nodes.size(); ++k) {
    const Bonds::Terms stays = solid_.bonds().terms(charge.nodes[k]);
    bool given = true;
    for (std::size_t i = 0; i < stays.nodes.size(); ++i) {
      if (stays.of_potential[i] == 0.0) continue;
      given &= std::any_of(solid_.data().potentials.begin(), solid_.data().potentials.end(),
                           [&](const PrescribedPotential& said) { return said.node == stays.nodes[i]; });
    }
    if (given) continue;
    where.nodes.push_back(charge.nodes[k]);
    where.weights.push_back(charge.unit[k]);
  }
  return {.gives_charge = true, .values = [this, where, value = charge.value](const model::NodeView& at) {
            return model::TerminalValues{.potential = potential(where, at), .charge = value.at(at.u)};
          }};
}

void SolidRecords::add_electric(const model::ElectricRecord& wanted, model::Model& model) const {
  const SolidDescription& data = solid_.data();
  const auto add = [&](const auto& electrode, bool floats, model::Terminal terminal) {
    if (!owns(electrode)) return;
    const std::string folder = "electrodes/" + member().name + "." + electrode.name;
    if (wanted.capacitance) {
      model.observables.push_back(
          {.path = folder + "/capacitance",
           .shape = {},
           .unit = base::dimension::capacitance,
           .doc = "charge a potential of the electrode at this shape, other given potentials and charges held",
           .evaluate = [this, &electrode, floats](const model::NodeView& at, std::span<double> out) {
             out[0] = solid_.capacitance(solid_.positions(at.q), electrode.nodes, floats);
           }});
    }
    model::add_terminal(folder, std::move(terminal), wanted, model);
  };
  for (const Electrode& electrode : data.electrodes) add(electrode, false, terminal_of(electrode.nodes));
  for (const FloatingElectrode& electrode : data.floating) add(electrode, true, terminal_of(electrode));
  for (const Unnamed& conductor : unnamed_conductors(data, member())) {
    model::add_terminal("", terminal_of(conductor.nodes), wanted, model);
  }
  for (const SurfaceCharge& charge : data.surface_charges) {
    if (!owns(charge)) continue;
    model::add_terminal("", terminal_of(charge), wanted, model);
  }
}

}  // namespace muldi::fem
