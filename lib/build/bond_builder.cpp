#include "build/bond_builder.hpp"

#include <algorithm>
#include <cmath>

namespace muldi::build {
namespace {

/// Weights of one and the same place that were found on two faces.
constexpr double same_weight = 1e-6;

}  // namespace

BondBuilder::BondBuilder(fem::SolidDescription& data, std::vector<const fem::Mesh*> meshes,
                         std::vector<base::Diagnostic>& errors)
    : data_(data),
      meshes_(std::move(meshes)),
      errors_(errors),
      parent_(static_cast<std::size_t>(data.X.size() / 3)),
      count_(parent_.size(), 1) {
  for (std::size_t node = 0; node < parent_.size(); ++node) parent_[node] = static_cast<int>(node);
}

int BondBuilder::root(int node) {
  while (parent_[static_cast<std::size_t>(node)] != node) node = parent_[static_cast<std::size_t>(node)];
  return node;
}

void BondBuilder::unite(int a, int b, const scene::Origin& origin) {
  const int low = std::min(root(a), root(b));
  const int high = std::max(root(a), root(b));
  origins_[low] = &origin;
  if (low == high) return;
  parent_[static_cast<std::size_t>(high)] = low;
  count_[static_cast<std::size_t>(low)] += count_[static_cast<std::size_t>(high)];
}

void BondBuilder::fix(int node, std::vector<int> to, std::vector<double> weights, const scene::Origin& origin) {
  Fixed fixed{.to = {}, .origin = &origin};
  for (std::size_t k = 0; k < to.size(); ++k) {
    if (std::abs(weights[k]) > no_weight) fixed.to[to[k]] += weights[k];
  }
  said_.emplace_back(node, std::move(fixed));
}

std::string BondBuilder::name_of(int node) const {
  std::size_t k = 0;
  while (node >= data_.members[k].first_node + data_.members[k].n_nodes) ++k;
  return fem::node_name(*meshes_[k], node - data_.members[k].first_node) + " of '" + data_.members[k].name + "'";
}

void BondBuilder::refuse(int node, const std::string& what) {
  const auto united = origins_.find(root(node));
  const scene::Origin& origin = united != origins_.end() ? *united->second : *fixed_.at(root(node)).origin;
  errors_.push_back(scene::error_at(origin, name_of(node) + " " + what));
}

const BondBuilder::Sum* BondBuilder::sum_of(int root) const {
  const auto found = sums_.find(root);
  return found == sums_.end() ? nullptr : &*found->second;
}

std::optional<BondBuilder::Sum> BondBuilder::resolve(int node) {
  const auto fixed = fixed_.find(node);
  if (fixed == fixed_.end()) return Sum{{node, 1.0}};
  const auto [at, is_new] = sums_.try_emplace(node, std::nullopt);
  if (!is_new) return at->second;
  Sum sum;
  for (const auto& [to, weight] : fixed->second.to) {
    const std::optional<Sum> part = resolve(to);
    if (!part) return std::nullopt;
    for (const auto& [end, share] : *part) sum[end] += weight * share;
  }
  return sums_[node] = sum;
}

bool BondBuilder::resolve() {
  for (auto& [node, said] : said_) {
    Fixed fixed{.to = {}, .origin = said.origin};
    double whole = 0.0;
    for (const auto& [to, weight] : said.to) whole += weight;
    for (const auto& [to, weight] : said.to) fixed.to[root(to)] += weight / whole;
    const int at = root(node);
    const auto [found, is_new] = fixed_.try_emplace(at, fixed);
    if (is_new) continue;
    bool alike = found->second.to.size() == fixed.to.size();
    for (const auto& [to, weight] : fixed.to) {
      const auto other = found->second.to.find(to);
      alike = alike && other != found->second.to.end() && std::abs(other->second - weight) < same_weight;
    }
    if (alike) continue;
    errors_.push_back(scene::error_at(
        *said.origin, name_of(node) + " is fixed to two places, which would hold these together: leave it out of one "
                                      "attachment, or make the meshes match there"));
    return false;
  }
  for (const auto& [node, fixed] : fixed_) {
    if (resolve(node)) continue;
    errors_.push_back(scene::error_at(*fixed.origin, name_of(node) +
                                                         " is fixed to nodes that are fixed to it in turn: attach one "
                                                         "of the solids to the other, not both to each other"));
    return false;
  }
  return true;
}

void BondBuilder::make_bonds() {
  for (int node = 0; node < static_cast<int>(parent_.size()); ++node) {
    const int stays = root(node);
    const Sum* sum = sum_of(stays);
    if (stays == node && sum == nullptr) continue;
    fem::Bond bond{.node = node};
    if (sum == nullptr) {
      bond.to = {stays};
      bond.weights = {1.0};
    } else {
      for (const auto& [to, weight] : *sum) {
        bond.to.push_back(to);
        bond.weights.push_back(weight);
      }
    }
    bond_of_node_[node] = static_cast<int>(data_.bonds.size());
    data_.bonds.push_back(std::move(bond));
  }
  find_dielectrics();
  for (fem::Bond& bond : data_.bonds) bond.potential = ties_potential(bond.node);
}

void BondBuilder::close_gaps() {
  for (const fem::Bond& bond : data_.bonds) {
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < bond.to.size(); ++k) {
      at += bond.weights[k] * data_.X.segment<3>(3 * static_cast<Eigen::Index>(bond.to[k]));
    }
    data_.X.segment<3>(3 * static_cast<Eigen::Index>(bond.node)) = at;
  }
}

void BondBuilder::find_dielectrics() {
  busy_.assign(parent_.size(), 0);
  for (std::size_t cell = 0; cell < data_.cells.size(); ++cell) {
    if (!data_.materials[static_cast<std::size_t>(data_.material_of_cell[cell])].electric) continue;
    for (const int node : data_.cells[cell]) busy_[static_cast<std::size_t>(node)] = 1;
  }
}

/// A dielectric on a face of something that is none keeps its potentials to itself, unless the nodes are the same.
bool BondBuilder::ties_potential(int node) {
  const Sum* sum = sum_of(root(node));
  if (sum == nullptr || !is_busy(node) || count_[static_cast<std::size_t>(root(node))] > 1) return true;
  return std::all_of(sum->begin(), sum->end(), [this](const auto& part) { return is_busy(part.first); });
}

void BondBuilder::finish() {
  if (!resolve()) return;
  give();
  make_bonds();
  hand_over_displacements();
  hand_over_ties();
  hand_over_potentials();
  hand_over_floating();
  close_gaps();
}

}  // namespace muldi::build
