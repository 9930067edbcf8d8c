/// Energies and work of a solid, and what makes a configuration inadmissible.
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/text.hpp"
#include "fem/solid/least_stretch.hpp"
#include "fem/solid/solid.hpp"

namespace muldi::fem {
namespace {

/// Of the volume of a cell: where a Gauss point has less, curves of equilibria of several meshes part.
constexpr double least_share_of_volume = 0.1;

/// The number of a cell as its user knows it.
std::string cell_label(const SolidDescription& data, int cell) {
  const auto at = static_cast<std::size_t>(cell);
  return std::to_string(data.labels_of_cells.empty() ? cell : data.labels_of_cells[at]);
}

}  // namespace

std::string Solid::place_of_cell(int cell) const {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const int node : elements_.cells()[static_cast<std::size_t>(cell)]) {
    middle += data_.X.segment<3>(3 * static_cast<Eigen::Index>(node)) / 8.0;
  }
  return base::format("cell {} at [{:.4g}, {:.4g}, {:.4g}]", cell_label(data_, cell), middle[0], middle[1], middle[2]);
}

const Member& Solid::member_of_cell(int cell) const {
  const auto found = std::find_if(data_.members.begin(), data_.members.end(),
                                  [cell](const Member& member) { return cell < member.first_cell + member.n_cells; });
  return *found;
}

std::vector<std::string> Solid::parts() const {
  std::vector<std::string> names;
  names.reserve(data_.members.size());
  for (const Member& member : data_.members) names.push_back(part(member));
  return names;
}

bool Solid::is_viscous() const {
  return std::any_of(data_.materials.begin(), data_.materials.end(),
                     [](const Material& material) { return material.viscous.has_value(); });
}

std::string Solid::note() const {
  if (is_incompressible() && elements_.n_cells() > PressureFilter::most_cells) {
    return base::format(
        "solid '{}' has more than {} cells: whether patterns of element pressures exert no force is not looked for; "
        "where a regular mesh is held on its side faces, take mean_dilatation",
        data_.name, PressureFilter::most_cells);
  }
  // A constant pressure on a solid that is held all around is no pattern of the mesh.
  if (filter_.n_patterns() <= 1) return {};
  return base::format(
      "solid '{}' is held in such a way that {} patterns of element pressures, checkerboards among them, exert no "
      "force: "
      "they are filtered out of the pressures, and the volume is kept of groups of cells instead of every single one",
      data_.name, filter_.n_patterns());
}

model::IntervalWork Solid::work(const model::IntervalPoint& at) const {
  model::IntervalWork work;
  if (at.dt <= 0.0) return work;
  if (is_viscous()) {
    work.dissipated =
        at.dt * elements_.energies({.x = at.q.data() + q_.first, .v = at.v.data() + q_.first}).dissipation;
  }
  if (!data_.dead_loads.empty() || !data_.pressures.empty()) {
    force_.setZero();
    loads_.add_external(positions(at.q), at.u, force_);
    work.external = force_.dot(positions(at.q1) - positions(at.q0));
  }
  return work;
}

void Solid::energies(const model::NodePoint& at, std::span<model::Energy> out) const {
  const auto x = positions(at.q);
  ElementFields fields{.x = x.data(), .v = at.v.data() + q_.first};
  if (unknowns_.has_field()) fields.phi = potentials_at(x, at.u).data();
  elements_.energies(fields, energies_);
  loads_.surface_charge(at.u, charge_);
  const bool dilates = data_.formulation == Formulation::mean_dilatation;
  for (std::size_t k = 0; k < data_.members.size(); ++k) {
    const Member& member = data_.members[k];
    for (int material = 0; material < member.n_materials; ++material) {
      const ElementEnergies& sum = energies_[static_cast<std::size_t>(member.first_material + material)];
      out[k].kinetic += sum.kinetic;
      out[k].elastic += sum.elastic;
      out[k].electric += sum.electric;
    }
    out[k].gravity += loads_.gravity_energy(x, member.first_node, member.n_nodes);
    // Charges that are given instead of potentials belong to the enthalpy: its stationary value by phi is the energy.
    if (unknowns_.has_field()) {
      out[k].electric +=
          charge_.segment(member.first_node, member.n_nodes).dot(phi_.segment(member.first_node, member.n_nodes));
    }
    if (!dilates) continue;
    const Volumes& volumes = volumes_at(x);
    for (int cell = member.first_cell; cell < member.first_cell + member.n_cells; ++cell) {
      out[k].elastic += V_[cell] * dilation(cell, volumes.J[cell]).U;
    }
  }
}

double Solid::capacitance(const Eigen::Ref<const Eigen::VectorXd>& x, const std::vector<int>& nodes,
                          bool floats) const {
  // Every electric law is quadratic in the field: the response to one volt, or one unit of charge, is that to any.
  Eigen::VectorXd phi = Eigen::VectorXd::Zero(elements_.n_nodes());
  Eigen::VectorXd charge = phi;
  if (floats) {
    charge[nodes.front()] = 1.0;
  } else {
    for (const int node : nodes) {
      phi[node] = 1.0;
      const Bonds::Terms stays = bonds_.terms(node);
      if (stays.nodes.size() == 1) phi[stays.nodes.front()] = 1.0;
    }
    bonds_.follow(1, phi);
  }
  if (potential_solver_ && !potential_solver_->solve(x, charge, phi)) return std::numeric_limits<double>::quiet_NaN();
  if (floats) return 1.0 / phi[nodes.front()];
  const Eigen::VectorXd rows = charge_rows(x, phi);
  double sum = 0.0;
  for (const int node : nodes) sum -= rows[node];
  return sum;
}

std::string Solid::inadmissible(const Eigen::VectorXd& q) const {
  Eigen::VectorXd least(elements_.n_cells());
  const double margin = elements_.forces({.x = q.data() + q_.first}, {.least_J = least.data()});
  if (margin > 0.0) return {};
  Eigen::Index worst = 0;
  for (Eigen::Index cell = 1; cell < least.size() && !std::isnan(least[worst]); ++cell) {
    // Round-off does not choose between equal cells.
    constexpr double clearly = 1e-6;
    if (!(least[cell] >= least[worst] - clearly * std::max(1.0, std::abs(least[worst])))) worst = cell;
  }
  return base::format("solid '{}': {} is inverted (det F {:.3g})", member_of_cell(static_cast<int>(worst)).name,
                      place_of_cell(static_cast<int>(worst)), least[worst]);
}

std::string Solid::unresolved(const Eigen::VectorXd& q) const {
  // Only volumes that are looked at as a whole let a part of a cell vanish.
  if (!has_pressures()) return {};
  Eigen::VectorXd least(elements_.n_cells());
  elements_.forces({.x = q.data() + q_.first}, {.least_J = least.data()});
  const Volumes volumes = volumes_at(positions(q));
  least.array() /= volumes.J.array();
  int worst = 0;
  for (int cell = 1; cell < elements_.n_cells(); ++cell) {
    // Round-off does not choose between equal cells.
    if (least[cell] < (1.0 - 1e-6) * least[worst]) worst = cell;
  }
  if (least[worst] > least_share_of_volume) return {};
  return base::format(
      "{} of solid '{}' gives way alone: it keeps its volume as a whole, but of the part at one of its Gauss points "
      "{:.3g} is left, squeezed to stretch {:.3g}; what follows depends on the mesh",
      place_of_cell(worst), data_.name, least[worst], least_stretches(elements_, positions(q))[worst]);
}

}  // namespace muldi::fem
