#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "fem/mesh/check_mesh.hpp"
#include "fem/mesh/generate.hpp"
#include "mesh_measures.hpp"

namespace muldi::fem {
namespace {

constexpr double root_2 = 1.4142135623730951;

/// A bar of diameter 10 and length 100.
Cylinder bar(RoundSection section, int layers) { return {.section = section, .length = 100, .layers = layers}; }
RoundSection octagon(int section_cells, Rim rim) {
  return {.diameter = 10, .section_cells = section_cells, .rim = rim};
}
RoundSection rings(int core, int n_rings, SectionPart part) {
  return {.diameter = 10, .core = core, .rings = n_rings, .part = part};
}

TEST(BoxMesh, HasTheCountsOfTheThesisCube) {
  const Mesh mesh = make_mesh(Box{.size = {2, 2, 2}, .cells = {8, 8, 8}});
  EXPECT_EQ(mesh.n_nodes(), 729);  // thesis 4.4: 729 nodes
  EXPECT_EQ(mesh.n_cells(), 512);
  EXPECT_EQ(mesh.parts, std::vector<std::string>{"solid"});
  expect_good(mesh);
}

TEST(BoxMesh, IsExactInVolumeAreaAndPlace) {
  const Mesh mesh = make_mesh(Box{.size = {3, 5, 7}, .cells = {2, 3, 4}, .centre = {1, 0, -1}});
  EXPECT_NEAR(volume(mesh), 105, 1e-12);
  EXPECT_NEAR(area(mesh, "x-"), 35, 1e-13);
  EXPECT_NEAR(area(mesh, "y+"), 21, 1e-13);
  EXPECT_NEAR(area(mesh, "z-"), 15, 1e-13);
  EXPECT_EQ(bounds_of(mesh).low, (Vec3{-0.5, -2.5, -4.5}));
  EXPECT_EQ(bounds_of(mesh).high, (Vec3{2.5, 2.5, 2.5}));
  EXPECT_EQ(face_set_names(mesh), names(Box{}.face_names()));
}

TEST(BoxMesh, NamesItsFacesByTheirOutwardNormals) {
  const Mesh mesh = make_mesh(Box{.size = {3, 5, 7}, .cells = {2, 3, 4}});
  for (const FaceSet& set : mesh.face_sets) {
    const std::size_t axis = static_cast<std::size_t>(set.name[0] - 'x');
    const double sign = set.name[1] == '+' ? 1 : -1;
    for (const CellFace& face : set.faces) {
      EXPECT_NEAR(face_normal(mesh, face)[axis], sign * face_area(mesh, face), 1e-13) << set.name;
    }
  }
}

TEST(BoxMesh, HasItsMiddleAtExactlyItsCentre) {
  const Mesh mesh = make_mesh(Box{.size = {0.3, 0.7, 1.1}, .cells = {10, 6, 14}});
  const Vec3 centre{0, 0, 0};
  EXPECT_EQ(std::count(mesh.nodes.begin(), mesh.nodes.end(), centre), 1);
}

TEST(Octagon, StraightRimKeepsTheAreaOfTheOctagonUnderHalving) {
  for (const int cells : {4, 16, 64, 256}) {
    const Mesh mesh = make_mesh(bar(octagon(cells, Rim::straight), 2));
    EXPECT_EQ(mesh.n_cells(), 2 * cells);
    EXPECT_NEAR(area(mesh, "z-"), 2 * root_2 * 25, 1e-12) << cells;  // eight triangles of R^2 sin(45 deg)/2
    EXPECT_NEAR(volume(mesh), 100 * 2 * root_2 * 25, 1e-10);
    expect_good(mesh);
  }
}

TEST(Octagon, CircleRimHasTheAreaOfItsPolygon) {
  // n points on the circle: n/2 R^2 sin(2 pi/n); 76.5367 with 16 (reference-results C).
  EXPECT_NEAR(area(make_mesh(bar(octagon(4, Rim::circle), 1)), "z+"), 70.7107, 1e-4);
  EXPECT_NEAR(area(make_mesh(bar(octagon(16, Rim::circle), 1)), "z+"), 76.5367, 1e-4);
  for (const int cells : {16, 64, 256, 1024}) {
    const Mesh mesh = make_mesh(bar(octagon(cells, Rim::circle), 1));
    const double n = 4 * std::sqrt(cells);
    EXPECT_NEAR(area(mesh, "z+"), 0.5 * n * 25 * std::sin(2 * M_PI / n), 1e-11) << cells;
    for (const CellFace& face : mesh.find_faces("side")->faces) {
      for (const int node : face_nodes(mesh, face)) {
        const Vec3& x = mesh.nodes[static_cast<std::size_t>(node)];
        EXPECT_NEAR(std::hypot(x[0], x[1]), 5, 1e-14);
      }
    }
    expect_good(mesh);
  }
}

TEST(Octagon, HasTheNodesOfTheThesis) {
  // 25 nodes a layer with 16 quadrangles (thesis 4.5, layered muscle: 512 cells, 825 nodes).
  const Mesh layered = make_mesh(bar(octagon(16, Rim::straight), 32));
  EXPECT_EQ(layered.n_cells(), 512);
  EXPECT_EQ(layered.n_nodes(), 33 * 25);
  // 92 cells of the muscle of chapter 5: 23 layers of the 9-node section.
  const Mesh muscle = make_mesh(bar(octagon(4, Rim::straight), 23));
  EXPECT_EQ(muscle.n_cells(), 92);
  EXPECT_EQ(muscle.n_nodes(), 24 * 9);
}

TEST(Octagon, QuarterIsAQuarterOfTheWhole) {
  for (const Rim rim : {Rim::straight, Rim::circle}) {
    RoundSection section = octagon(64, rim);
    const double whole = area(make_mesh(bar(section, 1)), "z-");
    section.part = SectionPart::quarter;
    const Mesh quarter = make_mesh(bar(section, 3));
    EXPECT_EQ(quarter.n_cells(), 3 * 16);
    EXPECT_NEAR(area(quarter, "z-"), whole / 4, 1e-13);
    EXPECT_NEAR(area(quarter, "x-"), 5 * 100, 1e-11);  // the planes of symmetry
    EXPECT_NEAR(area(quarter, "y-"), 5 * 100, 1e-11);
    expect_good(quarter);
  }
}

TEST(CoreAndRings, HaveTheCellsOfTheThesis) {
  // Thesis 4.5.1: core 5x5 with 11 rings of 10 quadrangles = 135; layer reduction: core 6x6 and two rings of 12 = 60.
  EXPECT_EQ(make_mesh(bar(rings(5, 11, SectionPart::quarter), 1)).n_cells(), 135);
  EXPECT_EQ(make_mesh(bar(rings(6, 2, SectionPart::quarter), 1)).n_cells(), 60);
  EXPECT_EQ(make_mesh(bar(rings(6, 2, SectionPart::full), 1)).n_cells(), 240);
  for (const auto& [core, n] : {std::pair(5, 11), std::pair(6, 2), std::pair(1, 1), std::pair(2, 20)}) {
    for (const SectionPart part : {SectionPart::full, SectionPart::quarter}) {
      for (const Rim rim : {Rim::straight, Rim::circle}) {
        RoundSection section = rings(core, n, part);
        section.rim = rim;
        const Mesh mesh = make_mesh(bar(section, 1));
        expect_good(mesh);
        const double n_rim = 8 * core;
        const double whole = rim == Rim::straight ? 2 * root_2 * 25 : 0.5 * n_rim * 25 * std::sin(2 * M_PI / n_rim);
        EXPECT_NEAR(area(mesh, "z-"), part == SectionPart::full ? whole : whole / 4, 1e-12);
        EXPECT_EQ(mesh.n_cells(), section.n_cells());
      }
    }
  }
}

TEST(CylinderMesh, LiesAlongItsAxisWithItsNodesByLayers) {
  for (const Axis axis : {Axis::x, Axis::y, Axis::z}) {
    Cylinder cylinder = bar(octagon(16, Rim::circle), 4);
    cylinder.axis = axis;
    const Mesh mesh = make_mesh(cylinder);
    const auto along = static_cast<std::size_t>(axis);
    EXPECT_EQ(bounds_of(mesh).low[along], 0);
    EXPECT_EQ(bounds_of(mesh).high[along], 100);
    EXPECT_EQ(mesh.n_layers(), 5);
    for (int node = 0; node < mesh.n_nodes(); ++node) {
      EXPECT_EQ(mesh.layer_of_node[static_cast<std::size_t>(node)], node / 25);
      EXPECT_NEAR(mesh.nodes[static_cast<std::size_t>(node)][along], 25 * (node / 25), 1e-13);
    }
    EXPECT_EQ(face_set_names(mesh), names(cylinder.face_names()));
    EXPECT_EQ(names(cylinder.face_names()),
              names({end_name(static_cast<int>(axis), -1), end_name(static_cast<int>(axis), 1), "side"}));
    expect_good(mesh);
  }
}

/// Three cells of silicone and four electrodes (thesis 4.5.1): 95 layers of 0.4 um.
Stack real_geometry() {
  return {.section = rings(5, 11, SectionPart::quarter),
          .layers = {{.part = "electrode", .thickness = 2e-3, .cells = 5},
                     {.part = "silicone", .thickness = 10e-3, .cells = 25}},
          .repeat = 3,
          .close = "electrode"};
}

TEST(StackMesh, HasTheCountsOfTheThesis) {
  const Mesh mesh = make_mesh(real_geometry());
  EXPECT_EQ(mesh.n_cells(), 12825);
  EXPECT_EQ(4 * mesh.n_nodes(), 60288);  // dofs
  EXPECT_EQ(mesh.parts, (std::vector<std::string>{"electrode", "silicone"}));
  EXPECT_EQ(real_geometry().n_cells(), 12825);
}

TEST(StackMesh, KnowsItsLayersOfParts) {
  const Mesh mesh = make_mesh(real_geometry());
  ASSERT_EQ(mesh.slabs.size(), 7u);
  for (std::size_t i = 0; i < mesh.slabs.size(); ++i) {
    EXPECT_EQ(mesh.slabs[i].part, static_cast<int>(i % 2));
    EXPECT_EQ(mesh.slabs[i].last - mesh.slabs[i].first, i % 2 == 0 ? 5 : 25);
    EXPECT_EQ(mesh.slabs[i].first, i == 0 ? 0 : mesh.slabs[i - 1].last);
  }
  EXPECT_EQ(mesh.n_layers(), 96);
  EXPECT_NEAR(bounds_of(mesh).high[2], 4 * 2e-3 + 3 * 10e-3, 1e-16);
}

TEST(StackMesh, OfABoxHasItsFacesByAxis) {
  const Stack stack{.section = RectangleSection{.size = {2, 3}, .cells = {2, 3}},
                    .axis = Axis::x,
                    .layers = {{.part = "a", .thickness = 1, .cells = 1}, {.part = "b", .thickness = 4, .cells = 2}},
                    .repeat = 2};
  const Mesh mesh = make_mesh(stack);
  EXPECT_NEAR(volume(mesh), 60, 1e-12);
  EXPECT_NEAR(area(mesh, "x-"), 6, 1e-14);
  EXPECT_NEAR(area(mesh, "y-"), 30, 1e-13);  // the section's first axis is y, of length 2: the face spans z (3) and x
  EXPECT_NEAR(area(mesh, "z+"), 20, 1e-13);
  EXPECT_EQ(face_set_names(mesh), names(stack.face_names()));
  expect_good(mesh);
}

TEST(Generators, SayWhatMakesNoMesh) {
  EXPECT_EQ(octagon(16, Rim::circle).why_invalid(), "");
  EXPECT_EQ(octagon(12, Rim::circle).why_invalid(), "section_cells must be 4, 16, 64, ..., got 12");
  EXPECT_EQ(octagon(8, Rim::circle).why_invalid(), "section_cells must be 4, 16, 64, ..., got 8");
  EXPECT_EQ(RoundSection{.diameter = 1}.why_invalid(), "needs section_cells, or core and rings");
  EXPECT_EQ((RoundSection{.diameter = 1, .core = 2}).why_invalid(), "needs section_cells, or core and rings");
  EXPECT_EQ((RoundSection{.diameter = 1, .section_cells = 4, .rings = 2}).why_invalid(),
            "give either section_cells, or core and rings");
  EXPECT_EQ((Box{.size = {1, 1, 1}, .cells = {1000, 1000, 1000}}).why_invalid(),
            "makes 1e+09 cells, at most 2e+07 are built");
  Stack stack = real_geometry();
  EXPECT_EQ(stack.why_invalid(), "");
  stack.close = "electrodes";
  EXPECT_EQ(stack.why_invalid(), "close: no layer of part 'electrodes' (did you mean 'electrode'?)");
  stack.layers.clear();
  EXPECT_EQ(stack.why_invalid(), "needs at least one layer");
}

}  // namespace
}  // namespace muldi::fem
