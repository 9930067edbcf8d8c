#include "fem/solid/solid_loads.hpp"

#include <algorithm>

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

using FaceMatrix = Eigen::Matrix<double, 12, 12>;

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return m;
}

/// Derivative of minus the force of a pressure by the positions of the face's corners.
FaceMatrix face_stiffness(const std::array<int, 4>& face, double value, const double* x) {
  FaceMatrix K = FaceMatrix::Zero();
  each_face_tangent(face, x, [&](const FacePoint& at) {
    const Eigen::Matrix3d along = cross_matrix(at.along);
    const Eigen::Matrix3d across = cross_matrix(at.across);
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        K.block<3, 3>(3 * a, 3 * b) += value * at.N[a] * (at.N_eta[b] * along - at.N_xi[b] * across);
      }
    }
  });
  return K;
}

void add_symmetric(const std::array<int, 4>& face, const FaceMatrix& K, math::SymmetricBlockMatrix& to) {
  const FaceMatrix symmetric = 0.5 * (K + K.transpose());
  const std::ptrdiff_t block = to.block_size();
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      const int row = face[static_cast<std::size_t>(a)];
      const int column = face[static_cast<std::size_t>(b)];
      if (row > column) continue;
      double* values = to.values().data() + to.pattern().slot(row, column) * block * block;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) values[i * block + j] += symmetric(3 * a + i, 3 * b + j);
      }
    }
  }
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
      f.segment<3>(3 * static_cast<Eigen::Index>(load.nodes[k])) += load.value.factor * load.unit[k];
    }
  }
  for (const Pressure& pressure : data_->pressures) {
    if (pressure.value.control != control) continue;
    for (const auto& face : pressure.faces) add_face_pressure(face, pressure.value.factor, x.data(), f.data());
  }
}

bool SolidLoads::has_pressure(std::span<const double> u) const {
  return std::any_of(data_->pressures.begin(), data_->pressures.end(),
                     [u](const Pressure& pressure) { return pressure.value.at(u) != 0.0; });
}

void SolidLoads::add_change(const Eigen::Ref<const Eigen::VectorXd>& x, std::span<const double> u,
                            const Eigen::Ref<const Eigen::VectorXd>& dx, Eigen::Ref<Eigen::VectorXd> f) const {
  for (const Pressure& pressure : data_->pressures) {
    const double value = pressure.value.at(u);
    if (value == 0.0) continue;
    for (const auto& face : pressure.faces) {
      Eigen::Matrix<double, 3, 4> change;
      for (int a = 0; a < 4; ++a) {
        change.col(a) = dx.segment<3>(3 * static_cast<Eigen::Index>(face[static_cast<std::size_t>(a)]));
      }
      each_face_tangent(face, x.data(), [&](const FacePoint& at) {
        const Eigen::Vector3d along = change * at.N_xi;
        const Eigen::Vector3d across = change * at.N_eta;
        const Eigen::Vector3d da = along.cross(at.across) + at.along.cross(across);
        for (int a = 0; a < 4; ++a) {
          f.segment<3>(3 * static_cast<Eigen::Index>(face[static_cast<std::size_t>(a)])) -= value * at.N[a] * da;
        }
      });
    }
  }
}

void SolidLoads::add_stiffness(const Eigen::Ref<const Eigen::VectorXd>& x, std::span<const double> u, double weight,
                               math::SymmetricBlockMatrix& K) const {
  for (const Pressure& pressure : data_->pressures) {
    const double value = pressure.value.at(u);
    if (value == 0.0) continue;
    for (const auto& face : pressure.faces) add_symmetric(face, face_stiffness(face, weight * value, x.data()), K);
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

double SolidLoads::gravity_energy(const Eigen::Ref<const Eigen::VectorXd>& x, int first, int n_nodes) const {
  if (!has_gravity_) return 0.0;
  double sum = 0.0;
  for (Eigen::Index node = first; node < first + n_nodes; ++node) {
    sum -= nodal_mass_[node] * data_->gravity.dot(x.segment<3>(3 * node));
  }
  return sum;
}

}  // namespace muldi::fem
