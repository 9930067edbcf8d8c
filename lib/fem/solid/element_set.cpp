#include "fem/solid/element_set.hpp"

#include <algorithm>
#include <limits>

#include "base/error.hpp"
#include "base/parallel.hpp"

namespace muldi::fem {

ElementSet::ElementSet(Eigen::VectorXd X, std::vector<std::array<int, 8>> cells, std::vector<int> material_of_cell,
                       std::vector<Material> materials, Isa isa)
    : X_(std::move(X)),
      cells_(std::move(cells)),
      material_of_cell_(std::move(material_of_cell)),
      materials_(std::move(materials)),
      kernels_(element_kernels(isa)),
      order_(cells_, material_of_cell_, kernels_.lanes),
      least_of_chunk_(order_.chunks().size()),
      energies_of_chunk_(order_.chunks().size()) {
  MULDI_EXPECT(material_of_cell_.size() == cells_.size(), "every cell has a material");
  for (const Material& material : materials_) laws_.push_back(laws_of(material));
  Eigen::VectorXd V = Eigen::VectorXd::Zero(n_cells());
  volumes(X_.data(), nullptr, {.reference = V.data()});
  V_ = std::move(V);
}

template <class Work>
void ElementSet::each_chunk(const Work& work) const {
  const auto run = [](int n, const auto& call) { base::parallel_for(n, call); };
  for_each_chunk(order_, run, [&](const ElementOrder::Chunk& chunk, int index) {
    work(laws_[static_cast<std::size_t>(chunk.material)], order_.range(chunk), index);
  });
}

double ElementSet::forces(ElementFields fields, const ForceTargets& out) const {
  fields.X = X_.data();
  each_chunk([&](const MaterialLaws& laws, const ElementRange& range, int chunk) {
    least_of_chunk_[static_cast<std::size_t>(chunk)] = kernels_.forces(laws, range, fields, out);
  });
  double smallest = std::numeric_limits<double>::infinity();
  for (const double J : least_of_chunk_) smallest = J >= smallest ? smallest : J;  // keeps a NaN
  return smallest;
}

void ElementSet::action(ElementFields fields, const FieldDirections& along, const ForceTargets& out) const {
  fields.X = X_.data();
  each_chunk([&](const MaterialLaws& laws, const ElementRange& range, int) {
    kernels_.action(laws, range, fields, along, out);
  });
}

void ElementSet::tangent(ElementFields fields, const ElementTangentWeights& weights, const math::NodeMask& fixed,
                         std::span<const std::int32_t> slots, math::SymmetricBlockMatrix& K) const {
  fields.X = X_.data();
  const BlockTarget target{
      .block = K.block_size(), .values = K.values().data(), .slots = slots.data(), .fixed = fixed.data()};
  each_chunk([&](const MaterialLaws& laws, const ElementRange& range, int) {
    kernels_.tangent(laws, range, fields, weights, target);
  });
}

void ElementSet::volumes(const double* x, const double* dx, const VolumeTargets& out) const {
  const VolumeFields fields{.X = X_.data(), .x = x, .dx = dx, .V = V_.size() > 0 ? V_.data() : nullptr};
  each_chunk([&](const MaterialLaws&, const ElementRange& range, int) { kernels_.volumes(range, fields, out); });
}

void ElementSet::energies_of_chunks(ElementFields fields) const {
  fields.X = X_.data();
  each_chunk([&](const MaterialLaws& laws, const ElementRange& range, int chunk) {
    energies_of_chunk_[static_cast<std::size_t>(chunk)] = kernels_.energies(laws, range, fields);
  });
}

void ElementSet::energies(ElementFields fields, std::vector<ElementEnergies>& of_materials) const {
  energies_of_chunks(fields);
  of_materials.assign(materials_.size(), {});
  for (std::size_t chunk = 0; chunk < energies_of_chunk_.size(); ++chunk) {
    of_materials[static_cast<std::size_t>(order_.chunks()[chunk].material)] += energies_of_chunk_[chunk];
  }
}

ElementEnergies ElementSet::energies(ElementFields fields) const {
  energies_of_chunks(fields);
  ElementEnergies sum;
  for (const ElementEnergies& part : energies_of_chunk_) sum += part;
  return sum;
}

void ElementSet::point_values(ElementFields fields, PointValues* out) const {
  fields.X = X_.data();
  each_chunk([&](const MaterialLaws& laws, const ElementRange& range, int) {
    kernels_.point_values(laws, range, fields, out);
  });
}

void ElementSet::loads(const double* b, int width, double* nodal) const {
  each_chunk(
      [&](const MaterialLaws&, const ElementRange& range, int) { kernels_.loads(range, X_.data(), b, width, nodal); });
}

std::vector<std::int32_t> ElementSet::slots_in(const math::SymmetricBlockPattern& pattern) const {
  return order_.block_slots([&pattern](int row, int column) {
    const int slot = pattern.slot(std::min(row, column), std::max(row, column));
    return static_cast<std::int32_t>(2 * slot + (row > column ? 1 : 0));
  });
}

}  // namespace muldi::fem
