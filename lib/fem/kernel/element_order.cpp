#include "fem/kernel/element_order.hpp"

#include <algorithm>
#include <numeric>

#include "base/error.hpp"
#include "fem/kernel/hexahedron.hpp"

namespace muldi::fem {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

ElementOrder::ElementOrder(std::span<const std::array<int, 8>> elements, std::span<const int> materials, int lanes,
                           int chunk_elements)
    : lanes_(lanes), n_elements_(static_cast<int>(elements.size())) {
  MULDI_EXPECT(elements.size() == materials.size(), "one material an element");
  MULDI_EXPECT(lanes > 0 && chunk_elements > 0, "positive sizes");
  std::vector<int> sorted(elements.size());
  std::iota(sorted.begin(), sorted.end(), 0);
  std::vector<int> smallest(elements.size());
  int n_nodes = 0;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    smallest[e] = *std::min_element(elements[e].begin(), elements[e].end());
    n_nodes = std::max(n_nodes, *std::max_element(elements[e].begin(), elements[e].end()) + 1);
  }
  std::stable_sort(sorted.begin(), sorted.end(), [&](int a, int b) {
    return std::pair(materials[at(a)], smallest[at(a)]) < std::pair(materials[at(b)], smallest[at(b)]);
  });
  const std::span<const int> all(sorted);
  const std::size_t per_chunk = at((chunk_elements + lanes - 1) / lanes * lanes);
  for (std::size_t first = 0; first < all.size();) {
    std::size_t end = first + 1;
    while (end < all.size() && end < first + per_chunk && materials[at(all[end])] == materials[at(all[first])]) ++end;
    add_chunk(all.subspan(first, end - first), elements, materials[at(all[first])]);
    first = end;
  }
  colour_chunks(n_nodes);
}

void ElementOrder::add_chunk(std::span<const int> of, std::span<const std::array<int, 8>> elements, int material) {
  const int n = static_cast<int>(of.size());
  const int n_batches = (n + lanes_ - 1) / lanes_;
  chunks_.push_back({.first_batch = this->n_batches(), .n_batches = n_batches, .material = material});
  for (int batch = 0; batch < n_batches; ++batch) {
    const auto element_of = [&](int lane) { return of[at(std::min(batch * lanes_ + lane, n - 1))]; };
    for (int a = 0; a < 8; ++a) {
      for (int lane = 0; lane < lanes_; ++lane) nodes_.push_back(elements[at(element_of(lane))][at(corner_of_bits[a])]);
    }
    for (int lane = 0; lane < lanes_; ++lane) elements_.push_back(element_of(lane));
    active_.push_back(std::min(lanes_, n - batch * lanes_));
  }
}

void ElementOrder::colour_chunks(int n_nodes) {
  // Greedy, in the order of the chunks: the first colour that no chunk with a common node has. Bit c of a node: colour
  // c has been there.
  constexpr int most = 64;
  std::vector<std::uint64_t> taken(at(n_nodes), 0);
  for (std::size_t c = 0; c < chunks_.size(); ++c) {
    const Range of = range(chunks_[c]);
    const std::span<const int> nodes(of.nodes, at(8 * lanes_ * of.n_batches));
    std::uint64_t met = 0;
    for (const int node : nodes) met |= taken[at(node)];
    int colour = 0;
    while (colour < most && ((met >> colour) & 1U) != 0) ++colour;
    MULDI_EXPECT(colour < most, "chunks of at most 64 colours");
    for (const int node : nodes) taken[at(node)] |= std::uint64_t{1} << colour;
    chunks_[c].colour = colour;
    if (colour == n_colours()) colours_.emplace_back();
    colours_[at(colour)].push_back(static_cast<int>(c));
  }
}

ElementOrder::Range ElementOrder::range(const Chunk& chunk) const {
  return {.n_batches = chunk.n_batches,
          .nodes = nodes_.data() + at(8 * lanes_) * at(chunk.first_batch),
          .elements = elements_.data() + at(lanes_) * at(chunk.first_batch),
          .active = active_.data() + chunk.first_batch,
          .first_batch = chunk.first_batch};
}

std::vector<std::int32_t> ElementOrder::block_slots(
    const std::function<std::int32_t(int row, int column)>& find) const {
  std::vector<std::int32_t> slots;
  slots.reserve(at(36 * lanes_) * at(n_batches()));
  for (int batch = 0; batch < n_batches(); ++batch) {
    const int* nodes = nodes_.data() + at(8 * lanes_) * at(batch);
    for (int a = 0; a < 8; ++a) {
      for (int b = a; b < 8; ++b) {
        for (int lane = 0; lane < lanes_; ++lane)
          slots.push_back(find(nodes[a * lanes_ + lane], nodes[b * lanes_ + lane]));
      }
    }
  }
  return slots;
}

}  // namespace muldi::fem
