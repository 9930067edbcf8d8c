#pragma once
/// Boxes of one material in one mesh, or cut into solids that are attached to one another.
#include <string>
#include <vector>

#include "golden/scene_run.hpp"
#include "scene/read_scene.hpp"

namespace muldi::test {

/// A box of edge lengths `size` about `centre`; lines after the mesh in `rest`.
struct BoxSolid {
  std::string name;
  std::string size;
  std::string cells;
  std::string centre;
  std::string rest;
};

/// `material` of all solids without its density; `formulation` of all; `tail`: sections after `solids`.
inline scene::Scene boxes(const std::vector<BoxSolid>& solids, const std::string& material,
                          const std::string& formulation, const std::string& tail) {
  std::string text = "muldi: 1\nmaterials:\n  m: {density: 1e-3, " + material + "}\nsolids:\n";
  for (const BoxSolid& one : solids) {
    text += "  " + one.name + ":\n    mesh: {box: {size: " + one.size + ", cells: " + one.cells +
            ", centre: " + one.centre + "}}\n    material: m\n    formulation: " + formulation + "\n" + one.rest;
  }
  return scene::read_scene_text(text + tail, "boxes.yaml");
}

/// Largest difference of a nodal field between a solid and the nodes of `whole` at the same reference positions, over
/// all rows; `folder`: "solids/" or "statics/solids/".
inline double difference(const golden::SceneRun& whole, const golden::SceneRun& cut, const std::string& folder,
                         const std::vector<std::string>& solids, const std::string& field, Eigen::Index width) {
  const auto whole_X =
      whole.rows(folder + "whole/reference").reshaped(3, whole.rows(folder + "whole/reference").size() / 3);
  double largest = 0.0;
  for (const std::string& name : solids) {
    const auto X =
        cut.rows(folder + name + "/reference").reshaped(3, cut.rows(folder + name + "/reference").size() / 3);
    const auto a = whole.rows(folder + "whole/" + field);
    const auto b = cut.rows(folder + name + "/" + field);
    for (Eigen::Index node = 0; node < X.cols(); ++node) {
      Eigen::Index same = 0;
      (whole_X.colwise() - X.col(node)).colwise().squaredNorm().minCoeff(&same);
      for (Eigen::Index row = 0; row < b.cols(); ++row) {
        largest = std::max(largest, (a.col(row).segment(width * same, width) - b.col(row).segment(width * node, width))
                                        .lpNorm<Eigen::Infinity>());
      }
    }
  }
  return largest;
}

}  // namespace muldi::test
