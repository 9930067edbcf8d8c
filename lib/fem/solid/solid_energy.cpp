/// Energies and work of a solid, and what makes a configuration inadmissible.
#include <Eigen/Geometry>
#include <algorithm>

#include "base/text.hpp"
#include "fem/solid/solid.hpp"

namespace muldi::fem {
namespace {

/// How the nodes that are tied to a host leave the solid free to turn about them; empty if they do not.
std::string loose_tie(const SolidDescription& data, int host) {
  constexpr double on_a_line = 1e-6;  // distance from it over the length
  std::vector<Eigen::Vector3d> nodes;
  nodes.reserve(data.ties.size());
  for (const Tie& tie : data.ties) {
    if (tie.host == host) nodes.emplace_back(data.X.segment<3>(3 * static_cast<Eigen::Index>(tie.node)));
  }
  if (nodes.size() == 1) return "by a single node, about which it turns as on a ball joint";
  Eigen::Vector3d span = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& x : nodes) {
    if ((x - nodes[0]).norm() > span.norm()) span = x - nodes[0];
  }
  for (const Eigen::Vector3d& x : nodes) {
    if (span.normalized().cross(x - nodes[0]).norm() > on_a_line * span.norm()) return {};
  }
  return "by nodes on one line, about which it turns as on a hinge";
}

/// The number of a cell as its user knows it.
std::string cell_label(const SolidDescription& data, int cell) {
  const auto at = static_cast<std::size_t>(cell);
  return std::to_string(data.labels_of_cells.empty() ? cell : data.labels_of_cells[at]);
}

}  // namespace

bool Solid::is_viscous() const {
  return std::any_of(data_.materials.begin(), data_.materials.end(),
                     [](const Material& material) { return material.viscous.has_value(); });
}

std::string Solid::note() const {
  std::string text;
  for (int host = 0; host < ties_.n_hosts(); ++host) {
    const std::string how = loose_tie(data_, host);
    if (how.empty()) continue;
    text += base::format("{}solid '{}' is tied to body '{}' {}; tie nodes that span a face to clamp it",
                         text.empty() ? "" : "; ", data_.name, data_.hosts[static_cast<std::size_t>(host)].name, how);
  }
  // A constant pressure on a solid that is held all around is no pattern of the mesh.
  if (filter_.n_patterns() <= 1) return text;
  return text + (text.empty() ? "" : "; ") +
         base::format(
             "solid '{}' is held in such a way that {} patterns of element pressures, checkerboards among them, exert "
             "no force: they are filtered out of the pressures, and the volume is kept of groups of cells instead of "
             "every single one",
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
  const ElementEnergies sum = elements_.energies(fields);
  out[0].kinetic += sum.kinetic;
  out[0].elastic += sum.elastic;
  out[0].electric += sum.electric;
  out[0].gravity += loads_.gravity_energy(x);
  // Charges that are given instead of potentials belong to the enthalpy: its stationary value by phi is the energy.
  loads_.surface_charge(at.u, charge_);
  if (unknowns_.has_field()) out[0].electric += charge_.dot(phi_);
  if (data_.formulation != Formulation::mean_dilatation) return;
  const Volumes& volumes = volumes_at(x);
  for (int cell = 0; cell < elements_.n_cells(); ++cell) {
    out[0].elastic += V_[cell] * dilation(cell, volumes.J[cell]).U;
  }
}

std::string Solid::inadmissible(const Eigen::VectorXd& q) const {
  Eigen::VectorXd least(elements_.n_cells());
  const double margin = elements_.forces({.x = q.data() + q_.first}, {.least_J = least.data()});
  if (margin > 0.0) return {};
  Eigen::Index worst = 0;
  for (Eigen::Index cell = 0; cell < least.size(); ++cell) {
    if (!(least[cell] >= least[worst])) worst = cell;
  }
  return base::format("solid '{}': cell {} is inverted (det F {:.3g})", data_.name,
                      cell_label(data_, static_cast<int>(worst)), least[worst]);
}

}  // namespace muldi::fem
