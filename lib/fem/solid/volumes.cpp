#include "fem/solid/volumes.hpp"

namespace muldi::fem {
namespace {

/// Of fixed size: no loop over three entries is left.
using Node = Eigen::Map<Eigen::Vector3d>;
using ConstNode = Eigen::Map<const Eigen::Vector3d>;

}  // namespace

void Volumes::update(const ElementSet& elements, const Eigen::Ref<const Eigen::VectorXd>& at) {
  x = at;
  J.resize(elements.n_cells());
  gradient.resize(24 * static_cast<Eigen::Index>(elements.n_cells()));
  elements.volumes(x.data(), nullptr, {.J = J.data(), .gradient = gradient.data()});
}

void Volumes::add_gradients(const ElementSet& elements, const Eigen::Ref<const Eigen::VectorXd>& weight,
                            Eigen::Ref<Eigen::VectorXd> f) const {
  const auto& cells = elements.cells();
  const double* g = gradient.data();
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    const double w = weight[static_cast<Eigen::Index>(cell)];
    for (const int node : cells[cell]) {
      Node(f.data() + 3 * static_cast<Eigen::Index>(node)) += w * ConstNode(g);
      g += 3;
    }
  }
}

void Volumes::project(const ElementSet& elements, const Eigen::Ref<const Eigen::VectorXd>& dx,
                      Eigen::Ref<Eigen::VectorXd> out) const {
  const auto& cells = elements.cells();
  const double* g = gradient.data();
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    double sum = 0.0;
    for (const int node : cells[cell]) {
      const double* at = dx.data() + 3 * static_cast<Eigen::Index>(node);
      for (int i = 0; i < 3; ++i) sum += *g++ * at[i];
    }
    out[static_cast<Eigen::Index>(cell)] = sum;
  }
}

}  // namespace muldi::fem
