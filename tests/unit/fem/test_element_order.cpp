/// Batches, chunks and colours cover the mesh and keep chunks of one colour apart.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "support/fem_patch.hpp"

namespace muldi::fem {
namespace {

struct Mixed {
  test::FemPatch patch = test::cube_of(6);
  std::vector<int> materials;

  Mixed() {
    for (int e = 0; e < patch.n_elements(); ++e) materials.push_back(e % 5 == 0 ? 1 : 0);
  }
  ElementOrder order(int lanes) const { return {patch.elements, materials, lanes, 16}; }
};

TEST(ElementOrder, WorksOffEveryElementOnceInChunksOfItsMaterial) {
  const Mixed mixed;
  for (const int lanes : {2, 4, 8}) {
    const ElementOrder order = mixed.order(lanes);
    std::vector<int> seen(mixed.materials.size(), 0);
    for (const ElementOrder::Chunk& chunk : order.chunks()) {
      const ElementOrder::Range range = order.range(chunk);
      for (int batch = 0; batch < range.n_batches; ++batch) {
        for (int lane = 0; lane < range.active[batch]; ++lane) {
          const auto element = static_cast<std::size_t>(range.elements[batch * lanes + lane]);
          ++seen[element];
          EXPECT_EQ(mixed.materials[element], chunk.material);
          // Bits of the index: corner 6 of VTK is 7, corner 3 is 2.
          EXPECT_EQ(range.nodes[(8 * batch + 7) * lanes + lane], mixed.patch.elements[element][6]);
          EXPECT_EQ(range.nodes[(8 * batch + 2) * lanes + lane], mixed.patch.elements[element][3]);
        }
      }
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), mixed.patch.n_elements());
  }
}

TEST(ElementOrder, ChunksOfOneColourShareNoNode) {
  const Mixed mixed;
  const ElementOrder order = mixed.order(4);
  int n_chunks = 0;
  for (int c = 0; c < order.n_colours(); ++c) {
    std::set<int> taken;
    for (const int number : order.colour(c)) {
      ++n_chunks;
      const ElementOrder::Range range = order.range(order.chunks()[static_cast<std::size_t>(number)]);
      const std::set<int> nodes(range.nodes, range.nodes + 8 * 4 * range.n_batches);
      for (const int node : nodes) EXPECT_TRUE(taken.insert(node).second);
    }
  }
  EXPECT_EQ(n_chunks, static_cast<int>(order.chunks().size()));
  EXPECT_GT(order.n_colours(), 1);
}

TEST(ElementOrder, OrderOfTheChunksOfAColourChangesNoBit) {
  const test::FemPatch patch = test::cube_of(6);
  std::mt19937 random(2);
  const test::FemState state = test::random_state(patch, random);
  const test::FemSystem system(patch, test::full_material());
  const auto forces = [&](const auto& run) {
    Eigen::VectorXd force = Eigen::VectorXd::Zero(3 * patch.n_nodes());
    for_each_chunk(system.order(), run, [&](const ElementOrder::Chunk& chunk, int) {
      system.kernels().forces(system.laws(), system.order().range(chunk), state.fields(patch), {.force = force.data()});
    });
    return force;
  };
  const Eigen::VectorXd forward = forces(one_after_the_other);
  const Eigen::VectorXd backward = forces([](int n, const auto& call) {
    for (int i = n - 1; i >= 0; --i) call(i);
  });
  EXPECT_EQ(forward, backward);
}

}  // namespace
}  // namespace muldi::fem
