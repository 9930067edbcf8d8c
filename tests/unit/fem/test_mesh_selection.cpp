#include <gtest/gtest.h>

#include "fem/mesh/generate.hpp"
#include "fem/mesh/selection.hpp"
#include "mesh_measures.hpp"

namespace muldi::fem {
namespace {

class CubeSelection : public testing::Test {
 protected:
  /// The cube of the thesis: edge 2 about the origin, 8 cells each way.
  Mesh mesh = make_mesh(Box{.size = {2, 2, 2}, .cells = {8, 8, 8}});
  MeshSelection selection{mesh};
};

TEST_F(CubeSelection, FaceByName) {
  const Selected selected = selection.faces(SelectFace{.face = "y+"});
  EXPECT_EQ(selected.error, "");
  EXPECT_EQ(selected.faces.size(), 64u);
  EXPECT_EQ(selected.nodes.size(), 81u);
  EXPECT_TRUE(std::is_sorted(selected.nodes.begin(), selected.nodes.end()));
  EXPECT_EQ(selection.nodes(SelectFace{.face = "y+"}).nodes, selected.nodes);
}

TEST_F(CubeSelection, HalfAFaceHasTheNodesOfItsRim) {
  // Faces with centre x <= 0 and all their nodes: five columns of nodes, those at x = 0 included.
  const Selected selected = selection.nodes(SelectFace{.face = "y+", .x = {.high = 0}});
  EXPECT_EQ(selected.nodes.size(), 45u);
  EXPECT_EQ(selected.faces.size(), 32u);
}

TEST_F(CubeSelection, BoxLeavesNodesOut) {
  // The published wording x < 0: nodes at x = 0 out.
  SelectBox select;
  select.box[0] = {std::nullopt, 1.0, std::nullopt};
  select.box[1] = {-0.125, 1.0, std::nullopt};
  EXPECT_EQ(selection.nodes(select).nodes.size(), 36u);
  EXPECT_EQ(selection.faces(select).faces.size(), 24u);
}

TEST_F(CubeSelection, PlaneAndLineAndCorner) {
  EXPECT_EQ(selection.nodes(SelectPlane{.plane = {.z = 0}}).nodes.size(), 81u);
  EXPECT_EQ(selection.nodes(SelectPlane{.plane = {.x = 1, .z = 0.25}}).nodes.size(), 9u);
  EXPECT_EQ(selection.nodes(SelectPlane{.plane = {.x = 1, .y = 1, .z = 1}}).nodes, std::vector<int>{728});
  EXPECT_EQ(selection.nodes(SelectPlane{.plane = {.z = 0.2499}}).nodes.size(), 81u);  // within 1e-3 of an edge
  EXPECT_EQ(selection.faces(SelectPlane{.plane = {.z = -1}}).faces.size(), 64u);
}

TEST_F(CubeSelection, NearestNode) {
  EXPECT_EQ(selection.nodes(SelectPoint{.point = {-1, -1, -1}}).nodes, std::vector<int>{0});
  EXPECT_EQ(selection.nodes(SelectPoint{.point = {-0.99, -1, -1}}).nodes, std::vector<int>{0});
  EXPECT_EQ(selection.nodes(SelectPoint{.point = {-0.9, -1, -1}}).error,
            "no node is at (-0.9, -1, -1); the nearest is node 0 at (-1, -1, -1)");
}

TEST_F(CubeSelection, PartAndAll) {
  EXPECT_EQ(selection.cells(SelectPart{.part = "solid"}).cells.size(), 512u);
  EXPECT_EQ(selection.cells(SelectAll{}).cells.size(), 512u);
  EXPECT_EQ(selection.faces(SelectAll{}).faces.size(), 6u * 64u);
  EXPECT_EQ(selection.nodes(SelectAll{}).nodes.size(), 729u);
  SelectBox half;
  half.box[1][0] = 0.0;
  EXPECT_EQ(selection.cells(half).cells.size(), 256u);
}

TEST_F(CubeSelection, EmptySelectionsSayWhatThereIs) {
  const std::string spans = "; the mesh spans x from -1 to 1, y from -1 to 1, z from -1 to 1 in its own frame";
  EXPECT_EQ(selection.nodes(SelectFace{.face = "y"}).error, "the mesh has no face or set 'y' (did you mean 'y-'?)");
  EXPECT_EQ(selection.nodes(SelectFace{.face = "top"}).error,
            "the mesh has no face or set 'top' (known: z-, z+, x-, x+, y-, y+)");
  EXPECT_EQ(selection.nodes(SelectFace{.face = "y+", .x = {.low = 5}}).error,
            "no face of 'y+' has its centre in these ranges" + spans);
  EXPECT_EQ(selection.nodes(SelectPlane{.plane = {.z = 0.1}}).error,
            "no node has z = 0.1, the nearest are at 0" + spans);
  EXPECT_EQ(selection.nodes(SelectPlane{.plane = {.x = 1, .y = 7}}).error, "no node has x = 1, y = 7" + spans);
  SelectBox outside;
  outside.box[0][2] = 2.0;
  EXPECT_EQ(selection.nodes(outside).error, "no node lies in the box" + spans);
  EXPECT_EQ(selection.nodes(SelectSet{.set = "tip"}).error, "the mesh has no sets of nodes, got 'tip'");
  EXPECT_EQ(selection.nodes(SelectPart{.part = "solids"}).error,
            "the mesh has no part 'solids' (did you mean 'solid'?)");
  EXPECT_EQ(selection.faces(SelectPlane{.plane = {.z = 0}}).error, "selects nodes, but no whole face on the boundary");
  EXPECT_EQ(selection.faces(SelectPoint{.point = {1, 1, 1}}).error, "selects nodes, but no whole face on the boundary");
  EXPECT_EQ(selection.cells(SelectFace{.face = "z+"}).error, "selects nodes, but no whole cell");
}

TEST(FileSelection, SetsAreFoundByNameToo) {
  const std::string folder = std::string(MULDI_SOURCE_DIR) + "/tests/unit/fem/meshes";
  const Mesh mesh = make_mesh(MeshFile{.path = "two_cubes_41.msh"}, folder);
  const MeshSelection selection(mesh);
  EXPECT_EQ(selection.nodes(SelectSet{.set = "tip"}).nodes.size(), 1u);
  EXPECT_EQ(selection.nodes(SelectFace{.face = "middle"}).nodes.size(), 4u);  // inside: nodes, no faces
  EXPECT_EQ(selection.faces(SelectFace{.face = "end"}).faces.size(), 1u);
  EXPECT_EQ(selection.nodes(SelectFace{.face = "middle", .y = {.low = 0.5}}).nodes.size(), 2u);
  EXPECT_EQ(selection.nodes(SelectSet{.set = "top"}).error, "the mesh has no set 'top' (did you mean 'tip'?)");
  EXPECT_EQ(selection.nodes(SelectFace{.face = "middle", .y = {.low = 5}}).error,
            "no node of 'middle' lies in these ranges; the mesh spans x from 0 to 2, y from 0 to 1, z from 0 to 1 in "
            "its own frame");
}

}  // namespace
}  // namespace muldi::fem
