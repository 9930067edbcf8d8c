#include "fem/solid/solid_loads.hpp"

#include "fem/solid/face_shares.hpp"

namespace muldi::fem {
namespace {

/// Nodal shares of the mass: int rho N_a dV.
Eigen::VectorXd lumped_masses(const SolidDescription& data, const ElementSet& elements) {
  std::vector<double> density(8 * static_cast<std::size_t>(elements.n_cells()));
  for (int cell = 0; cell < elements.n_cells(); ++cell) {
    for (std::size_t point = 0; point < 8; ++point) {
      density[8 * static_cast<std::size_t>(cell) + point] = elements.material_of(cell).density;
    }
  }
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(data.X.size() / 3);
  elements.loads(density.data(), 1, mass.data());
  return mass;
}

}  // namespace

SolidLoads::SolidLoads(const SolidDescription& data, const ElementSet& elements)
    : data_(&data), nodal_mass_(lumped_masses(data, elements)), has_gravity_(data.gravity != Eigen::Vector3d::Zero()) {}

void add_face_pressure(const std::array<int, 4>& face, double value, const double* x, double* f) {
  each_face_point(face, x, [&](const Eigen::Vector4d& N, const Eigen::Vector3d& da) {
    for (int a = 0; a < 4; ++a) {
      double* to = f + 3 * static_cast<std::ptrdiff_t>(face[static_cast<std::size_t>(a)]);
      for (int i = 0; i < 3; ++i) to[i] -= value * N[a] * da[i];
    }
  });
}

void SolidLoads::add_external(const Eigen::Ref<const Eigen::VectorXd>& x, std::span<const double> u,
                              Eigen::Ref<Eigen::VectorXd> f) const {
  for (const DeadLoad& load : data_->dead_loads) {
    const double value = load.value.at(u);
    for (std::size_t k = 0; k < load.nodes.size(); ++k) {
      f.segment<3>(3 * static_cast<Eigen::Index>(load.nodes[k])) += value * load.unit[k];
    }
  }
  for (const Pressure& pressure : data_->pressures) {
    const double value = pressure.value.at(u);
    if (value == 0.0) continue;
    for (const auto& face : pressure.faces) add_face_pressure(face, value, x.data(), f.data());
  }
}

void SolidLoads::add(const Eigen::Ref<const Eigen::VectorXd>& x, std::span<const double> u,
                     Eigen::Ref<Eigen::VectorXd> f) const {
  if (has_gravity_) {
    for (Eigen::Index node = 0; node < nodal_mass_.size(); ++node) {
      f.segment<3>(3 * node) += nodal_mass_[node] * data_->gravity;
    }
  }
  add_external(x, u, f);
}

void SolidLoads::add_control_force(const Eigen::Ref<const Eigen::VectorXd>& x, int control,
                                   Eigen::Ref<Eigen::VectorXd> f) const {
  for (const DeadLoad& load : data_->dead_loads) {
    if (load.value.control != control) continue;
    for (std::size_t k = 0; k < load.nodes.size(); ++k) {
      f.segment<3>(3 * static_cast<Eigen::Index>(load.nodes[k])) += load.unit[k];
    }
  }
  for (const Pressure& pressure : data_->pressures) {
    if (pressure.value.control != control) continue;
    for (const auto& face : pressure.faces) add_face_pressure(face, 1.0, x.data(), f.data());
  }
}

void SolidLoads::surface_charge(std::span<const double> u, Eigen::VectorXd& charge) const {
  charge.setZero(data_->X.size() / 3);
  for (const SurfaceCharge& load : data_->surface_charges) {
    const double value = load.value.at(u);
    for (std::size_t k = 0; k < load.nodes.size(); ++k) charge[load.nodes[k]] += value * load.unit[k];
  }
  for (const FloatingElectrode& electrode : data_->floating) charge[electrode.nodes.front()] += electrode.charge.at(u);
}

void SolidLoads::surface_charge_rate(std::span<const double> du, Eigen::VectorXd& charge) const {
  charge.setZero(data_->X.size() / 3);
  for (const SurfaceCharge& load : data_->surface_charges) {
    const double rate = load.value.rate(du);
    for (std::size_t k = 0; k < load.nodes.size(); ++k) charge[load.nodes[k]] += rate * load.unit[k];
  }
  for (const FloatingElectrode& electrode : data_->floating)
    charge[electrode.nodes.front()] += electrode.charge.rate(du);
}

double SolidLoads::gravity_energy(const Eigen::Ref<const Eigen::VectorXd>& x) const {
  if (!has_gravity_) return 0.0;
  double sum = 0.0;
  for (Eigen::Index node = 0; node < nodal_mass_.size(); ++node) {
    sum -= nodal_mass_[node] * data_->gravity.dot(x.segment<3>(3 * node));
  }
  return sum;
}

}  // namespace muldi::fem
