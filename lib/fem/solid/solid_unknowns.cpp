#include "fem/solid/solid_unknowns.hpp"

#include <algorithm>

namespace muldi::fem {

SolidUnknowns::SolidUnknowns(const SolidDescription& data)
    : data_(&data),
      mask_(static_cast<std::size_t>(data.X.size() / 3), 0),
      has_field_(!data.potentials.empty() || !data.floating.empty()) {
  const auto n_nodes = static_cast<int>(mask_.size());
  for (const PrescribedDisplacement& said : data.displacements) {
    mask_[static_cast<std::size_t>(said.node)] |= static_cast<std::uint8_t>(1U << said.component);
    moves_ |= said.value.control >= 0;
  }
  for (const Tie& tie : data.ties) mask_[static_cast<std::size_t>(tie.node)] |= std::uint8_t{0b111};
  for (const Bond& bond : data.bonds) mask_[static_cast<std::size_t>(bond.node)] |= std::uint8_t{0b111};
  for (int node = 0; node < n_nodes; ++node) {
    for (int i = 0; i < 3; ++i) {
      if (is_free(node, i)) {
        ++n_free_positions_;
      } else {
        fixed_positions_.push_back(3 * static_cast<Eigen::Index>(node) + i);
      }
    }
  }
  if (has_field_) {
    mask_idle_potentials();
    for (const PrescribedPotential& said : data.potentials) {
      mask_[static_cast<std::size_t>(said.node)] |= std::uint8_t{1} << potential_bit;
    }
    for (const Bond& bond : data.bonds) {
      if (bond.potential) mask_[static_cast<std::size_t>(bond.node)] |= std::uint8_t{1} << potential_bit;
    }
  } else {
    for (std::uint8_t& bits : mask_) bits |= std::uint8_t{1} << potential_bit;
  }
  std::vector<char> floats(mask_.size(), 0);
  for (const FloatingElectrode& electrode : data.floating) {
    for (const int node : electrode.nodes) {
      mask_[static_cast<std::size_t>(node)] |= std::uint8_t{1} << potential_bit;
      floats[static_cast<std::size_t>(node)] = 1;
    }
    ++n_free_potentials_;
  }
  for (int node = 0; node < n_nodes; ++node) {
    if (is_free(node, potential_bit)) {
      ++n_free_potentials_;
    } else if (floats[static_cast<std::size_t>(node)] == 0) {
      fixed_potentials_.push_back(node);
    }
  }
}

void SolidUnknowns::mask_idle_potentials() {
  // Nodes without a dielectric around them have no equation for the potential.
  std::vector<char> busy(mask_.size(), 0);
  for (std::size_t cell = 0; cell < data_->cells.size(); ++cell) {
    const Material& material = data_->materials[static_cast<std::size_t>(data_->material_of_cell[cell])];
    if (!material.electric) continue;
    for (const int node : data_->cells[cell]) busy[static_cast<std::size_t>(node)] = 1;
  }
  if (!data_->bonds.empty()) keep_fixed_fields(busy);
  for (std::size_t node = 0; node < mask_.size(); ++node) {
    if (busy[node] == 0) mask_[node] |= std::uint8_t{1} << potential_bit;
  }
}

void SolidUnknowns::keep_fixed_fields(std::vector<char>& busy) const {
  // Dielectrics that nothing connects to a given potential have no field; nor have bonded nodes an equation of their
  // own, what they are fixed to has it.
  for (const Bond& bond : data_->bonds) {
    if (!bond.potential || busy[static_cast<std::size_t>(bond.node)] == 0) continue;
    for (const int node : bond.to) busy[static_cast<std::size_t>(node)] = 1;
  }
  const std::vector<int> field = connected_fields(*data_);
  std::vector<char> fixed(busy.size(), 0);
  const auto fix = [&](int node) { fixed[static_cast<std::size_t>(field[static_cast<std::size_t>(node)])] = 1; };
  for (const PrescribedPotential& said : data_->potentials) fix(said.node);
  for (const FloatingElectrode& electrode : data_->floating) fix(electrode.nodes.front());
  for (std::size_t node = 0; node < busy.size(); ++node) {
    if (fixed[static_cast<std::size_t>(field[node])] == 0) busy[node] = 0;
  }
}

std::vector<int> connected_fields(const SolidDescription& data) {
  std::vector<int> field(static_cast<std::size_t>(data.X.size() / 3));
  for (std::size_t node = 0; node < field.size(); ++node) field[node] = static_cast<int>(node);
  const auto root = [&](int node) {
    while (field[static_cast<std::size_t>(node)] != node) {
      int& next = field[static_cast<std::size_t>(node)];
      next = field[static_cast<std::size_t>(next)];
      node = next;
    }
    return node;
  };
  const auto join = [&](int a, int b) {
    const int low = std::min(root(a), root(b));
    field[static_cast<std::size_t>(root(a))] = low;
    field[static_cast<std::size_t>(root(b))] = low;
  };
  for (std::size_t cell = 0; cell < data.cells.size(); ++cell) {
    if (!data.materials[static_cast<std::size_t>(data.material_of_cell[cell])].electric) continue;
    for (const int node : data.cells[cell]) join(data.cells[cell].front(), node);
  }
  for (const Bond& bond : data.bonds) {
    for (const int node : bond.to) {
      if (bond.potential) join(bond.node, node);
    }
  }
  for (const FloatingElectrode& electrode : data.floating) {
    for (const int node : electrode.nodes) join(electrode.nodes.front(), node);
  }
  for (std::size_t node = 0; node < field.size(); ++node) field[node] = root(static_cast<int>(node));
  return field;
}

void SolidUnknowns::place_positions(std::span<const double> u, Eigen::Ref<Eigen::VectorXd> x) const {
  for (const PrescribedDisplacement& said : data_->displacements) {
    const Eigen::Index at = 3 * static_cast<Eigen::Index>(said.node) + said.component;
    x[at] = data_->X[at] + said.value.at(u);
  }
}

void SolidUnknowns::place_potentials(std::span<const double> u, Eigen::Ref<Eigen::VectorXd> phi) const {
  for (const PrescribedPotential& said : data_->potentials) phi[said.node] = said.value.at(u);
}

void SolidUnknowns::place_position_rates(std::span<const double> du, Eigen::Ref<Eigen::VectorXd> dx) const {
  for (const PrescribedDisplacement& said : data_->displacements) {
    dx[3 * static_cast<Eigen::Index>(said.node) + said.component] = said.value.rate(du);
  }
}

void SolidUnknowns::place_potential_rates(std::span<const double> du, Eigen::Ref<Eigen::VectorXd> dphi) const {
  for (const PrescribedPotential& said : data_->potentials) dphi[said.node] = said.value.rate(du);
}

double SolidUnknowns::work_of_prescribed(const Eigen::Ref<const Eigen::VectorXd>& force,
                                         const Eigen::Ref<const Eigen::VectorXd>& motion) const {
  double work = 0.0;
  for (const PrescribedDisplacement& said : data_->displacements) {
    const Eigen::Index at = 3 * static_cast<Eigen::Index>(said.node) + said.component;
    work += force[at] * motion[at];
  }
  return work;
}

void SolidUnknowns::keep_free_positions(Eigen::Ref<Eigen::VectorXd> rows) const {
  for (const Eigen::Index i : fixed_positions_) rows[i] = 0.0;
}

void SolidUnknowns::keep_solved_potentials(Eigen::Ref<Eigen::VectorXd> rows) const {
  for (const Eigen::Index i : fixed_potentials_) rows[i] = 0.0;
}

}  // namespace muldi::fem
