/// What is prescribed on bonded nodes goes to the nodes that they are fixed to, or is what holds there already.
#include <algorithm>
#include <cmath>
#include <set>

#include "build/bond_builder.hpp"

namespace muldi::build {
namespace {

bool same(const fem::Value& a, const fem::Value& b) {
  return a.control == b.control && a.constant == b.constant && a.factor == b.factor;
}

constexpr const char* differently = ", and the nodes that are one with it are held differently: ";

}  // namespace

bool BondBuilder::agree(int node, const std::vector<int>& to, const std::vector<double>& weights) {
  if (!given_) {
    given_.emplace();
    for (const fem::PrescribedDisplacement& said : data_.displacements) {
      (*given_)[said.node][said.component] = said.value;
    }
    for (const fem::PrescribedPotential& said : data_.potentials) (*given_)[said.node][3] = said.value;
    for (const fem::Tie& tie : data_.ties) {
      (*given_)[tie.node][4] = {.control = -2, .constant = static_cast<double>(tie.host)};
    }
  }
  const auto of_node = given_->find(node);
  if (of_node == given_->end()) return true;
  for (std::size_t k = 0; k < to.size(); ++k) {
    if (std::abs(weights[k]) <= no_weight) continue;
    const auto of_other = given_->find(to[k]);
    if (of_other == given_->end()) return false;
    for (const auto& [unknown, value] : of_node->second) {
      const auto found = of_other->second.find(unknown);
      if (found == of_other->second.end() || !same(found->second, value)) return false;
    }
  }
  return true;
}

void BondBuilder::give() {
  data_.given.assign(parent_.size(), 0);
  const auto give = [this](int node, int unknown) {
    data_.given[static_cast<std::size_t>(node)] |= static_cast<std::uint8_t>(1U << unknown);
  };
  for (const fem::PrescribedDisplacement& said : data_.displacements) give(said.node, said.component);
  for (const fem::Tie& tie : data_.ties) {
    for (int i = 0; i < 3; ++i) give(tie.node, i);
  }
  for (const fem::Electrode& electrode : data_.electrodes) {
    for (const int node : electrode.nodes) give(node, 3);
  }
}

void BondBuilder::hand_over_displacements() {
  static const char* const axes[] = {"x", "y", "z"};
  std::map<std::pair<int, int>, fem::Value> values;
  for (const fem::PrescribedDisplacement& said : data_.displacements) {
    const auto [at, is_new] = values.try_emplace({root(said.node), said.component}, said.value);
    if (is_new || same(at->second, said.value)) continue;
    return refuse(said.node, std::string("has a prescribed displacement along ") + axes[said.component] + differently +
                                 "prescribe the same on both sides of the joint, or on one");
  }
  std::vector<fem::PrescribedDisplacement> kept;
  for (const auto& [where, value] : values) {
    const auto& [node, component] = where;
    const Sum* sum = sum_of(node);
    if (sum == nullptr) {
      kept.push_back({node, component, value});
      continue;
    }
    for (const auto& [to, weight] : *sum) {
      const auto other = values.find({to, component});
      if (other != values.end() && same(other->second, value)) continue;
      return refuse(node, std::string("has a prescribed displacement along ") + axes[component] +
                              ", but lies between nodes of another solid, to which it is fixed: prescribe the same on "
                              "that solid, at " +
                              name_of(to) + " and its neighbours");
    }
  }
  data_.displacements = std::move(kept);
}

void BondBuilder::hand_over_ties() {
  std::set<int> held;
  for (const fem::PrescribedDisplacement& said : data_.displacements) held.insert(said.node);
  std::map<int, fem::Tie> ties;
  for (const fem::Tie& tie : data_.ties) {
    const std::string& body = data_.hosts[static_cast<std::size_t>(tie.host)].name;
    const auto [at, is_new] = ties.try_emplace(root(tie.node), tie);
    if (!is_new && at->second.host != tie.host) {
      return refuse(tie.node, "is fixed to '" + body + "'" + differently + "fix both sides of the joint to one body");
    }
    if (held.count(root(tie.node)) == 0) continue;
    return refuse(tie.node, "is fixed to '" + body + "'" + differently + "their displacements are prescribed");
  }
  std::vector<fem::Tie> kept;
  for (const auto& [node, tie] : ties) {
    const Sum* sum = sum_of(node);
    if (sum == nullptr) {
      kept.push_back({.node = node, .host = tie.host, .xi = tie.xi});
      // By less than the tolerance of matching nodes.
      data_.X.segment<3>(3 * static_cast<Eigen::Index>(node)) =
          data_.X.segment<3>(3 * static_cast<Eigen::Index>(tie.node)).eval();
      continue;
    }
    for (const auto& [to, weight] : *sum) {
      const auto other = ties.find(to);
      if (other != ties.end() && other->second.host == tie.host) continue;
      return refuse(node, "is fixed to '" + data_.hosts[static_cast<std::size_t>(tie.host)].name +
                              "' and lies between nodes of another solid, to which it is fixed too: fix that solid to "
                              "the body as well, at " +
                              name_of(to) + " and its neighbours");
    }
  }
  data_.ties = std::move(kept);
}

void BondBuilder::hand_over_potentials() {
  std::map<int, fem::Value> values;
  std::vector<fem::PrescribedPotential> kept;
  for (const fem::PrescribedPotential& said : data_.potentials) {
    const auto bond = bond_of_node_.find(said.node);
    if (bond != bond_of_node_.end() && !bond_of(said.node).potential) {
      kept.push_back(said);
      continue;
    }
    const auto [at, is_new] = values.try_emplace(root(said.node), said.value);
    if (is_new || same(at->second, said.value)) continue;
    return refuse(said.node,
                  "has a prescribed potential, and the nodes that are one with it have another: one electrode cannot "
                  "have two potentials; prescribe it once, or put an insulator between");
  }
  for (const auto& [node, value] : values) {
    const Sum* sum = sum_of(node);
    if (sum == nullptr) {
      kept.push_back({node, value});
      continue;
    }
    for (const auto& [to, weight] : *sum) {
      const auto other = values.find(to);
      if (other != values.end() && same(other->second, value)) continue;
      return refuse(node,
                    "has a prescribed potential, but lies between nodes of another dielectric, to which it is fixed: "
                    "prescribe the same on that solid, at " +
                        name_of(to) + " and its neighbours");
    }
  }
  data_.potentials = std::move(kept);
}

void BondBuilder::hand_over_floating() {
  std::map<int, std::size_t> electrode_of;
  for (const fem::PrescribedPotential& said : data_.potentials) electrode_of[said.node] = data_.floating.size();
  for (std::size_t k = 0; k < data_.floating.size(); ++k) {
    fem::FloatingElectrode& electrode = data_.floating[k];
    std::vector<int> stay;
    for (const int node : electrode.nodes) {
      const int at = root(node);
      if (sum_of(at) != nullptr && bond_of(node).potential) {
        return refuse(node, "of floating electrode '" + electrode.name +
                                "' lies between nodes of another dielectric, to which it is fixed: make the meshes "
                                "match there, or give that solid the electrode");
      }
      const int free = sum_of(at) != nullptr ? node : at;
      const auto [found, is_new] = electrode_of.try_emplace(free, k);
      if (found->second != k) {
        return refuse(node, "of floating electrode '" + electrode.name +
                                "' is one with nodes of another electrode: give the joint one electrode");
      }
      if (is_new) stay.push_back(free);
      data_.given[static_cast<std::size_t>(free)] |= std::uint8_t{1} << 3;
    }
    electrode.nodes = std::move(stay);
  }
}

}  // namespace muldi::build
