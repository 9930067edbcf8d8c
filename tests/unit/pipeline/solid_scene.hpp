#pragma once
/// Scenes of one cube, run in this process.
#include <string>

#include "golden/scene_run.hpp"
#include "scene/read_scene.hpp"

namespace muldi::test {

/// Permittivity of free space in mm, g, ms, A: that of scenes.
inline constexpr double eps0 = 8.8542e-12;

/// A cube of edge 2 about the origin; `rest` are the sections after `solids`, lines of `solid` belong to the cube.
inline scene::Scene cube(const std::string& material, const std::string& solid, const std::string& rest,
                         const std::string& cells = "[2, 2, 2]") {
  return scene::read_scene_text("muldi: 1\nmaterials:\n  m: {density: 1e-3, " + material +
                                    "}\nsolids:\n  cube:\n    mesh: {box: {size: [2, 2, 2], cells: " + cells +
                                    ", centre: [0, 0, 0]}}\n    material: m\n" + solid + rest,
                                "cube.yaml");
}

/// Faces on the planes of symmetry: no rigid motion is left.
inline const std::string on_rollers =
    "    conditions:\n"
    "      - {where: x-, displacement: [0, ~, ~]}\n"
    "      - {where: y-, displacement: [~, 0, ~]}\n"
    "      - {where: z-, displacement: [~, ~, 0]}\n";

/// The last row of a field as a matrix, one column a node or cell.
inline Eigen::MatrixXd last_field(const golden::SceneRun& run, const std::string& path, Eigen::Index width) {
  const Eigen::VectorXd row = run.last(path);
  return row.reshaped(width, row.size() / width);
}

}  // namespace muldi::test
