#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "fem/mesh/generate.hpp"
#include "fem/mesh/node_order.hpp"
#include "mesh_measures.hpp"

namespace muldi::fem {
namespace {

/// A long bar whose nodes and cells are numbered at random.
Mesh shuffled() {
  const Mesh bar = make_mesh(Box{.size = {2, 3, 40}, .cells = {2, 3, 40}});
  std::mt19937 random(7);
  std::vector<int> place(bar.nodes.size());
  std::iota(place.begin(), place.end(), 0);
  std::shuffle(place.begin(), place.end(), random);
  Mesh mesh = bar;
  for (std::size_t i = 0; i < place.size(); ++i) {
    mesh.nodes[static_cast<std::size_t>(place[i])] = bar.nodes[i];
    mesh.layer_of_node[static_cast<std::size_t>(place[i])] = bar.layer_of_node[i];
  }
  for (auto& cell : mesh.cells) {
    for (int& node : cell) node = place[static_cast<std::size_t>(node)];
  }
  return mesh;
}

TEST(NodeOrder, MakesTheBandOfABarNarrow) {
  Mesh mesh = shuffled();
  EXPECT_GT(bandwidth(mesh), 300);  // of 492 nodes
  order_by_neighbours(mesh);
  EXPECT_LE(bandwidth(mesh), 3 * 12);  // a layer has 12 nodes; the fronts of the levels are a little wider
  expect_good(mesh);
  EXPECT_NEAR(volume(mesh), 240, 1e-10);
  EXPECT_NEAR(area(mesh, "x-"), 120, 1e-11);
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) EXPECT_EQ(mesh.nodes[i][2], mesh.layer_of_node[i] - 20.0);
}

TEST(NodeOrder, KeepsSetsAndLabels) {
  Mesh mesh = shuffled();
  mesh.labels_of_nodes.resize(mesh.nodes.size());
  std::iota(mesh.labels_of_nodes.begin(), mesh.labels_of_nodes.end(), 0);
  mesh.node_sets.push_back({.name = "some", .nodes = {3, 17, 400}});
  const std::vector<Vec3> before = mesh.nodes;
  order_by_neighbours(mesh);
  std::vector<long> labels;
  for (const int node : mesh.find_nodes("some")->nodes) {
    labels.push_back(mesh.labels_of_nodes[static_cast<std::size_t>(node)]);
  }
  std::sort(labels.begin(), labels.end());
  EXPECT_EQ(labels, (std::vector<long>{3, 17, 400}));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    EXPECT_EQ(mesh.nodes[i], before[static_cast<std::size_t>(mesh.labels_of_nodes[i])]);
  }
}

}  // namespace
}  // namespace muldi::fem
