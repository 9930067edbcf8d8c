#include "fem/material.hpp"

#include <Eigen/Dense>
#include <limits>
#include <variant>

namespace muldi::fem {

namespace {

template <class Law>
LawReference reference(const Law& law, int first) {
  return std::visit(
      [&](const auto& alternative) {
        return LawReference{.type = first + static_cast<int>(law.index()), .law = &alternative};
      },
      law);
}

}  // namespace

MaterialLaws laws_of(const Material& material) {
  MaterialLaws laws{.density = material.density};
  const auto add = [&laws](const LawReference& law) {
    laws.energy[laws.n_energy] = law;
    ++laws.n_energy;
  };
  int first = 0;
  add(reference(material.elastic, first));
  first += static_cast<int>(ElasticLaws::size);
  if (material.volumetric) add(reference(*material.volumetric, first));
  first += static_cast<int>(VolumetricLaws::size);
  laws.n_elastic = laws.n_energy;
  if (material.electric) add(reference(*material.electric, first));
  if (material.viscous) laws.viscous = reference(*material.viscous, 0);
  return laws;
}

double largest_electric_curvature(const Material& material, const std::array<double, 9>& F,
                                  const std::array<double, 3>& E) {
  if (!material.electric) return -std::numeric_limits<double>::infinity();
  Point<double> at;
  for (int i = 0; i < 3; ++i) {
    at.E[i] = E[static_cast<std::size_t>(i)];
    for (int k = 0; k < 3; ++k) at.F[i][k] = F[static_cast<std::size_t>(3 * i + k)];
  }
  at.complete();
  Tangent<double> tangent;
  std::visit([&](const auto& law) { law.add_tangent(at, tangent); }, *material.electric);
  const double* block = tangent.block[Tangent<double>::pair(3, 3)];
  Eigen::Matrix3d curvature;
  for (int k = 0; k < 3; ++k)
    for (int m = k; m < 3; ++m) curvature(k, m) = curvature(m, k) = block[3 * k + m];
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(curvature, Eigen::EigenvaluesOnly).eigenvalues()[2];
}

}  // namespace muldi::fem
