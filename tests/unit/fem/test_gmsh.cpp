#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "base/error.hpp"
#include "fem/mesh/generate.hpp"
#include "fem/mesh/gmsh.hpp"
#include "mesh_measures.hpp"

namespace muldi::fem {
namespace {

const std::string folder = std::string(MULDI_SOURCE_DIR) + "/tests/unit/fem/meshes";

std::string content_of(const std::string& name) {
  std::ifstream file(folder + "/" + name, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string error_of(const std::string& content) {
  try {
    read_gmsh_text(content, "m.msh");
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "no error";
}

/// The content with the first `from` replaced.
std::string changed(std::string content, const std::string& from, const std::string& to) {
  const std::size_t at = content.find(from);
  if (at == content.npos) return "the file has no " + from;
  return content.replace(at, from.size(), to);
}

/// Numbers in the file of the nodes of a set.
std::set<long> labels(const Mesh& mesh, const std::string& set) {
  std::set<long> numbers;
  for (const int node : mesh.find_nodes(set)->nodes)
    numbers.insert(mesh.labels_of_nodes[static_cast<std::size_t>(node)]);
  return numbers;
}

class GmshFile : public testing::TestWithParam<std::string> {};

/// Two unit cubes along x; groups of all dimensions; a node of no cell.
TEST_P(GmshFile, HasCellsPartsFacesAndSets) {
  const Mesh mesh = make_mesh(MeshFile{.path = GetParam() + ".msh", .scale = 10}, folder);
  EXPECT_EQ(mesh.n_nodes(), 12);
  EXPECT_EQ(mesh.n_cells(), 2);
  EXPECT_NEAR(volume(mesh), 2000, 1e-9);
  EXPECT_EQ(mesh.parts, (std::vector<std::string>{"left", "volume_9"}));  // the second group has no name
  for (int cell = 0; cell < 2; ++cell) {
    const bool left = face_centre(mesh, {.cell = cell, .face = 0})[0] == 0.0;
    EXPECT_EQ(mesh.part_of_cell[static_cast<std::size_t>(cell)], left ? 0 : 1);
    EXPECT_EQ(mesh.labels_of_cells[static_cast<std::size_t>(cell)], left ? 4 : 5);
  }
  EXPECT_EQ(face_set_names(mesh), std::set<std::string>{"end"});  // `middle` is inside
  EXPECT_NEAR(area(mesh, "end"), 100, 1e-10);
  EXPECT_EQ(face_centre(mesh, mesh.find_faces("end")->faces[0]), (Vec3{20, 5, 5}));
  EXPECT_EQ(labels(mesh, "middle"), (std::set<long>{2, 5, 8, 11}));
  EXPECT_EQ(labels(mesh, "end"), (std::set<long>{3, 6, 9, 12}));
  EXPECT_EQ(labels(mesh, "curve_5"), (std::set<long>{1, 4}));
  EXPECT_EQ(labels(mesh, "tip"), std::set<long>{12});
  for (int node = 0; node < 12; ++node) {  // numbered along x first in the file
    const long i = mesh.labels_of_nodes[static_cast<std::size_t>(node)] - 1;
    const Vec3 place{10.0 * static_cast<double>(i % 3), 10.0 * static_cast<double>(i / 3 % 2),
                     10.0 * static_cast<double>(i / 6)};
    EXPECT_EQ(mesh.nodes[static_cast<std::size_t>(node)], place);
  }
  const MeshReport report = check_mesh(mesh);
  EXPECT_EQ(report.errors, std::vector<std::string>{});
  EXPECT_EQ(report.notes,
            std::vector<std::string>{folder + "/" + GetParam() + ".msh: nodes of no hexahedron are left out (1)"});
}

INSTANTIATE_TEST_SUITE_P(Formats, GmshFile,
                         testing::Values("two_cubes_22", "two_cubes_22_binary", "two_cubes_22_swapped", "two_cubes_41",
                                         "two_cubes_41_binary"),
                         [](const auto& name) { return name.param; });

TEST(Gmsh, EveryTruncatedFileIsRefused) {
  for (const char* name :
       {"two_cubes_22.msh", "two_cubes_22_binary.msh", "two_cubes_41.msh", "two_cubes_41_binary.msh"}) {
    const std::string content = content_of(name);
    for (std::size_t n = 0; n + 2 < content.size(); ++n) {  // the last line break is not missed
      EXPECT_NE(error_of(content.substr(0, n)), "no error") << name << " " << n;
    }
  }
}

TEST(Gmsh, SaysWhereAFileIsCutOff) {
  const std::string text = content_of("two_cubes_41.msh");
  EXPECT_EQ(error_of(text.substr(0, text.find("$EndNodes"))), "m.msh: error: ends within $Nodes");
  EXPECT_EQ(error_of(text.substr(0, text.find("$Nodes"))), "m.msh: error: has no $Nodes");
  const std::string binary = content_of("two_cubes_41_binary.msh");
  EXPECT_EQ(error_of(binary.substr(0, binary.find("$EndElements") - 9)), "m.msh: error: ends within $Elements");
}

TEST(Gmsh, NamesWhatIsNoMesh) {
  EXPECT_EQ(error_of(""), "m.msh: error: no mesh of Gmsh: it starts with '', not with '$MeshFormat'");
  EXPECT_EQ(error_of("solid cube\nfacet"),
            "m.msh: error: no mesh of Gmsh: it starts with 'solid', not with '$MeshFormat'");
  EXPECT_EQ(error_of("$MeshFormat\n4 0 8\n$EndMeshFormat\n"),
            "m.msh:2: error: format '4' is not read: write 4.1 or 2.2 (gmsh -format msh41)");
  EXPECT_EQ(error_of("$MeshFormat\n4.1 0 4\n$EndMeshFormat\n"), "m.msh:2: error: needs numbers of 8 bytes");
  EXPECT_EQ(error_of(std::string("$MeshFormat\n4.1 1 8\n\2\0\0\0\n", 25)),
            "m.msh: error: the binary file has no valid mark of its byte order (at byte 20)");
  try {
    read_gmsh(folder + "/missing.msh");
    FAIL();
  } catch (const base::InputError& error) {
    EXPECT_EQ(std::string(error.what()), folder + "/missing.msh: error: cannot read: No such file or directory");
  }
  try {
    read_gmsh(folder);
    FAIL();
  } catch (const base::InputError& error) {
    EXPECT_EQ(std::string(error.what()), folder + ": error: cannot read: Is a directory");
  }
}

TEST(Gmsh, NamesOtherElements) {
  const std::string good = content_of("two_cubes_22.msh");
  EXPECT_EQ(
      error_of(changed(good, "4 5 2 1 1 1 2 5 4 7 8 11 10", "4 4 2 1 1 1 2 5 7")),
      "m.msh: error: has tetrahedra (1): only hexahedra of 8 nodes are cells, with quadrangles of 4 nodes on them");
  EXPECT_EQ(error_of(changed(good, "2 3 2 2 5 3 6 12 9", "2 16 2 2 5 3 6 12 9 1 2 4 5")),
            "m.msh: error: has quadrangles of 8 nodes (1): only hexahedra of 8 nodes are cells, with quadrangles of 4 "
            "nodes on them");
  EXPECT_EQ(error_of(changed(good, "2 3 2 2 5 3 6 12 9", "2 92 2 2 5 3 6 12 9")),
            "m.msh:31: error: $Elements has elements of type 92: only hexahedra of 8 nodes are cells");
}

TEST(Gmsh, SaysThatThereAreNoHexahedra) {
  const std::string good = content_of("two_cubes_22.msh");
  std::string none = good.substr(0, good.find("$Elements"));
  EXPECT_EQ(
      error_of(none + "$Elements\n1\n2 3 2 2 5 3 6 12 9\n$EndElements\n"),
      "m.msh: error: has no hexahedra, only quadrangles (1): with groups, Gmsh writes only what is in one, so make "
      "one of the volume");
  EXPECT_EQ(error_of(none),
            "m.msh: error: has no hexahedra: with groups, Gmsh writes only what is in one, so make one "
            "of the volume");
}

TEST(Gmsh, LocatesBrokenNumbersAndNames) {
  const std::string good = content_of("two_cubes_22.msh");
  EXPECT_EQ(error_of(changed(good, "2 1 0 0", "2 one 0 0")), "m.msh:14: error: $Nodes needs a number, got 'one'");
  EXPECT_EQ(error_of(changed(good, "2 1 0 0", "2 nan 0 0")), "m.msh:14: error: $Nodes needs a number, got 'nan'");
  EXPECT_EQ(error_of(changed(good, "2 1 0 0", "2.5 1 0 0")), "m.msh:14: error: $Nodes needs a whole number, got '2.5'");
  EXPECT_EQ(error_of(changed(good, "\"tip\"", "tip")),
            "m.msh:6: error: $PhysicalNames needs a name in quotes, got 'tip'");
  EXPECT_EQ(error_of(changed(good, "$Nodes\n13", "$Nodes\n12")), "m.msh:25: error: needs $EndNodes, got '13'");
  EXPECT_EQ(error_of(changed(good, "$Nodes\n13", "$Nodes\n1000000000")),
            "m.msh:12: error: $Nodes announces 1000000000 nodes, more than the file holds");
  EXPECT_EQ(error_of(changed(good, "$Nodes\n13", "$Nodes\n-1")),
            "m.msh:12: error: $Nodes has a negative number of nodes");
  EXPECT_EQ(error_of(changed(good, "$PhysicalNames", "PhysicalNames")),
            "m.msh:4: error: needs a section that starts with $, got 'PhysicalNames'");
}

TEST(Gmsh, NamesNodesAndFacesThatDoNotFit) {
  const std::string good = content_of("two_cubes_22.msh");
  EXPECT_EQ(error_of(changed(good, "4 5 2 1 1 1 2 5 4 7 8 11 10", "4 5 2 1 1 1 2 5 4 7 8 11 77")),
            "m.msh: error: element 4 names node 77, which $Nodes does not have");
  EXPECT_EQ(error_of(changed(good, "2 1 0 0", "1 1 0 0")), "m.msh: error: node 1 stands twice in $Nodes");
  EXPECT_EQ(error_of(changed(good, "2 3 2 2 5 3 6 12 9", "2 3 2 2 5 3 6 12 8")),
            "m.msh: error: quadrangle 2 of group 'end' is no face of a hexahedron");
}

TEST(Gmsh, CellsWithoutAGroupAreThePartSolid) {
  const std::string good = content_of("two_cubes_22.msh");
  const std::string loose = changed(changed(good, "4 5 2 1 1 ", "4 5 2 0 1 "), "5 5 2 9 2 ", "5 5 2 0 2 ");
  EXPECT_EQ(read_gmsh_text(loose, "m.msh").parts, std::vector<std::string>{"solid"});
}

TEST(Gmsh, UnknownSectionsArePassedOver) {
  const std::string good = content_of("two_cubes_41.msh");
  const std::string more = changed(good, "$Nodes\n", "$Comments\nany $ text\n$EndComments\n$Nodes\n");
  EXPECT_EQ(read_gmsh_text(more, "m.msh").n_cells(), 2);
}

}  // namespace
}  // namespace muldi::fem
