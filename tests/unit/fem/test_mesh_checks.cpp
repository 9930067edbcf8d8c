#include <gtest/gtest.h>

#include "fem/mesh/check_mesh.hpp"
#include "fem/mesh/generate.hpp"
#include "mesh_measures.hpp"

namespace muldi::fem {
namespace {

using Lines = std::vector<std::string>;

/// Two cubes of edge 1 along x; cell 0 from -1 to 0.
Mesh two_cubes() { return make_mesh(Box{.size = {2, 1, 1}, .cells = {2, 1, 1}, .centre = {0, 0.5, 0.5}}); }

/// The second mesh beside the first, without common nodes.
Mesh beside(Mesh a, const Mesh& b) {
  const int shift = a.n_nodes();
  a.nodes.insert(a.nodes.end(), b.nodes.begin(), b.nodes.end());
  for (std::array<int, 8> cell : b.cells) {
    for (int& node : cell) node += shift;
    a.cells.push_back(cell);
    a.part_of_cell.push_back(0);
  }
  return a;
}

Mesh box(const Vec3& size, const std::array<int, 3>& cells, const Vec3& centre) {
  return make_mesh(Box{.size = size, .cells = cells, .centre = centre});
}

TEST(CheckMesh, NamesAnInvertedCell) {
  Mesh mesh = two_cubes();
  std::swap(mesh.cells[1][0], mesh.cells[1][4]);
  std::swap(mesh.cells[1][1], mesh.cells[1][5]);
  std::swap(mesh.cells[1][2], mesh.cells[1][6]);
  std::swap(mesh.cells[1][3], mesh.cells[1][7]);
  EXPECT_EQ(check_mesh(mesh).errors,
            Lines{"cell 1 has a negative volume at node 7 at (0, 0, 1) (Jacobian -0.125): turn or move its nodes"});
}

TEST(CheckMesh, NamesACellThatIsFoldedAtOneCorner) {
  Mesh mesh = two_cubes();
  mesh.nodes[8] = {0.4, 0.6, 0.4};  // the corner (1, 0, 1), pushed through the plane of its neighbours
  const Lines errors = check_mesh(mesh).errors;
  ASSERT_EQ(errors.size(), 1u);
  // Edges (-.6, .6, -.6) - (-1, 1, 0) and the like: determinant of the three edges at the corner, over 8.
  EXPECT_EQ(errors[0].substr(0, 66), "cell 1 has a negative volume at node 8 at (0.4, 0.6, 0.4) (Jacobia");
}

TEST(CheckMesh, NamesACellWithoutVolume) {
  Mesh mesh = two_cubes();
  for (Vec3& node : mesh.nodes) node[2] = node[0] > 0.5 ? 0.0 : node[2];
  const Lines errors = check_mesh(mesh).errors;
  ASSERT_FALSE(errors.empty());
  EXPECT_EQ(errors[0], "cell 1 has no volume at node 2 at (1, 0, 0) (Jacobian 0): turn or move its nodes");
}

TEST(CheckMesh, NamesNodesOfNoCell) {
  Mesh mesh = two_cubes();
  mesh.nodes.push_back({3, 0, 0});
  EXPECT_EQ(check_mesh(mesh).errors, Lines{"node 12 at (3, 0, 0) belongs to no cell: leave it out"});
}

TEST(CheckMesh, NamesNodesAtTheSamePlace) {
  const Mesh mesh = beside(box({1, 1, 1}, {1, 1, 1}, {0.5, 0.5, 0.5}), box({1, 1, 1}, {1, 1, 1}, {1.5, 0.5, 0.5}));
  const MeshReport report = check_mesh(mesh);
  const auto pair = [](const char* a, const char* b) {
    return std::string("node ") + a + " and node " + b +
           " are at the same place: make them one, so that their cells hang together";
  };
  EXPECT_EQ(report.errors, (Lines{pair("1 at (1, 0, 0)", "8"), pair("3 at (1, 1, 0)", "10"),
                                  pair("5 at (1, 0, 1)", "12"), pair("7 at (1, 1, 1)", "14")}));
  EXPECT_EQ(report.notes, Lines{"the mesh is in 2 pieces that do not hang together, with cell 0, cell 1"});
}

TEST(CheckMesh, NamesNodesThatHangInAFaceAndOnAnEdge) {
  // The right box has twice as many cells across: a node in the middle of the left one's face, four on its edges.
  const Mesh mesh = beside(box({1, 1, 1}, {1, 1, 1}, {-0.5, 0, 0}), box({1, 1, 1}, {1, 2, 2}, {0.5, 0, 0}));
  const Lines errors = check_mesh(mesh).errors;
  ASSERT_EQ(errors.size(), 9u);  // and four corners at the same place
  const auto hangs = [](const char* node, const char* where) {
    return std::string("node ") + node + " hangs: it lies inside " + where + " of cell 0, which does not have it";
  };
  EXPECT_EQ(Lines(errors.begin() + 4, errors.end()),
            (Lines{hangs("10 at (0, 0, -0.5)", "an edge"), hangs("14 at (0, -0.5, 0)", "an edge"),
                   hangs("16 at (0, 0, 0)", "a face"), hangs("18 at (0, 0.5, 0)", "an edge"),
                   hangs("22 at (0, 0, 0.5)", "an edge")}));
}

TEST(CheckMesh, FindsANodeThatHangsInABentFace) {
  Mesh mesh = box({1, 1, 1}, {1, 1, 1}, {0.5, 0.5, 0.5});
  mesh.nodes[7] = {1.2, 1.1, 1.3};  // x+ is no plane now
  Vec3 inside{};
  const double weights[4] = {0.42, 0.28, 0.12, 0.18};  // of (s, t) = (-.2, -.4)
  const int corners[4] = {1, 3, 7, 5};
  for (int k = 0; k < 4; ++k) {
    for (std::size_t i = 0; i < 3; ++i) inside[i] += weights[k] * mesh.nodes[static_cast<std::size_t>(corners[k])][i];
  }
  const Mesh hanging = beside(mesh, box({1, 1, 1}, {1, 1, 1}, {inside[0] + 0.5, inside[1] + 0.5, inside[2] + 0.5}));
  const Lines errors = check_mesh(hanging).errors;
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0], "node 8 at " + position_text(inside) +
                           " hangs: it lies inside a face of cell 0, which does "
                           "not have it");
}

TEST(CheckMesh, KeepsSeparatePiecesApart) {
  const Mesh mesh = beside(box({1, 1, 1}, {2, 2, 2}, {0, 0, 0}), box({1, 1, 1}, {1, 1, 1}, {3, 0, 0}));
  EXPECT_EQ(check_mesh(mesh).errors, Lines{});
  EXPECT_EQ(check_mesh(mesh).notes, Lines{"the mesh is in 2 pieces that do not hang together, with cell 0, cell 8"});
}

TEST(CheckMesh, NamesTheFirstFewOfMany) {
  Mesh mesh = box({8, 1, 1}, {8, 1, 1}, {0, 0, 0});
  for (Vec3& node : mesh.nodes) node[2] = -node[2];
  const Lines errors = check_mesh(mesh).errors;
  ASSERT_EQ(errors.size(), 6u);
  EXPECT_EQ(errors[0],
            "cell 0 has a negative volume at node 0 at (-4, -0.5, 0.5) (Jacobian -0.125): turn or move its nodes");
  EXPECT_EQ(errors[5], "and 3 more cells of this kind");
}

TEST(CheckMesh, NamesNodesThatDoNotExist) {
  Mesh mesh = two_cubes();
  mesh.cells[1][3] = 12;
  EXPECT_EQ(check_mesh(mesh).errors, Lines{"cell 1 names node 12, which does not exist"});
  EXPECT_EQ(check_mesh(Mesh{}).errors, Lines{"the mesh has no cells"});
}

TEST(CheckMesh, UsesTheNumbersOfTheFile) {
  Mesh mesh = two_cubes();
  mesh.labels_of_cells = {70, 71};
  for (int i = 0; i < 12; ++i) mesh.labels_of_nodes.push_back(100 + i);
  for (Vec3& node : mesh.nodes) node[1] = node[0] > 0.5 ? -node[1] : node[1];
  const Lines errors = check_mesh(mesh).errors;
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].substr(0, 59), "cell 1 (71 in the file) has a negative volume at node 2 (10");
}

TEST(CheckMesh, TakesAThinMeshOfManyNodes) {
  const Mesh mesh = box({100, 100, 1e-3}, {60, 60, 2}, {0, 0, 0});
  EXPECT_EQ(check_mesh(mesh).errors, Lines{});
}

}  // namespace
}  // namespace muldi::fem
