#pragma once
/// Boxes of one material in one mesh, or cut into solids that are attached to one another.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/text.hpp"
#include "fem/mesh/generate.hpp"
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

/// Reference positions of a box, one column a node.
inline Eigen::Matrix3Xd reference(const golden::SceneRun& run, const std::string& solid) {
  const fem::Mesh mesh = fem::make_mesh(std::get<fem::Box>(run.scene().solids.find(solid)->value.mesh));
  Eigen::Matrix3Xd X(3, mesh.n_nodes());
  for (Eigen::Index node = 0; node < X.cols(); ++node) {
    const fem::Vec3& at = mesh.nodes[static_cast<std::size_t>(node)];
    X.col(node) << at[0], at[1], at[2];
  }
  return X;
}

/// The node of a mesh at a place.
inline Eigen::Index node_at(const Eigen::Matrix3Xd& X, const Eigen::Vector3d& place) {
  Eigen::Index nearest = 0;
  EXPECT_LT((X.colwise() - place).colwise().norm().minCoeff(&nearest), 1e-12);
  return nearest;
}

/// Largest difference of a nodal field between solids and the nodes of `whole` at the same reference positions, over
/// all rows; `folder`: "solids/" or "statics/solids/".
inline double difference(const golden::SceneRun& whole, const golden::SceneRun& cut, const std::string& folder,
                         const std::vector<std::string>& solids, const std::string& field) {
  const Eigen::Matrix3Xd of_whole = reference(whole, "whole");
  double largest = 0.0;
  for (const std::string& name : solids) {
    const Eigen::Matrix3Xd X = reference(cut, name);
    const auto a = whole.rows(base::format("{}whole/{}", folder, field));
    const auto b = cut.rows(base::format("{}{}/{}", folder, name, field));
    const Eigen::Index width = a.rows() / of_whole.cols();
    for (Eigen::Index node = 0; node < X.cols(); ++node) {
      const Eigen::Index same = node_at(of_whole, X.col(node));
      largest = std::max(
          largest, (a.middleRows(width * same, width) - b.middleRows(width * node, width)).lpNorm<Eigen::Infinity>());
    }
  }
  return largest;
}

}  // namespace muldi::test
